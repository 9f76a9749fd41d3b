//! Pictures as textures.

use crate::picture::{self, Format};
use crate::report::Report;
use snell::film::Rgb;
use snell::film::transfer::from_srgb;
use snell::texture::Image;
use std::path::Path;

/// Reads a PNG (8 or 16 bit, gray, colour or palette; alpha is left out), PPM, EXR or NPY picture of at most 2²⁶ pixels as a
/// texture in linear light. Integers become 0 to 1; with `srgb` they are decoded by the curve of IEC 61966-2-1, as colours
/// want it. What is no colour, like a map of heights, and what was written with `transfer = "linear"` want `srgb` off.
/// Floating point numbers are taken as they are; of an EXR the first layer with red, green and blue, its data window.
///
/// # Errors
/// When the file is not such a picture, is cut off or too large, or holds a number that is not finite as `f32`.
pub fn read_image(path: &Path, srgb: bool) -> Result<Image, Report> {
    Format::of(path).map_err(|report| {
        let known = report.help.clone().unwrap_or_default();
        let (from, to) = (path.display(), path.with_extension("png"));
        report.help(format!("{known}; convert others, for example: magick {from} {}", to.display()))
    })?;
    let picture = picture::read_as(path, |max| {
        let linear = |code: u32, max: u32| {
            let value = f64::from(code) / f64::from(max);
            (if srgb { from_srgb(value) } else { value }) as f32
        };
        let table: Option<Vec<f32>> = max.map(|max| (0..=max).map(|code| linear(code, max)).collect());
        move |color: Rgb| {
            color.to_array().map(|c| match &table {
                Some(table) => table[c as usize],
                None => c as f32,
            })
        }
    })
    .map_err(|report| match report.help {
        None if path.is_file() => report.help("save it again as .png, smaller if it is too large"),
        _ => report,
    })?;
    Image::new(picture.width, picture.height, picture.pixels).map_err(|why| {
        let help = "clip its largest numbers and replace those that are none";
        Report::error(format!("`{}` is no texture: {why}", path.display())).help(help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::png::{BitDepth, ColorType};
    use snell::film::transfer::{Encoding, Rounding, Transfer};
    use snell::film::{Crop, Film};

    /// 2 x 1 pixels as PNG.
    fn write_png(path: &Path, color: ColorType, depth: BitDepth, data: &[u8]) {
        let mut encoder = ::png::Encoder::new(std::fs::File::create(path).unwrap(), 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![10, 20, 30, 255, 0, 128]);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
    }

    #[test]
    fn every_kind_of_png_is_decoded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for (color, depth, data, max, expected) in [
            (ColorType::Grayscale, BitDepth::Eight, &[0, 200][..], 255, [[0; 3], [200; 3]]),
            (ColorType::Grayscale, BitDepth::One, &[0b0100_0000], 255, [[0; 3], [255; 3]]),
            (ColorType::Grayscale, BitDepth::Sixteen, &[1, 2, 255, 255], 65535, [[258; 3], [65535; 3]]),
            (ColorType::GrayscaleAlpha, BitDepth::Eight, &[7, 0, 9, 255], 255, [[7; 3], [9; 3]]),
            (ColorType::Rgb, BitDepth::Eight, &[1, 2, 3, 4, 5, 6], 255, [[1, 2, 3], [4, 5, 6]]),
            (ColorType::Rgba, BitDepth::Eight, &[1, 2, 3, 0, 4, 5, 6, 9], 255, [[1, 2, 3], [4, 5, 6]]),
            (ColorType::Indexed, BitDepth::Eight, &[1, 0], 255, [[255, 0, 128], [10, 20, 30]]),
        ] {
            write_png(&path, color, depth, data);
            let value = |code: u16| f64::from(code) / f64::from(max);
            let linear = read_image(&path, false).unwrap();
            assert_eq!((linear.width(), linear.height()), (2, 1));
            assert_eq!(linear.pixels(), expected.map(|p| p.map(|c| value(c) as f32)), "{color:?} {depth:?}");
            let decoded = read_image(&path, true).unwrap();
            assert_eq!(
                decoded.pixels(),
                expected.map(|p| p.map(|c| from_srgb(value(c)) as f32)),
                "{color:?} {depth:?}"
            );
        }
    }

    #[test]
    fn a_film_comes_back_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let mut film = Film::new([2, 2], Crop { x: 0, y: 0, width: 2, height: 2 }).unwrap();
        film.pixels = [0.0, 0.25, 0.5, 1.0].map(|c| Rgb::new(c, 1.0 - c, 0.125)).to_vec();
        film.finished.fill(true);
        film.pixels[3].r = 1000.0;
        for (name, format, bits) in [
            ("a.exr", Format::Exr, 24),
            ("a.npy", Format::Npy, 24),
            ("a.png", Format::Png { sixteen_bit: true }, 16),
            ("a.ppm", Format::Ppm { binary: true }, 8),
            ("a.ppm", Format::Ppm { binary: false }, 8),
        ] {
            let path = folder.path().join(name);
            let encoding = Encoding { transfer: Transfer::Srgb, rounding: Rounding::Round };
            picture::write(&path, format, &film, encoding, None).unwrap();
            let image = read_image(&path, true).unwrap();
            for (texel, pixel) in image.pixels().iter().zip(&film.pixels) {
                for (read, written) in texel.iter().zip(pixel.to_array()) {
                    let written = if bits < 24 { written.min(1.0) } else { written };
                    // Half a code, where the curve is steepest: 2.4/1.055 = 2.27.
                    let bound = if bits < 24 { 1.14 / (libm::exp2(f64::from(bits)) - 1.0) } else { 0.0 };
                    assert!((f64::from(*read) - written).abs() <= bound + 1e-7 * bound, "{name} {read} {written}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_texture_is_refused_with_advice() {
        let folder = tempfile::tempdir().unwrap();
        let error = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            let report = read_image(&path, true).unwrap_err();
            assert!(report.message.contains(name), "{report}");
            (report.message, report.help.unwrap())
        };
        let (message, help) = error("wall.jpg", b"");
        assert!(
            message.contains("no ending of a picture") && help.contains("magick") && help.contains("wall.png"),
            "{help}"
        );
        assert!(error("cut.ppm", b"P6 2 2 255 1").1.contains("save it again"));
        assert!(error("bomb.ppm", b"P6 100000 100000 255 1").0.contains("too many"));
        let mut film = Film::new([2, 1], Crop { x: 0, y: 0, width: 2, height: 1 }).unwrap();
        film.pixels[1].g = 1e39;
        film.finished.fill(true);
        let path = folder.path().join("bright.npy");
        let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
        picture::write(&path, Format::Npy, &film, encoding, None).unwrap();
        let (message, help) = error("bright.npy", &std::fs::read(&path).unwrap());
        assert!(message.contains("column 1, row 0") && help.contains("clip"), "{message}");
        let missing = read_image(&folder.path().join("no.png"), true).unwrap_err();
        assert!(missing.message.contains("there is no file") && missing.message.contains("no.png"), "{missing}");
    }
}
