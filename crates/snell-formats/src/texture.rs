//! Pictures as textures.

use crate::files::{Files, MAX_MODEL_BYTES, sha256};
use crate::picture::{self, Picture};
use crate::report::Report;
use snell::film::Rgb;
use snell::film::transfer::from_srgb;
use snell::texture::Image;
use std::path::Path;

/// Reads a PNG (8 or 16 bit, gray, colour or palette), PPM, EXR or NPY picture of at most 2²⁶ pixels as a texture in linear
/// light, with the alpha of PNG and EXR. Integers become 0 to 1; with `srgb` they are decoded by the curve of IEC 61966-2-1, as
/// colours want it. What is no colour, like a map of heights, and what was written with `transfer = "linear"` want `srgb` off.
/// Floating point numbers are taken as they are; of an EXR the first layer with red, green and blue, its data window. An EXR's
/// colours are multiplied by its alpha, by its convention, and are divided by it here.
///
/// # Errors
/// When the file is not such a picture, is cut off or too large, or holds a number that is not finite as `f32`.
#[cfg(feature = "disk")]
pub fn read_image(path: &Path, srgb: bool) -> Result<Image, Report> {
    read_with_hash(&crate::files::Disk, path, srgb).map(|(image, _)| image)
}

/// The same of any files, with the SHA-256 of the one.
///
/// # Errors
/// As `read_image`.
pub(crate) fn read_with_hash(files: &dyn Files, path: &Path, srgb: bool) -> Result<(Image, String), Report> {
    let advise = |report: Report| match report.help.clone() {
        None if files.is_file(path) => report.help("save it again as .png, smaller if it is too large"),
        Some(known) if files.is_file(path) => {
            let (from, to) = (path.display(), path.with_extension("png"));
            report.help(format!("{known}; convert others, for example: magick {from} {}", to.display()))
        }
        _ => report,
    };
    let bytes = files.read(path, MAX_MODEL_BYTES).map_err(advise)?;
    let hash = sha256([&bytes]);
    let mut picture = picture::decode(path, &bytes, |max| {
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
    .map_err(advise)?;
    drop(bytes);
    // Of the formats with alpha, only EXR has no largest integer.
    let is_premultiplied = picture.max.is_none();
    if let Some(alpha) = picture.alpha.as_ref().filter(|_| is_premultiplied) {
        for (pixel, &alpha) in picture.pixels.iter_mut().zip(alpha).filter(|&(_, &alpha)| alpha > 0.0 && alpha < 1.0) {
            *pixel = pixel.map(|c| c / alpha);
        }
    }
    let Picture { width, height, pixels, .. } = picture;
    let image = match picture.alpha {
        None => Image::new(width, height, pixels),
        Some(alpha) => Image::with_alpha(width, height, pixels, alpha),
    };
    image.map(|image| (image, hash)).map_err(|why| {
        let help = "clip its largest numbers and replace those that are none";
        Report::error(format!("`{}` is no texture: {why}", path.display())).help(help)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::{Format, Writing};
    use ::png::{BitDepth, ColorType};
    use snell::film::transfer::{Encoding, Rounding, Transfer};
    use snell::film::{Crop, Film};

    /// 2 x 1 pixels as PNG, perhaps with a transparent colour or alphas of the palette.
    fn write_png(path: &Path, color: ColorType, depth: BitDepth, data: &[u8], transparent: Option<&[u8]>) {
        let mut encoder = ::png::Encoder::new(std::fs::File::create(path).unwrap(), 2, 1);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if color == ColorType::Indexed {
            encoder.set_palette(vec![10, 20, 30, 255, 0, 128]);
        }
        if let Some(transparent) = transparent {
            encoder.set_trns(transparent.to_vec());
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
            write_png(&path, color, depth, data, None);
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
    fn every_kind_of_alpha_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let (eight, sixteen) = (BitDepth::Eight, BitDepth::Sixteen);
        for (color, depth, data, transparent, expected) in [
            (ColorType::GrayscaleAlpha, eight, &[7, 0, 9, 255][..], None, Some([0.0, 1.0])),
            (ColorType::GrayscaleAlpha, sixteen, &[0, 7, 255, 255, 0, 9, 0, 51], None, Some([1.0, 51.0 / 65535.0])),
            (ColorType::Rgba, eight, &[1, 2, 3, 0, 4, 5, 6, 51], None, Some([0.0, 0.2])),
            (ColorType::Rgba, eight, &[1, 2, 3, 255, 4, 5, 6, 255], None, None),
            (ColorType::Indexed, eight, &[1, 0], Some(&[51][..]), Some([1.0, 0.2])),
            (ColorType::Indexed, eight, &[1, 0], Some(&[255, 0]), Some([0.0, 1.0])),
            (ColorType::Rgb, eight, &[1, 2, 3, 4, 5, 6], Some(&[0, 4, 0, 5, 0, 6]), Some([1.0, 0.0])),
            (ColorType::Grayscale, BitDepth::One, &[0b0100_0000], Some(&[0, 1]), Some([1.0, 0.0])),
            (ColorType::Grayscale, eight, &[3, 4], None, None),
        ] {
            write_png(&path, color, depth, data, transparent);
            // Alpha is a share, whatever the curve of the colours.
            for srgb in [true, false] {
                let image = read_image(&path, srgb).unwrap();
                let expected = expected.map(|alpha: [f64; 2]| alpha.map(|a| a as f32).to_vec());
                assert_eq!(image.alpha().map(<[f32]>::to_vec), expected, "{color:?} {depth:?} {transparent:?}");
            }
        }
    }

    /// EXR's colours are multiplied by their alpha. What is not there has no colour, and what is more than there is there.
    #[test]
    fn the_alpha_of_exr_is_taken_out_of_its_colours() {
        use exr::prelude::{Image as Layers, SpecificChannels, Vec2, WritableImage};
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let write = |alphas: [f32; 4]| {
            let channels = SpecificChannels::rgba(|at: Vec2<usize>| (0.25f32, 0.5f32, 1.0f32, alphas[at.x()]));
            Layers::from_channels((4, 1), channels).write().to_file(&path).unwrap();
            read_image(&path, true)
        };
        let image = write([1.0, 0.25, 0.0, 1.5]).unwrap();
        let [whole, lifted]: [[f32; 3]; 2] = [[0.25, 0.5, 1.0], [1.0, 2.0, 4.0]];
        assert_eq!(
            (image.pixels(), image.alpha()),
            (&[whole, lifted, whole, whole][..], Some(&[1.0, 0.25, 0.0, 1.0][..]))
        );
        assert_eq!(image.bilinear_with_alpha(0.625, 0.5).1, 0.0);
        assert_eq!(write([1.0; 4]).unwrap().alpha(), None);
        let report = write([1.0, f32::NAN, 1.0, 1.0]).unwrap_err();
        assert!(report.message.contains("column 1, row 0") && report.help.is_some(), "{report}");
        // Beyond what `f32` holds.
        assert!(write([1.0, 1e-39, 1.0, 1.0]).is_err());
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
            Writing { format, encoding, threads: 1 }.write(&path, &film, None).unwrap();
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
            message.contains("not named like a picture") && help.contains("magick") && help.contains("wall.png"),
            "{help}"
        );
        assert!(error("cut.ppm", b"P6 2 2 255 1").1.contains("save it again"));
        assert!(error("bomb.ppm", b"P6 100000 100000 255 1").0.contains("too many"));
        let mut film = Film::new([2, 1], Crop { x: 0, y: 0, width: 2, height: 1 }).unwrap();
        film.pixels[1].g = 1e39;
        film.finished.fill(true);
        let path = folder.path().join("bright.npy");
        let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
        Writing { format: Format::Npy, encoding, threads: 1 }.write(&path, &film, None).unwrap();
        let (message, help) = error("bright.npy", &std::fs::read(&path).unwrap());
        assert!(message.contains("column 1, row 0") && help.contains("clip"), "{message}");
        let missing = read_image(&folder.path().join("no.png"), true).unwrap_err();
        assert!(missing.message.contains("there is no file") && missing.message.contains("no.png"), "{missing}");
    }
}
