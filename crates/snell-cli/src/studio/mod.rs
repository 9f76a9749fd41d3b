//! `snell studio`: Snell Studio in the browser of this machine, from this program, and for this machine alone.
//!
//! ```text
//!  a browser ── GET ──▶ http: what is asked, and by whom ──┬─▶ pages: files of the studio
//!                                                          └─▶ live: the scene, and again whenever its files change ◀── watch
//! ```

mod http;
mod live;
mod pages;
mod watch;

use crate::args::StudioArgs;
use crate::say::{self, FAILED, Failure, INTERRUPTED, OrFail, Outcome, USAGE, tell};
use crate::signals;
use http::{Answer, Request, Status};
use live::Live;
use pages::Pages;
use snell_formats::Report;
use std::io::ErrorKind;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::thread;
use std::time::Duration;

/// More connections at a time than this are nobody's browser.
const MOST_CONNECTIONS: usize = 256;

pub fn run(args: &StudioArgs) -> Outcome {
    let pages = Pages::find().or_fail(USAGE)?;
    let live = args.scene.as_deref().map(Live::of).transpose()?;
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(|e| no_port(args.port, &e))?;
    let port = listener.local_addr().map_err(|e| no_port(args.port, &e))?.port();
    if !signals::on_interrupt(|| std::process::exit(INTERRUPTED.into())) {
        tell("note: ^C may not end this");
    }
    let address = format!("http://127.0.0.1:{port}/{}", if live.is_some() { "?live" } else { "" });
    say::print(&format!("{address}\n"))?;
    tell("Snell Studio is at this address until ^C");
    if !args.no_open && open::that_detached(&address).is_err() {
        tell("no browser could be opened: open the address in one");
    }
    serve(&listener, &Arc::new(Studio { pages, live, port }))
}

fn no_port(port: u16, error: &std::io::Error) -> Failure {
    let report = Report::error(format!("cannot listen at port {port}: {error}"));
    Failure::new(
        FAILED,
        match error.kind() {
            ErrorKind::AddrInUse => {
                report.help("another `snell studio` may be at it; `--port 0` takes one that is free")
            }
            _ => report.help("`--port 0` takes one that may be had"),
        },
    )
}

struct Studio {
    pages: Pages,
    live: Option<Live>,
    port: u16,
}

/// A thread for each connection, so that none waits for another.
fn serve(listener: &TcpListener, studio: &Arc<Studio>) -> Outcome {
    loop {
        // A client that has gone before it was greeted, or no more files for this program: neither lasts.
        let Ok((stream, _)) = listener.accept() else {
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        // One is held here, and one by the thread.
        if Arc::strong_count(studio) > MOST_CONNECTIONS {
            continue;
        }
        let studio = Arc::clone(studio);
        // Without a thread the connection is closed, and the client may try again.
        let _ = thread::Builder::new().spawn(move || studio.talk(stream));
    }
}

impl Studio {
    fn talk(&self, stream: TcpStream) {
        // Whoever goes away in the middle of an answer need not be told.
        let _ = http::talk(stream, |request| self.answer(request));
    }

    fn answer(&self, request: &Request) -> Result<Answer, Status> {
        self.is_for_us(request)?;
        if !request.is_reading {
            return Err(Status::MethodNotAllowed);
        }
        if request.path == "/live" {
            let live = self.live.as_ref().ok_or(Status::NotFound)?;
            return Ok(live.follow(request.last_event.clone()));
        }
        self.pages.get(&request.path, request.takes_gzip).ok_or(Status::NotFound)
    }

    /// A page of another site can have its own name lead here (DNS rebinding); the name that it asks for tells.
    fn is_for_us(&self, request: &Request) -> Result<(), Status> {
        let Some(host) = &request.host else { return Err(Status::BadRequest) };
        let (name, port) = host.rsplit_once(':').unwrap_or((host, "80"));
        let is_ours = (name == "127.0.0.1" || name.eq_ignore_ascii_case("localhost")) && port.parse() == Ok(self.port);
        if is_ours { Ok(()) } else { Err(Status::Forbidden) }
    }
}
