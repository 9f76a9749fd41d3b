//! PNG, with the recipe in a text chunk.

use super::{Picture, checked_pixels};
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
    let mut data = Vec::new();
    for (pixel, &done) in film.pixels.iter().zip(&film.finished) {
        let alpha = (!finished).then_some(if done { max } else { 0 });
        for value in pixel.to_array().map(|c| encoding.encode(c, max)).into_iter().chain(alpha) {
            if sixteen_bit {
                data.extend(value.to_be_bytes());
            } else {
                data.push(value as u8);
            }
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&data)?;
    Ok(writer.finish()?)
}

pub(super) fn read(bytes: &[u8]) -> Result<Picture, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let (width, height) = reader.info().size();
    checked_pixels(width.into(), height.into())?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut data = vec![0; size];
    let frame = reader.next_frame(&mut data).map_err(|e| e.to_string())?;
    reader.finish().map_err(|e| e.to_string())?;
    let info = reader.info();
    let long = info.utf8_text.iter().find(|t| t.keyword == KEYWORD);
    let recipe = long.and_then(|t| t.get_text().ok());

    let channels = frame.color_type.samples();
    let sixteen_bit = frame.bit_depth == BitDepth::Sixteen;
    let samples: Vec<f64> = if sixteen_bit {
        data.as_chunks::<2>().0.iter().map(|b| f64::from(u16::from_be_bytes(*b))).collect()
    } else {
        data.iter().map(|&b| f64::from(b)).collect()
    };
    // Gray, gray and alpha, colour, colour and alpha. Alpha is not compared.
    let color = |p: &[f64]| if channels < 3 { Rgb::gray(p[0]) } else { Rgb::new(p[0], p[1], p[2]) };
    let pixels = samples.chunks_exact(channels).map(color).collect();
    let max = Some(if sixteen_bit { 65535 } else { 255 });
    Ok(Picture { width: width as usize, height: height as usize, pixels, max, recipe })
}
