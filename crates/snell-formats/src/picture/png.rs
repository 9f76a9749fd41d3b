//! PNG, with the recipe in a text chunk.

use super::{MAX_PIXELS, Picture, checked_pixels, fallible};
use png::{BitDepth, ColorType, Transformations};
use snell::film::transfer::Encoding;
use snell::film::{Film, Rgb};
use std::io::{Cursor, Write};

const KEYWORD: &str = "snell";

pub(super) fn write(
    out: &mut dyn Write,
    film: &Film,
    encoding: Encoding,
    sixteen_bit: bool,
    recipe: Option<&str>,
) -> std::io::Result<()> {
    let finished = film.is_finished();
    let mut encoder = png::Encoder::new(out, film.crop.width, film.crop.height);
    encoder.set_color(if finished { ColorType::Rgb } else { ColorType::Rgba });
    encoder.set_depth(if sixteen_bit { BitDepth::Sixteen } else { BitDepth::Eight });
    encoder.add_text_chunk("Software".to_owned(), concat!("Snell ", env!("CARGO_PKG_VERSION")).to_owned())?;
    if let Some(recipe) = recipe {
        encoder.add_itxt_chunk(KEYWORD.to_owned(), recipe.to_owned())?;
    }
    let max = if sixteen_bit { 65535 } else { 255 };
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    let mut row = Vec::new();
    let width = film.width();
    for (pixels, finished_pixels) in film.pixels.chunks_exact(width).zip(film.finished.chunks_exact(width)) {
        row.clear();
        for (pixel, &done) in pixels.iter().zip(finished_pixels) {
            // Of a pixel that has a colour some samples are there, which are worth showing.
            let is_seen = done || *pixel != Rgb::black();
            let alpha = (!finished).then_some(if is_seen { max } else { 0 });
            for value in pixel.to_array().map(|c| encoding.encode(c, max)).into_iter().chain(alpha) {
                if sixteen_bit {
                    row.extend(value.to_be_bytes());
                } else {
                    row.push(value as u8);
                }
            }
        }
        stream.write_all(&row)?;
    }
    stream.finish()?;
    Ok(writer.finish()?)
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
