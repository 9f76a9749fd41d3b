//! EXR: 32-bit float, linear, the data window the part that was rendered, the display window the whole picture.

use super::stripes::Stripes;
use super::{Picture, checked_pixels};
use crate::files::Out;
use exr::block::UncompressedBlock;
use exr::block::writer::ChunksWriter;
use exr::image::write::layers::{LayersWriter, WritableLayers};
use exr::prelude::*;
use snell::film::{Film, Rgb};
use std::io::Cursor;

const KEYWORD: &str = "snell";

/// Scan lines from top to bottom, which every reader knows, 16 in a block.
const ENCODING: Encoding =
    Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };

/// Writes a film. While its first blocks are compressed, `recipe` says what is kept with it.
pub(super) fn write(
    out: &mut dyn Out,
    film: &Film,
    threads: usize,
    recipe: impl FnOnce() -> Option<String> + Send,
) -> std::io::Result<()> {
    let (width, height) = (film.width(), film.height());
    let pixel = |at: Vec2<usize>| {
        let index = at.y() * width + at.x();
        let [r, g, b] = film.pixels[index].to_array().map(|c| c as f32);
        (r, g, b, if film.finished[index] { 1.0_f32 } else { 0.0 })
    };
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Some(Text::from(concat!("Snell ", env!("CARGO_PKG_VERSION"))));
    attributes.layer_position = Vec2(film.crop.x as i32, film.crop.y as i32);
    let display = IntegerBounds::from_dimensions(Vec2(film.full_size[0] as usize, film.full_size[1] as usize));
    let attributes_of_image = ImageAttributes::new(display);
    if film.is_finished() {
        let channels = SpecificChannels::rgb(|at| {
            let (r, g, b, _) = pixel(at);
            (r, g, b)
        });
        let layer = Layer::new((width, height), attributes, ENCODING, channels);
        write_blocks(out, &attributes_of_image, &layer, threads, recipe)
    } else {
        let layer = Layer::new((width, height), attributes, ENCODING, SpecificChannels::rgba(pixel));
        write_blocks(out, &attributes_of_image, &layer, threads, recipe)
    }
}

/// Compresses blocks on several threads, and writes them in their order: the bytes do not depend on the machine.
fn write_blocks<'l, L: WritableLayers<'l>>(
    out: &mut dyn Out,
    attributes: &ImageAttributes,
    layers: &'l L,
    threads: usize,
    recipe: impl FnOnce() -> Option<String> + Send,
) -> std::io::Result<()> {
    let headers = layers.infer_headers(attributes);
    let writer = layers.create_writer(&headers);
    let blocks: Vec<_> = exr::block::enumerate_ordered_header_block_indices(&headers).collect();
    let compress = |range: std::ops::Range<usize>| {
        let (number, index) = blocks[range.start];
        let data = writer.extract_uncompressed_block(&headers, index);
        UncompressedBlock { index, data }.compress_to_chunk(&headers).map(|chunk| (number, chunk))
    };
    let mut stripes = Stripes::new(blocks.len(), 1, threads);
    let (mut batch, recipe) = stripes.next_and(compress, recipe);

    let mut complete = headers.clone();
    remember(&mut complete[0].own_attributes, recipe.as_deref());
    exr::block::write(out, complete, true, |_, chunks| {
        while !batch.is_empty() {
            for compressed in std::mem::take(&mut batch) {
                let (number, chunk) = compressed?;
                chunks.write_chunk(number, chunk)?;
            }
            batch = stripes.next(compress);
        }
        Ok(())
    })
    .map_err(|e| std::io::Error::other(e.to_string()))
}

fn remember(attributes: &mut LayerAttributes, recipe: Option<&str>) {
    if let Some(recipe) = recipe {
        let bytes: attribute::TextBytes = recipe.bytes().collect();
        attributes.other.insert(Text::from(KEYWORD), AttributeValue::Text(Text::from_bytes_unchecked(bytes)));
    }
}

/// Writes layers of a picture by their names as EXR, first the picture itself; each has the channels R, G and B. All have
/// `size[0]·size[1]` pixels, row by row. `threads` compress them, 0 for the default number. `recipe` is kept, as in other pictures.
///
/// # Errors
/// When writing fails.
pub fn write_layers(
    out: &mut dyn Out,
    size: [u32; 2],
    picture: &[Rgb],
    layers: &[(String, Vec<Rgb>)],
    threads: usize,
    recipe: Option<&str>,
) -> std::io::Result<()> {
    let size = Vec2(size[0] as usize, size[1] as usize);
    let layer = |name: &str, pixels: &[Rgb]| {
        let channel = |value: fn(&Rgb) -> f64| FlatSamples::F32(pixels.iter().map(|c| value(c) as f32).collect());
        let channels = [("R", channel(|c| c.r)), ("G", channel(|c| c.g)), ("B", channel(|c| c.b))];
        let channels = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
        // Arrows are no characters of the format; other bytes go through as they are.
        let name = Text::from_bytes_unchecked(name.replace('→', "->").bytes().collect::<attribute::TextBytes>());
        Layer::new(size, LayerAttributes::named(name), ENCODING, AnyChannels::sort(channels))
    };
    let named = layers.iter().map(|(name, pixels)| (name.as_str(), pixels.as_slice()));
    let layers: Layers<AnyChannels<FlatSamples>> =
        [("picture", picture)].into_iter().chain(named).map(|(name, pixels)| layer(name, pixels)).collect();
    let attributes = ImageAttributes::new(IntegerBounds::from_dimensions(size));
    write_blocks(out, &attributes, &layers, threads, || recipe.map(str::to_owned))
}

fn recipe(attributes: &LayerAttributes) -> Option<String> {
    match attributes.other.get(&Text::from(KEYWORD))? {
        AttributeValue::Text(text) => String::from_utf8(text.as_slice().to_vec()).ok(),
        _ => None,
    }
}

/// The recipe stands before the pixels, whose blocks are looked for and not unpacked.
#[cfg(feature = "disk")]
pub(super) fn memory(bytes: &[u8]) -> std::result::Result<super::Memory, String> {
    let reader = exr::block::read(Cursor::new(bytes), false).map_err(|e| e.to_string())?;
    let recipe = reader.headers().first().and_then(|header| recipe(&header.own_attributes));
    let is_whole = reader.all_chunks(false).is_ok_and(|mut chunks| chunks.all(|chunk| chunk.is_ok()));
    Ok(super::Memory { recipe, is_whole })
}

pub(super) fn read<P: Clone + 'static, F: Fn(Rgb) -> P + 'static>(
    bytes: &[u8],
    convert: impl FnOnce(Option<u32>) -> F,
) -> std::result::Result<Picture<P>, String> {
    let convert = convert(None);
    let black = convert(Rgb::gray(0.0));
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            move |size, (.., alpha)| {
                let count = checked_pixels(size.0 as u64, size.1 as u64).unwrap_or(0);
                (size, vec![black.clone(); count], alpha.is_some().then(|| vec![0.0; count]))
            },
            move |(size, pixels, alpha), at, (r, g, b, a): (f32, f32, f32, f32)| {
                let at = at.y() * size.0 + at.x();
                if let Some(pixel) = pixels.get_mut(at) {
                    *pixel = convert(Rgb::new(f64::from(r), f64::from(g), f64::from(b)));
                }
                if let Some(alpha) = alpha.as_mut().and_then(|alpha| alpha.get_mut(at)) {
                    *alpha = a;
                }
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| e.to_string())?;
    let layer = image.layer_data;
    let (size, pixels, alpha) = layer.channel_data.pixels;
    if pixels.is_empty() {
        return Err(format!("{} x {} is not a size that is read", size.0, size.1));
    }
    let recipe = recipe(&layer.attributes);
    Ok(Picture { width: size.0, height: size.1, pixels, alpha, max: None, recipe })
}
