//! The scene of a page: sent at once, and again whenever it has changed on disk.

use super::http::Answer;
use super::watch::{self, Snapshot, Watched};
use crate::input;
use crate::say::{Failure, OrFail, SCENE};
use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use serde_json::json;
use snell_formats::files::sha256;
use snell_formats::{LoadOptions, Report};
use std::io::{Result, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often files are looked at. Watching them by the system does not see what changes on the disks of a network.
const PAUSE: Duration = Duration::from_millis(300);
/// So often a page hears something, or it is found to be gone.
const HEARTBEAT: Duration = Duration::from_secs(15);

pub struct Live(Arc<Latest>);

struct Latest {
    event: Mutex<Arc<Event>>,
    changed: Condvar,
}

struct Event {
    /// What it says, in short, so that nobody is told twice.
    id: String,
    content: std::result::Result<Snapshot, String>,
}

impl Live {
    /// The scene of this name, which can be read.
    pub fn of(name: &str) -> std::result::Result<Self, Failure> {
        let path = PathBuf::from(name);
        if !path.exists() || path.is_dir() {
            let source = input::scene(name, &LoadOptions::default())?.source;
            let text = source.text.as_bytes().to_vec();
            return Ok(Self::new(Ok(Snapshot { name: source.name.to_string(), text, files: Vec::new() })));
        }
        let (result, watched) = watch::read(name, &path);
        let (loaded, snapshot) = result.or_fail(SCENE)?;
        loaded.world().or_fail(SCENE)?;
        drop(loaded);
        let live = Self::new(Ok(snapshot));
        let latest = Arc::clone(&live.0);
        let shown = name.to_owned();
        thread::spawn(move || latest.keep(&shown, &path, watched));
        Ok(live)
    }

    fn new(content: std::result::Result<Snapshot, String>) -> Self {
        Self(Arc::new(Latest { event: Mutex::new(Arc::new(Event::new(content))), changed: Condvar::new() }))
    }

    /// All events from now on, after the one that a page had last.
    pub fn follow(&self, mut last: Option<String>) -> Answer {
        let latest = Arc::clone(&self.0);
        let write = move |out: &mut dyn Write| {
            // A page that has the latest event is to know that it is connected.
            out.flush()?;
            loop {
                match latest.after(last.as_deref()) {
                    Some(event) => {
                        event.write(out)?;
                        last = Some(event.id.clone());
                    }
                    None => out.write_all(b":\n\n")?,
                }
                out.flush()?;
            }
        };
        Answer { kind: "text/event-stream", is_gzip: false, length: None, write: Box::new(write) }
    }
}

impl Latest {
    /// The latest event, once that is another one; `None` if it is not for a while.
    fn after(&self, last: Option<&str>) -> Option<Arc<Event>> {
        let event = self.event.lock().unwrap_or_else(PoisonError::into_inner);
        let is_old = |event: &mut Arc<Event>| Some(&*event.id) == last;
        let waited = self.changed.wait_timeout_while(event, HEARTBEAT, is_old);
        let (event, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        (!waited.timed_out()).then(|| Arc::clone(&event))
    }

    /// Reads the scene again whenever it has changed.
    fn keep(&self, shown: &str, path: &Path, mut read: Watched) {
        let mut before = read.clone();
        loop {
            thread::sleep(PAUSE);
            let now = read.now();
            // What is still being written is waited for.
            if now == read || now != before {
                before = now;
                continue;
            }
            let (result, watched) = watch::read(shown, path);
            let content = result.map(|(_, snapshot)| snapshot).map_err(|reports| in_words(&reports));
            self.tell(Event::new(content));
            (before, read) = (watched.clone(), watched);
        }
    }

    fn tell(&self, event: Event) {
        *self.event.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(event);
        self.changed.notify_all();
    }
}

impl Event {
    fn new(content: std::result::Result<Snapshot, String>) -> Self {
        let id = match &content {
            Ok(Snapshot { name, text, files }) => {
                let files = files.iter().flat_map(|(name, bytes)| [name.as_bytes(), bytes]);
                sha256([name.as_bytes(), text].into_iter().chain(files).map(|part| sha256([part])))
            }
            Err(message) => sha256([message]),
        };
        Self { id, content }
    }

    /// Files may be large: they are not put together in memory.
    fn write(&self, out: &mut dyn Write) -> Result<()> {
        write!(out, "id: {}\ndata: ", self.id)?;
        match &self.content {
            Ok(Snapshot { name, text, files }) => {
                write!(out, "{{\"name\":{},\"text\":", json!(name))?;
                base64(out, text)?;
                out.write_all(b",\"files\":[")?;
                for (number, (name, bytes)) in files.iter().enumerate() {
                    let comma = if number > 0 { "," } else { "" };
                    write!(out, "{comma}[{},", json!(name))?;
                    base64(out, bytes)?;
                    out.write_all(b"]")?;
                }
                out.write_all(b"]}")?;
            }
            Err(message) => write!(out, "{}", json!({ "error": message }))?,
        }
        out.write_all(b"\n\n")
    }
}

fn base64(out: &mut dyn Write, bytes: &[u8]) -> Result<()> {
    out.write_all(b"\"")?;
    let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
    encoder.write_all(bytes)?;
    encoder.finish()?;
    drop(encoder);
    out.write_all(b"\"")
}

/// What is wrong, each with its place, a line for each.
fn in_words(reports: &[Report]) -> String {
    let line = |report: &Report| {
        let place = report.place.as_ref().map(|(source, range)| {
            let (line, column) = source.line_column(range.start);
            format!("{}:{line}:{column}: ", source.name)
        });
        let help = crate::say::help(report).map(|help| format!(" ({help})"));
        format!("{}{}{}", place.unwrap_or_default(), report.message, help.unwrap_or_default())
    };
    reports.iter().filter(|report| report.warning.is_none()).map(line).collect::<Vec<_>>().join("\n")
}
