//! PNG, with the recipe in a text chunk.

use super::stripes::Stripes;
use super::{MAX_PIXELS, Picture, checked_pixels, fallible};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use png::{BitDepth, ColorType, Transformations, chunk};
use snell::film::transfer::Encoding;
use snell::film::{Film, Rgb};
use std::io::{Cursor, Write};
use std::ops::Range;

const KEYWORD: &str = "snell";

/// Rows that are compressed on their own.
const STRIPE: usize = 64;
/// Of deflate, from 0 to 9. For rendered pictures files are a twentieth larger than at 6, in half the time.
const LEVEL: u32 = 4;
/// How a zlib stream begins (RFC 1950): deflate, a window of 32 kB; and an empty last block of deflate (RFC 1951).
const ZLIB: [u8; 2] = [0x78, 0x5e];
const LAST_BLOCK: [u8; 2] = [0x03, 0x00];

/// Writes a film. While its pixels are compressed, `recipe` says what is kept with it.
pub(super) fn write(
    out: &mut dyn Write,
    film: &Film,
    encoding: Encoding,
    sixteen_bit: bool,
    threads: usize,
    recipe: impl FnOnce() -> Option<String> + Send,
) -> std::io::Result<()> {
    let form = Form { film, encoding, sixteen_bit, opaque: film.is_finished() };
    let mut stripes = Stripes::new(film.height(), STRIPE, threads);
    let (mut batch, recipe) = stripes.next_and(|rows| form.stripe(rows), recipe);

    let mut encoder = png::Encoder::new(out, film.crop.width, film.crop.height);
    encoder.set_color(if form.opaque { ColorType::Rgb } else { ColorType::Rgba });
    encoder.set_depth(if sixteen_bit { BitDepth::Sixteen } else { BitDepth::Eight });
    encoder.add_text_chunk("Software".to_owned(), concat!("Snell ", env!("CARGO_PKG_VERSION")).to_owned())?;
    if let Some(recipe) = recipe {
        encoder.add_itxt_chunk(KEYWORD.to_owned(), recipe)?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_chunk(chunk::IDAT, &ZLIB)?;
    let mut checksum = Adler32::default();
    while !batch.is_empty() {
        for Stripe { compressed, checksum: of_stripe, length } in batch {
            checksum = checksum.then(of_stripe, length);
            writer.write_chunk(chunk::IDAT, &compressed?)?;
        }
        batch = stripes.next(|rows| form.stripe(rows));
    }
    writer.write_chunk(chunk::IDAT, &[&LAST_BLOCK[..], &checksum.0.to_be_bytes()].concat())?;
    Ok(writer.finish()?)
}

struct Form<'a> {
    film: &'a Film,
    encoding: Encoding,
    sixteen_bit: bool,
    opaque: bool,
}

/// Some rows as whole blocks of deflate.
struct Stripe {
    compressed: std::io::Result<Vec<u8>>,
    /// Of what was compressed, and how many bytes that was.
    checksum: Adler32,
    length: usize,
}

impl Form<'_> {
    fn stripe(&self, rows: Range<usize>) -> Stripe {
        let filtered = self.filtered(rows);
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::new(LEVEL));
        // A flush ends at a whole byte, so that the next stripe may follow.
        let written = encoder.write_all(&filtered).and_then(|()| encoder.flush());
        let compressed = written.map(|()| std::mem::take(encoder.get_mut()));
        Stripe { compressed, checksum: Adler32::of(&filtered), length: filtered.len() }
    }

    /// The bytes of some rows, each after its filter: `Sub`, the difference to the pixel on the left (PNG 1.2, 6.3).
    fn filtered(&self, rows: Range<usize>) -> Vec<u8> {
        let (width, max) = (self.film.width(), if self.sixteen_bit { 65535 } else { 255 });
        let step = if self.opaque { 3 } else { 4 } * if self.sixteen_bit { 2 } else { 1 };
        let (mut codes, mut row) = (vec![0; 3 * width], vec![0; step * width]);
        let mut filtered = Vec::with_capacity(rows.len() * (1 + row.len()));
        for y in rows {
            let numbers = &self.film.numbers()[3 * width * y..][..3 * width];
            self.encoding.encode_all(numbers, max, &mut codes);
            if self.opaque && !self.sixteen_bit {
                row.iter_mut().zip(&codes).for_each(|(byte, &code)| *byte = code as u8);
            } else {
                self.put_pixels(y, &codes, max, &mut row);
            }
            filtered.push(1);
            filtered.extend_from_slice(&row[..step]);
            filtered.extend(row[step..].iter().zip(&row).map(|(byte, left)| byte.wrapping_sub(*left)));
        }
        filtered
    }

    fn put_pixels(&self, y: usize, codes: &[u16], max: u16, row: &mut [u8]) {
        let width = self.film.width();
        let pixels = self.film.pixels[y * width..].iter().zip(&self.film.finished[y * width..]);
        let values = codes.chunks_exact(3).zip(pixels).flat_map(|(codes, (pixel, &done))| {
            // A pixel that has a colour has some of its samples, which are worth showing.
            let is_seen = done || *pixel != Rgb::black();
            let alpha = (!self.opaque).then_some(if is_seen { max } else { 0 });
            codes.iter().copied().chain(alpha)
        });
        if self.sixteen_bit {
            row.as_chunks_mut().0.iter_mut().zip(values).for_each(|(bytes, value)| *bytes = value.to_be_bytes());
        } else {
            row.iter_mut().zip(values).for_each(|(byte, value)| *byte = value as u8);
        }
    }
}

/// The checksum of zlib (RFC 1950, 8.2): `a` is 1 plus all bytes, `b` the sum of all values that `a` has had; `b·65536 + a`.
#[derive(Clone, Copy)]
struct Adler32(u32);

impl Default for Adler32 {
    fn default() -> Self {
        Self(1)
    }
}

impl Adler32 {
    /// The largest prime below 2^16.
    const MODULUS: u64 = 65521;

    fn of(bytes: &[u8]) -> Self {
        let mut checksum = simd_adler32::Adler32::new();
        checksum.write(bytes);
        Self(checksum.finish())
    }

    /// Of these bytes and `length` others after them: `a` of the first starts the second, and is in each of its sums.
    fn then(self, other: Self, length: usize) -> Self {
        let parts = |Self(sums): Self| (u64::from(sums & 0xffff), u64::from(sums >> 16));
        let ((a, b), (a_after, b_after)) = (parts(self), parts(other));
        let start = a + Self::MODULUS - 1;
        let b = (b + b_after + start % Self::MODULUS * (length as u64 % Self::MODULUS)) % Self::MODULUS;
        Self(((b << 16) | ((start + a_after) % Self::MODULUS)) as u32)
    }
}

/// Snell writes it plain; a compressed one could be of any size.
fn recipe(info: &png::Info<'_>) -> Option<String> {
    info.utf8_text.iter().find(|t| t.keyword == KEYWORD && !t.compressed)?.get_text().ok()
}

/// The recipe stands before the pixels, which are looked through for their checksums only.
#[cfg(feature = "disk")]
pub(super) fn memory(bytes: &[u8]) -> Result<super::Memory, String> {
    let limits = png::Limits { bytes: MAX_PIXELS as usize * 8 };
    let mut reader =
        png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().map_err(|e| e.to_string())?;
    let recipe = recipe(reader.info());
    Ok(super::Memory { recipe, is_whole: reader.finish().is_ok() })
}

pub(super) fn read<P, F: Fn(Rgb) -> P>(
    bytes: &[u8],
    convert: impl FnOnce(Option<u32>) -> F,
) -> Result<Picture<P>, String> {
    let limits = png::Limits { bytes: MAX_PIXELS as usize * 8 };
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let (width, height) = reader.info().size();
    let count = checked_pixels(width.into(), height.into())?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut data = fallible(size)?;
    data.resize(size, 0);
    let frame = reader.next_frame(&mut data).map_err(|e| e.to_string())?;
    reader.finish().map_err(|e| e.to_string())?;
    let recipe = recipe(reader.info());

    let channels = frame.color_type.samples();
    let sixteen_bit = frame.bit_depth == BitDepth::Sixteen;
    let bytes_each = if sixteen_bit { 2 } else { 1 };
    let sample = |pixel: &[u8], channel: usize| {
        let bytes = &pixel[channel * bytes_each..(channel + 1) * bytes_each];
        bytes.iter().fold(0.0, |value, &byte| value * 256.0 + f64::from(byte))
    };
    // Gray, gray and alpha, colour, colour and alpha.
    let color = |p: &[u8]| {
        if channels < 3 { Rgb::gray(sample(p, 0)) } else { Rgb::new(sample(p, 0), sample(p, 1), sample(p, 2)) }
    };
    let max = Some(if sixteen_bit { 65535 } else { 255 });
    let pixel = convert(max);
    let mut pixels = fallible(count)?;
    pixels.extend(data.chunks_exact(channels * bytes_each).map(|p| pixel(color(p))));
    let mut alpha = None;
    if matches!(frame.color_type, ColorType::GrayscaleAlpha | ColorType::Rgba) {
        let whole = if sixteen_bit { 65535.0 } else { 255.0 };
        let mut read = fallible(count)?;
        read.extend(data.chunks_exact(channels * bytes_each).map(|p| (sample(p, channels - 1) / whole) as f32));
        alpha = Some(read);
    }
    Ok(Picture { width: width as usize, height: height as usize, pixels, alpha, max, recipe })
}
