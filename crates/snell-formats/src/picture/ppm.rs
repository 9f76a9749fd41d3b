//! PPM: `P3` as text and `P6` as bytes, the course's format.

use super::stripes::Stripes;
use super::{Picture, checked_pixels, fallible};
use snell::film::transfer::Encoding;
use snell::film::{Film, Rgb};
use std::io::Write;
use std::ops::Range;

/// Rows that one thread turns into text.
const STRIPE: usize = 32;

pub(super) fn write(
    out: &mut dyn Write,
    film: &Film,
    encoding: Encoding,
    binary: bool,
    threads: usize,
    meanwhile: impl FnOnce() + Send,
) -> std::io::Result<()> {
    let (magic, width, height) = (if binary { "P6" } else { "P3" }, film.width(), film.height());
    writeln!(out, "{magic}\n{width} {height} 255")?;
    let words = Words::new();
    let encode = |rows: Range<usize>| {
        let mut codes = vec![0; 3 * width];
        let mut bytes = Vec::with_capacity(rows.len() * 3 * width * if binary { 1 } else { 4 });
        for y in rows {
            encoding.encode_all(&film.numbers()[3 * width * y..][..3 * width], 255, &mut codes);
            if binary {
                bytes.extend(codes.iter().map(|&code| code as u8));
            } else {
                words.push(&codes, &mut bytes);
            }
        }
        bytes
    };
    let mut stripes = Stripes::new(film.height(), STRIPE, threads);
    let (mut batch, ()) = stripes.next_and(encode, meanwhile);
    while !batch.is_empty() {
        batch.iter().try_for_each(|bytes| out.write_all(bytes))?;
        batch = stripes.next(encode);
    }
    Ok(())
}

/// What each code is as text, with a space after it, and how long that is.
struct Words([([u8; 4], usize); 256]);

impl Words {
    fn new() -> Self {
        Self(std::array::from_fn(|code| {
            let (text, mut bytes) = (format!("{code} "), [0; 4]);
            bytes[..text.len()].copy_from_slice(text.as_bytes());
            (bytes, text.len())
        }))
    }

    /// A row of codes, which ends with a line feed instead of a space.
    fn push(&self, codes: &[u16], bytes: &mut Vec<u8>) {
        for &code in codes {
            let (word, length) = self.0[usize::from(code as u8)];
            // All four bytes, without the surplus afterwards: a length that is known is copied in one step.
            bytes.extend_from_slice(&word);
            bytes.truncate(bytes.len() - (4 - length));
        }
        bytes.pop();
        bytes.push(b'\n');
    }
}

pub(super) fn read<P, F: Fn(Rgb) -> P>(
    bytes: &[u8],
    convert: impl FnOnce(Option<u32>) -> F,
) -> Result<Picture<P>, String> {
    let mut header = Header { bytes, at: 2 };
    let binary = match bytes.get(..2) {
        Some(b"P3") => false,
        Some(b"P6") => true,
        _ => return Err("it starts neither with P3 nor with P6".to_owned()),
    };
    let (width, height) = (header.number("the width")?, header.number("the height")?);
    let max = header.number("the largest value")?;
    if !(1..=65535).contains(&max) {
        return Err(format!("the largest value {max} is not between 1 and 65535"));
    }
    let count = checked_pixels(width, height)?;
    // Each value takes a byte at least: a short file cannot ask for much memory.
    if bytes.len() < 3 * count {
        return Err(format!("it is cut off: {} values need more than {} bytes", 3 * count, bytes.len()));
    }
    let size = if max > 255 { 2 } else { 1 };
    // One white-space character ends the header.
    let data = bytes.get(header.at + 1..).unwrap_or_default();
    if binary && data.len() < 3 * count * size {
        return Err(format!("it is cut off: {} of {} bytes of pixels are there", data.len(), 3 * count * size));
    }
    let mut sample = |i: usize| {
        let value = if binary {
            data[i * size..][..size].iter().fold(0, |value, &byte| value * 256 + u64::from(byte))
        } else {
            header.number("a value").map_err(|e| format!("{e}, after {i} of {} values", 3 * count))?
        };
        if value <= max { Ok(value as f64) } else { Err(format!("a value {value} is above the largest, {max}")) }
    };
    let pixel = convert(Some(max as u32));
    let mut pixels = fallible(count)?;
    for i in 0..count {
        pixels.push(pixel(Rgb::new(sample(3 * i)?, sample(3 * i + 1)?, sample(3 * i + 2)?)));
    }
    Ok(Picture {
        width: width as usize,
        height: height as usize,
        pixels,
        alpha: None,
        max: Some(max as u32),
        recipe: None,
    })
}

struct Header<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Header<'_> {
    /// The next whole number, after white space and comments.
    fn number(&mut self, what: &str) -> Result<u64, String> {
        while let Some(byte) = self.bytes.get(self.at) {
            match byte {
                b'#' => {
                    self.at +=
                        self.bytes[self.at..].iter().position(|&b| b == b'\n').unwrap_or(self.bytes.len() - self.at);
                }
                b if b.is_ascii_whitespace() => self.at += 1,
                _ => break,
            }
        }
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_digit) {
            self.at += 1;
        }
        let digits = std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or_default();
        digits.parse().map_err(|_| match self.bytes.get(self.at) {
            None => format!("it ends where {what} should be"),
            Some(&byte) => format!("expected {what}, read `{}` at byte {}", char::from(byte), self.at),
        })
    }
}
