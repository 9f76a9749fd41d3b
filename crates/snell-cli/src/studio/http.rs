//! One request and one answer for each connection: as much of HTTP/1.1 as a browser on the same machine needs.

use std::io::{BufWriter, Read, Result, Write};
use std::net::{Shutdown, TcpStream};
use std::time::Duration;

/// What is asked.
pub struct Request {
    /// Is nothing to be changed (GET, HEAD)?
    pub is_reading: bool,
    /// Is only said what would be sent (HEAD)?
    is_head: bool,
    /// As it is written, without what comes after `?`.
    pub path: String,
    pub host: Option<String>,
    pub takes_gzip: bool,
    /// The last event that a page had before it asks again.
    pub last_event: Option<String>,
}

/// Why nothing is sent.
#[derive(Clone, Copy)]
pub enum Status {
    BadRequest,
    Forbidden,
    NotFound,
    MethodNotAllowed,
    HeadersTooLarge,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Self::BadRequest => "400 Bad Request",
            Self::Forbidden => "403 Forbidden",
            Self::NotFound => "404 Not Found",
            Self::MethodNotAllowed => "405 Method Not Allowed",
            Self::HeadersTooLarge => "431 Request Header Fields Too Large",
        }
    }
}

/// What is sent.
pub struct Answer {
    /// Its MIME type.
    pub kind: &'static str,
    pub is_gzip: bool,
    /// In bytes; `None` for what does not end.
    pub length: Option<u64>,
    pub write: Body,
}

pub type Body = Box<dyn FnOnce(&mut dyn Write) -> Result<()>>;

const MOST_HEADER_BYTES: usize = 1 << 14;
const MOST_HEADERS: usize = 64;
/// Who is silent for so long has gone.
const PATIENCE: Duration = Duration::from_secs(30);

/// Reads a request, and answers it.
pub fn talk(mut stream: TcpStream, answer: impl FnOnce(&Request) -> std::result::Result<Answer, Status>) -> Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let (request, answer) = match read(&mut stream)? {
        Ok(request) => {
            let answer = answer(&request);
            (Some(request), answer)
        }
        Err(status) => (None, Err(status)),
    };
    let is_head = request.is_some_and(|request| request.is_head);
    let mut out = BufWriter::with_capacity(1 << 16, &stream);
    match answer {
        Ok(answer) => {
            head(&mut out, "200 OK", answer.kind, answer.length, answer.is_gzip)?;
            if !is_head {
                (answer.write)(&mut out)?;
            }
        }
        Err(status) => {
            let text = format!("{}\n", status.line());
            head(&mut out, status.line(), "text/plain; charset=utf-8", Some(text.len() as u64), false)?;
            if !is_head {
                out.write_all(text.as_bytes())?;
            }
        }
    }
    out.flush()?;
    drop(out);
    // What has not been read when a connection is closed takes the answer with it: so the rest is read, within reason.
    stream.shutdown(Shutdown::Write)?;
    stream.set_read_timeout(Some(Duration::from_secs(1)))?;
    std::io::copy(&mut stream.take(1 << 20), &mut std::io::sink()).map(drop)
}

fn head(out: &mut impl Write, status: &str, kind: &str, length: Option<u64>, is_gzip: bool) -> Result<()> {
    write!(out, "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nCache-Control: no-cache\r\n")?;
    out.write_all(b"X-Content-Type-Options: nosniff\r\nCross-Origin-Resource-Policy: same-origin\r\n")?;
    if status.starts_with("405") {
        out.write_all(b"Allow: GET, HEAD\r\n")?;
    }
    if is_gzip {
        out.write_all(b"Content-Encoding: gzip\r\nVary: Accept-Encoding\r\n")?;
    }
    if let Some(length) = length {
        write!(out, "Content-Length: {length}\r\n")?;
    }
    out.write_all(b"Connection: close\r\n\r\n")
}

/// Reads up to the end of the headers.
fn read(stream: &mut TcpStream) -> Result<std::result::Result<Request, Status>> {
    let mut bytes = Vec::new();
    let mut piece = [0; 4096];
    loop {
        let count = stream.read(&mut piece)?;
        bytes.extend_from_slice(&piece[..count]);
        match parse(&bytes) {
            Ok(Some(request)) => return Ok(Ok(request)),
            Err(status) => return Ok(Err(status)),
            Ok(None) if bytes.len() > MOST_HEADER_BYTES => return Ok(Err(Status::HeadersTooLarge)),
            Ok(None) if count == 0 => return Ok(Err(Status::BadRequest)),
            Ok(None) => {}
        }
    }
}

/// A request, if all of it is there.
fn parse(bytes: &[u8]) -> std::result::Result<Option<Request>, Status> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    match request.parse(bytes) {
        Ok(httparse::Status::Complete(length)) if length <= MOST_HEADER_BYTES => {}
        Ok(httparse::Status::Partial) => return Ok(None),
        Ok(httparse::Status::Complete(_)) | Err(httparse::Error::TooManyHeaders) => {
            return Err(Status::HeadersTooLarge);
        }
        Err(_) => return Err(Status::BadRequest),
    }
    let (Some(method), Some(target)) = (request.method, request.path) else { return Err(Status::BadRequest) };
    let named = |name: &str| {
        let mut values = request.headers.iter().filter(|header| header.name.eq_ignore_ascii_case(name));
        let value = values.next().and_then(|header| std::str::from_utf8(header.value).ok());
        // Of two the one that is looked at may not be the one that counts.
        value.filter(|_| values.next().is_none()).map(|value| value.trim().to_owned())
    };
    Ok(Some(Request {
        is_reading: matches!(method, "GET" | "HEAD"),
        is_head: method == "HEAD",
        path: target.split('?').next().unwrap_or_default().to_owned(),
        host: named("host"),
        takes_gzip: named("accept-encoding").is_some_and(|names| names.split(',').any(|name| name.trim() == "gzip")),
        last_event: named("last-event-id"),
    }))
}
