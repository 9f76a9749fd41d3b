//! `snell studio` as browsers and others meet it: raw bytes over a socket.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use common::{command, run, stderr};
use serde_json::Value;
use snell_formats::LoadOptions;
use snell_formats::files::InMemory;
use snell_formats::load::load_bytes;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Stdio};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Longer than anything takes, however busy the machine is.
const PATIENCE: Duration = Duration::from_mins(1);

/// A folder with the pages of a studio in `pages`, a file beside that, and a scene with a model.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::create_dir_all(at.join("pages/assets")).unwrap();
    fs::create_dir_all(at.join("scenes")).unwrap();
    fs::create_dir_all(at.join("models")).unwrap();
    fs::write(at.join("pages/index.html"), "<!doctype html><title>studio</title>").unwrap();
    fs::write(at.join("pages/assets/a b.mjs"), "export {}").unwrap();
    fs::write(at.join("pages/snell.wasm"), vec![0; 300_000]).unwrap();
    fs::write(at.join("secret.txt"), "secret").unwrap();
    fs::write(at.join("models/tetra.obj"), TETRA).unwrap();
    fs::write(at.join("scenes/tetra.toml"), SCENE).unwrap();
    folder
}

const TETRA: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
const SCENE: &str = r#"snell = 1
ambient = 0.5
eta_outside = 1

[render]
integrator = "whitted"
size = [16, 16]
max_depth = 2

[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 60

[[light]]
position = [1, 2, 3]
color = 1

[material.red]
kd = [1, 0, 0]

[[mesh]]
file = "../models/tetra.obj"
material = "red"
"#;

/// A studio that runs, until it is dropped.
struct Studio {
    child: Child,
    port: u16,
    address: String,
}

impl Studio {
    fn start(at: &Path, arguments: &[&str]) -> Self {
        Self::start_in(at, at, arguments)
    }

    /// In a folder that may be another one than the workplace.
    fn start_in(folder: &Path, at: &Path, arguments: &[&str]) -> Self {
        let mut child = studio(at, &[arguments, &["--port", "0"]].concat())
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut address = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let rest = address.strip_prefix("http://127.0.0.1:").unwrap_or_default();
        let port = rest.split('/').next().unwrap().parse().unwrap_or(0);
        assert!(port > 0, "no address: {address:?}");
        Self { child, port, address: address.trim().to_owned() }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    /// The whole answer to a request, of which `{port}` stands for the port.
    fn ask(&self, request: &str) -> String {
        let mut stream = self.connect();
        stream.write_all(request.replace("{port}", &self.port.to_string()).as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn get(&self, path: &str) -> String {
        self.ask(&format!("GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{{port}}\r\n\r\n"))
    }

    fn events(&self, last: Option<&str>) -> Events {
        let mut stream = self.connect();
        let last = last.map_or(String::new(), |id| format!("Last-Event-ID: {id}\r\n"));
        write!(stream, "GET /live HTTP/1.1\r\nHost: localhost:{}\r\n{last}\r\n", self.port).unwrap();
        let mut lines = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(lines.read_line(&mut head).unwrap() > 0, "{head}");
        }
        assert!(head.starts_with("HTTP/1.1 200") && head.contains("Content-Type: text/event-stream\r\n"), "{head}");
        Events(lines)
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn studio(at: &Path, arguments: &[&str]) -> std::process::Command {
    let mut studio = command(at, &[&["studio", "--no-open"], arguments].concat());
    studio.env("SNELL_STUDIO_DIST", at.join("pages"));
    studio
}

struct Events(BufReader<TcpStream>);

impl Events {
    /// The next one, with its number.
    fn next(&mut self) -> (String, Value) {
        let (mut id, mut line) = (String::new(), String::new());
        loop {
            line.clear();
            assert!(self.0.read_line(&mut line).unwrap() > 0, "the events have ended");
            if let Some(data) = line.strip_prefix("data: ") {
                return (id, serde_json::from_str(data).unwrap());
            }
            if let Some(number) = line.strip_prefix("id: ") {
                number.trim().clone_into(&mut id);
            }
        }
    }

    /// Does nothing but heartbeats come?
    fn is_silent_for(&mut self, time: Duration) -> bool {
        self.0.get_ref().set_read_timeout(Some(time)).unwrap();
        let mut line = String::new();
        let mut is_silent = true;
        while is_silent && self.0.read_line(&mut line).is_ok() {
            is_silent = matches!(&*line, "\n" | ":\n");
            line.clear();
        }
        self.0.get_ref().set_read_timeout(Some(PATIENCE)).unwrap();
        is_silent
    }
}

fn bytes(value: &Value) -> Vec<u8> {
    STANDARD.decode(value.as_str().unwrap()).unwrap()
}

/// Loads what an event holds as a page does, which has no other files; returns how many triangles of models there are.
fn loaded(event: &Value) -> usize {
    let name = event["name"].as_str().unwrap();
    let mut files = InMemory::default();
    for file in event["files"].as_array().unwrap() {
        files.insert(file[0].as_str().unwrap(), bytes(&file[1]));
    }
    let options = LoadOptions { files: Arc::new(files), ..LoadOptions::default() };
    let path = Path::new(name);
    let scene = load_bytes(name, path, &bytes(&event["text"]), path.parent().unwrap(), &options).unwrap().scene;
    scene.meshes.iter().filter_map(|mesh| mesh.geometry.as_ref()).map(|geometry| geometry.faces.len()).sum()
}

#[test]
fn pages_are_sent_as_what_they_are_and_nothing_else_is() {
    let folder = workplace();
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.txt", folder.path().join("pages/link.txt")).unwrap();
    let studio = Studio::start(folder.path(), &[]);
    assert_eq!(studio.address, format!("http://127.0.0.1:{}/", studio.port));
    for (path, kind, body) in [
        ("/", "text/html; charset=utf-8", "<!doctype html><title>studio</title>"),
        ("/index.html?live", "text/html; charset=utf-8", "<!doctype html><title>studio</title>"),
        ("/assets/a%20b.mjs", "text/javascript; charset=utf-8", "export {}"),
        ("/snell.wasm", "application/wasm", &"\0".repeat(300_000)),
    ] {
        let answer = studio.get(path);
        let (head, sent) = answer.split_once("\r\n\r\n").unwrap();
        assert!(head.starts_with("HTTP/1.1 200 OK\r\n"), "{path}: {head}");
        assert!(sent == body, "{path}");
        for header in
            [&format!("Content-Type: {kind}"), "Cache-Control: no-cache", &format!("Content-Length: {}", body.len())]
        {
            assert!(head.lines().any(|line| line == header), "{path}: {head}");
        }
        let request = format!("HEAD {path} HTTP/1.1\r\nHost: 127.0.0.1:{{port}}\r\n\r\n");
        assert_eq!(studio.ask(&request), format!("{head}\r\n\r\n"));
    }
    for path in [
        "/none",
        "/assets",
        "/assets/",
        "/../secret.txt",
        "/assets/../../secret.txt",
        "/%2e%2e/secret.txt",
        "/..%2fsecret.txt",
        "/link.txt",
        "//etc/passwd",
        "/live",
    ] {
        let answer = studio.get(path);
        assert!(answer.starts_with("HTTP/1.1 404 ") && !answer.contains("\r\n\r\nsecret"), "{path}: {answer}");
    }
}

#[test]
fn only_the_browser_of_this_machine_is_answered() {
    let folder = workplace();
    let studio = Studio::start(folder.path(), &["scenes/tetra.toml"]);
    let ours = "Host: 127.0.0.1:{port}\r\n";
    let long = format!("{ours}X: {}\r\n", "x".repeat(20_000));
    let many = format!("{ours}{}", "X: x\r\n".repeat(100));
    let body = format!("{ours}Content-Length: 200000\r\n\r\n{}", "x".repeat(200_000));
    for (line, headers, status) in [
        ("GET /", "Host: LocalHost:{port}\r\n", 200),
        ("GET /", "Host: evil.example:{port}\r\n", 403),
        ("GET /live", "Host: evil.example:{port}\r\n", 403),
        ("GET /", "Host: 127.0.0.1\r\n", 403),
        ("GET /", "Host: 127.0.0.1:1\r\n", 403),
        ("GET /", "Host: 127.0.0.1.evil.example:{port}\r\n", 403),
        ("GET /", "", 400),
        ("GET /", "Host: 127.0.0.1:{port}\r\nHost: evil.example:{port}\r\n", 400),
        ("POST /", ours, 405),
        ("DELETE /", ours, 405),
        ("PUT /live", &body, 405),
        ("GET /", &long, 431),
        ("GET /", &many, 431),
        ("\u{1}", ours, 400),
    ] {
        let answer = studio.ask(&format!("{line} HTTP/1.1\r\n{headers}\r\n"));
        assert!(answer.starts_with(&format!("HTTP/1.1 {status} ")), "{line} {headers:.80}: {answer:.80}");
    }
}

#[test]
fn nobody_waits_for_who_is_slow() {
    let folder = workplace();
    let studio = Studio::start(folder.path(), &["scenes/tetra.toml"]);
    let silent: Vec<TcpStream> = (0..20).map(|_| studio.connect()).collect();
    // They ask, and never read.
    let deaf: Vec<TcpStream> = (0..20)
        .map(|_| {
            let mut stream = studio.connect();
            write!(stream, "GET /snell.wasm HTTP/1.1\r\nHost: localhost:{}\r\n\r\n", studio.port).unwrap();
            stream
        })
        .collect();
    let mut pages: Vec<Events> = (0..20).map(|_| studio.events(None)).collect();
    let start = Instant::now();
    assert!(studio.get("/").starts_with("HTTP/1.1 200"));
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
    let ids: Vec<String> = pages.iter_mut().map(|page| page.next().0).collect();
    assert!(ids.iter().all(|id| *id == ids[0]));
    drop((silent, deaf));
}

#[test]
fn a_page_hears_of_every_change() {
    let folder = workplace();
    let at = folder.path();
    let (scene, model) = (at.join("scenes/tetra.toml"), at.join("models/tetra.obj"));
    let studio = Studio::start(at, &["scenes/tetra.toml"]);
    assert!(studio.address.ends_with("/?live"), "{}", studio.address);
    let mut page = studio.events(None);

    let (id, event) = page.next();
    assert_eq!(event["name"], "scenes/tetra.toml");
    assert_eq!(bytes(&event["text"]), SCENE.as_bytes());
    assert_eq!(event["files"][0][0], "models/tetra.obj");
    assert_eq!(bytes(&event["files"][0][1]), TETRA.as_bytes());
    assert_eq!(loaded(&event), 4);

    // Of the same length.
    let green = SCENE.replace("[1, 0, 0]", "[0, 1, 0]");
    fs::write(&scene, &green).unwrap();
    let (second, event) = page.next();
    assert!(second != id && bytes(&event["text"]) == green.as_bytes());

    fs::write(&model, format!("{TETRA}v 2 2 2\nf 1 2 5\n")).unwrap();
    let (third, event) = page.next();
    assert_eq!(loaded(&event), 5);

    // A page that comes again hears only what is new.
    assert_eq!(studio.events(Some(&second)).next().0, third);
    assert!(studio.events(Some(&third)).is_silent_for(Duration::from_secs(1)));
    // Saved, but not changed.
    fs::write(&scene, &green).unwrap();
    assert!(page.is_silent_for(Duration::from_secs(2)));

    // As an editor saves: gone, or half there, and back again.
    fs::remove_file(&model).unwrap();
    let error = page.next().1["error"].as_str().unwrap().to_owned();
    assert!(error.starts_with("scenes/tetra.toml:24:") && error.contains("tetra.obj"), "{error}");
    fs::write(&scene, "[camera\n").unwrap();
    let (_, event) = page.next();
    assert!(event["error"].as_str().unwrap().starts_with("scenes/tetra.toml:1:"), "{event}");
    fs::remove_file(&scene).unwrap();
    assert!(page.next().1["error"].as_str().unwrap().contains("there is no file"));
    fs::write(&scene, SCENE).unwrap();
    // A file that was missing is waited for, also where it has never been.
    assert!(page.next().1["error"].as_str().unwrap().contains("tetra.obj"));
    fs::write(at.join("scenes/tetra.obj"), TETRA).unwrap();
    let (_, event) = page.next();
    assert_eq!((loaded(&event), &event["files"][0][0]), (4, &Value::from("tetra.obj")));
    assert_eq!(event["name"], "tetra.toml");
}

#[test]
fn whatever_a_scene_names_reaches_the_page() {
    let folder = workplace();
    let at = folder.path();
    fs::create_dir_all(at.join("scenes/textures")).unwrap();
    run(at, &["render", "lecture/default", "--size", "4x4", "-o", "scenes/textures/wood.png", "-q"]);
    let textured = TETRA
        .replace("f 1 3 2", "vt 0 0\nmtllib t.mtl\nusemtl wood\nf 1/1 3/1 2/1")
        .replace("f 1 2 4", "f 1/1 2/1 4/1");
    let textured = textured.replace("f 2 3 4", "f 2/1 3/1 4/1").replace("f 3 1 4", "f 3/1 1/1 4/1");
    fs::write(at.join("scenes/t.obj"), textured).unwrap();
    fs::write(at.join("scenes/t.mtl"), "newmtl wood\nKd 1 1 1\nmap_Kd textures/wood.png\n").unwrap();
    let absolute = at.join("models/tetra.obj").display().to_string();
    let scene = SCENE.replace("../models/tetra.obj", &absolute) + "[[mesh]]\nfile = \"t.obj\"\n";
    fs::write(at.join("scenes/all.toml"), scene).unwrap();
    // By a relative name and by an absolute one, from beside it and from elsewhere.
    let long = at.join("scenes/all.toml").display().to_string();
    for (folder, name) in [("", "scenes/all.toml"), ("scenes", "all.toml"), ("models", &*long)] {
        let studio = Studio::start_in(&at.join(folder), at, &[name]);
        let (_, event) = studio.events(None).next();
        assert_eq!(loaded(&event), 8, "{name}");
        assert_eq!(event["files"].as_array().unwrap().len(), 4, "{event}");
    }
    let studio = Studio::start(at, &["gallery/prism"]);
    let (_, event) = studio.events(None).next();
    assert_eq!((&event["name"], event["files"].as_array().unwrap().len()), (&Value::from("gallery/prism"), 0));
    loaded(&event);
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_it_at_once() {
    let folder = workplace();
    let mut studio = Studio::start(folder.path(), &["scenes/tetra.toml"]);
    let mut page = studio.events(None);
    page.next();
    let start = Instant::now();
    let kill = std::process::Command::new("kill").args(["-INT", &studio.child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(studio.child.wait().unwrap().code(), Some(130));
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}

#[test]
fn what_cannot_work_is_said_before_anything_is_served() {
    let folder = workplace();
    let at = folder.path();
    fs::write(at.join("broken.toml"), "[camera]\neye = 7\n").unwrap();
    fs::write(at.join("lost.toml"), SCENE.replace("tetra", "lost")).unwrap();
    fs::write(at.join("odd.toml"), SCENE.replace("eye = [0, 0, 5]", "eye = [0, 0, 0]")).unwrap();
    let taken = TcpListener::bind(("127.0.0.1", 0)).unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    for (arguments, code, why) in [
        (&["broken.toml"][..], 3, "eye"),
        (&["lost.toml"], 3, "lost.obj"),
        (&["odd.toml"], 3, "look_at"),
        (&["none.toml"], 3, "there is no file"),
        (&["gallery/prims"], 3, "gallery/prism"),
        (&["models"], 3, "folder"),
        (&["--port", &port], 1, "--port 0"),
        (&["--port", "70000"], 2, "70000"),
    ] {
        let output = studio(at, arguments).output().unwrap();
        let said = stderr(&output);
        assert!(output.status.code() == Some(code) && said.contains(why), "{arguments:?}: {:?}\n{said}", output.status);
        assert!(output.stdout.is_empty());
    }
    let output = command(at, &["studio", "--no-open"]).env("SNELL_STUDIO_DIST", at.join("models")).output().unwrap();
    assert!(output.status.code() == Some(2) && stderr(&output).contains("index.html"), "{}", stderr(&output));
}
