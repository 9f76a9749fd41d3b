//! EXR: 32-bit float, linear, the data window the part that was rendered, the display window the whole picture.

use super::{Picture, checked_pixels};
use crate::files::Out;
use exr::prelude::*;
use snell::film::{Film, Rgb};
use std::io::Cursor;

const KEYWORD: &str = "snell";

pub(super) fn write(out: &mut dyn Out, film: &Film, recipe: Option<&str>) -> std::io::Result<()> {
    let (width, height) = (film.width(), film.height());
    let pixel = |at: Vec2<usize>| {
        let index = at.y() * width + at.x();
        let [r, g, b] = film.pixels[index].to_array().map(|c| c as f32);
        (r, g, b, if film.finished[index] { 1.0_f32 } else { 0.0 })
    };
    let mut attributes = LayerAttributes::named("");
    attributes.software_name = Some(Text::from(concat!("Snell ", env!("CARGO_PKG_VERSION"))));
    attributes.layer_position = Vec2(film.crop.x as i32, film.crop.y as i32);
    remember(&mut attributes, recipe);
    let display = IntegerBounds::from_dimensions(Vec2(film.full_size[0] as usize, film.full_size[1] as usize));
    // One scan line block after the other, in this thread: the bytes do not depend on the machine.
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::FAST_LOSSLESS };
    let failed = |e: Error| std::io::Error::other(e.to_string());
    if film.is_finished() {
        let channels = SpecificChannels::rgb(|at| {
            let (r, g, b, _) = pixel(at);
            (r, g, b)
        });
        let layer = Layer::new((width, height), attributes, encoding, channels);
        image(display, layer).write().non_parallel().to_buffered(out).map_err(failed)
    } else {
        let layer = Layer::new((width, height), attributes, encoding, SpecificChannels::rgba(pixel));
        image(display, layer).write().non_parallel().to_buffered(out).map_err(failed)
    }
}

fn remember(attributes: &mut LayerAttributes, recipe: Option<&str>) {
    if let Some(recipe) = recipe {
        let bytes: attribute::TextBytes = recipe.bytes().collect();
        attributes.other.insert(Text::from(KEYWORD), AttributeValue::Text(Text::from_bytes_unchecked(bytes)));
    }
}

/// Writes layers of a picture by their names as EXR, first the picture itself; each has the channels R, G and B. All have
/// `size[0]·size[1]` pixels, row by row. `recipe` is kept, as in other pictures.
///
/// # Errors
/// When writing fails.
pub fn write_layers(
    out: &mut dyn Out,
    size: [u32; 2],
    picture: &[Rgb],
    layers: &[(String, Vec<Rgb>)],
    recipe: Option<&str>,
) -> std::io::Result<()> {
    let size = Vec2(size[0] as usize, size[1] as usize);
    let encoding = Encoding { compression: Compression::ZIP16, ..Encoding::FAST_LOSSLESS };
    let layer = |name: &str, pixels: &[Rgb]| {
        let channel = |value: fn(&Rgb) -> f64| FlatSamples::F32(pixels.iter().map(|c| value(c) as f32).collect());
        let channels = [("R", channel(|c| c.r)), ("G", channel(|c| c.g)), ("B", channel(|c| c.b))];
        let channels = channels.into_iter().map(|(name, samples)| AnyChannel::new(name, samples)).collect();
        // Arrows are no characters of the format; other bytes go through as they are.
        let name = Text::from_bytes_unchecked(name.replace('→', "->").bytes().collect::<attribute::TextBytes>());
        Layer::new(size, LayerAttributes::named(name), encoding, AnyChannels::sort(channels))
    };
    let named = layers.iter().map(|(name, pixels)| (name.as_str(), pixels.as_slice()));
    let mut layer_data: Layers<AnyChannels<FlatSamples>> =
        [("picture", picture)].into_iter().chain(named).map(|(name, pixels)| layer(name, pixels)).collect();
    remember(&mut layer_data[0].attributes, recipe);
    let image = Image { attributes: ImageAttributes::new(IntegerBounds::from_dimensions(size)), layer_data };
    image.write().non_parallel().to_buffered(out).map_err(|e| std::io::Error::other(e.to_string()))
}

fn image<C>(display: IntegerBounds, layer: Layer<C>) -> Image<Layer<C>> {
    Image { attributes: ImageAttributes::new(display), layer_data: layer }
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
