use super::*;
use proptest::prelude::*;
use snell::film::Crop;
use snell::scene::{Rounding, Transfer};

const LINEAR: Encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };

/// 3 x 2 pixels, the last one unfinished if asked.
fn film(unfinished: bool) -> Film {
    let mut film = Film::new([8, 8], Crop { x: 2, y: 1, width: 3, height: 2 }).unwrap();
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        *pixel = Rgb::new(i as f64 / 5.0, 0.25, 1.5);
    }
    film.finished.fill(true);
    film.finished[5] = !unfinished;
    film
}

fn linear(format: Format, threads: usize) -> Writing {
    Writing { format, encoding: LINEAR, threads }
}

/// Large enough for several threads; its last stripe is a row.
fn tall_film(width: u32, height: u32) -> Film {
    let mut film = Film::new([width, height], Crop { x: 0, y: 0, width, height }).unwrap();
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let noise = (i as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        *pixel = Rgb::new(noise as f64 / 16_777_216.0, i as f64 / 1e5, if i % 97 < 60 { 0.5 } else { 1e-3 });
    }
    film.finished.fill(true);
    film
}

#[test]
fn large_pictures_come_back_and_their_files_do_not_depend_on_threads() {
    // More stripes than are encoded before the first are written, whatever their height.
    let film = tall_film(23, 64 * 65 + 1);
    for format in [
        Format::Png { sixteen_bit: false },
        Format::Png { sixteen_bit: true },
        Format::Ppm { binary: false },
        Format::Ppm { binary: true },
        Format::Exr,
        Format::Npy,
    ] {
        let bytes = |threads| {
            let mut out = std::io::Cursor::new(Vec::new());
            let mut asked = 0;
            let recipe = || {
                asked += 1;
                Some("a recipe".to_owned())
            };
            linear(format, threads).write_to(&mut out, &film, recipe).unwrap();
            assert_eq!(asked, 1, "also where no recipe is kept: its maker may do more");
            out.into_inner()
        };
        let alone = bytes(1);
        assert!(alone == bytes(2) && alone == bytes(7), "{format:?}");
        let picture = decode(Path::new("x"), &alone, |_| |color: Rgb| color).unwrap();
        assert_eq!((picture.width, picture.height), (film.width(), film.height()));
        for (read, written) in picture.pixels.iter().zip(&film.pixels) {
            let expected = written.to_array().map(|value| match (format, picture.max) {
                (_, Some(max)) => f64::from(LINEAR.encode(value, max as u16)),
                (Format::Exr, _) => f64::from(value as f32),
                _ => value,
            });
            assert_eq!(read.to_array(), expected, "{format:?}");
        }
    }
}

/// Scan lines from top to bottom: the only order that small readers know. Their offsets stand behind the header in this order.
#[test]
fn scan_lines_of_an_exr_go_from_top_to_bottom() {
    let mut out = std::io::Cursor::new(Vec::new());
    linear(Format::Exr, 2).write_to(&mut out, &tall_film(70, 1000), || None).unwrap();
    let bytes = out.into_inner();
    let at = |name: &[u8]| bytes.windows(name.len()).position(|window| window == name).unwrap();
    let order = at(b"lineOrder\0lineOrder\0") + b"lineOrder\0lineOrder\0".len() + 4;
    assert_eq!(bytes[order], 0, "increasing y");
    let reader = ::exr::block::read(std::io::Cursor::new(&bytes), false).unwrap();
    let rows: Vec<i32> = reader
        .all_chunks(false)
        .unwrap()
        .map(|chunk| match chunk.unwrap().compressed_block {
            ::exr::block::chunk::CompressedBlock::ScanLine(block) => block.y_coordinate,
            other => panic!("{other:?} is no scan line"),
        })
        .collect();
    assert_eq!(rows, (0..1000).step_by(16).collect::<Vec<_>>());
}

#[test]
fn every_format_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format, max) in [
        ("a.png", Format::Png { sixteen_bit: false }, Some(255)),
        ("b.png", Format::Png { sixteen_bit: true }, Some(65535)),
        ("a.ppm", Format::Ppm { binary: false }, Some(255)),
        ("b.ppm", Format::Ppm { binary: true }, Some(255)),
        ("a.exr", Format::Exr, None),
        ("a.npy", Format::Npy, None),
    ] {
        for unfinished in [false, true] {
            let (path, film) = (folder.path().join(name), film(unfinished));
            linear(format, 1).write(&path, &film, Some("a recipe, with ü")).unwrap();
            let picture = read(&path).unwrap();
            assert_eq!((picture.width, picture.height, picture.max), (3, 2, max), "{name}");
            let keeps_recipe = matches!(format, Format::Png { .. } | Format::Exr);
            assert_eq!(picture.recipe.as_deref(), keeps_recipe.then_some("a recipe, with ü"), "{name}");
            for (i, (read, written)) in picture.pixels.iter().zip(&film.pixels).enumerate() {
                if unfinished && i == 5 {
                    continue;
                }
                for (read, written) in read.to_array().into_iter().zip(written.to_array()) {
                    let expected = match (format, max) {
                        (_, Some(max)) => f64::from(LINEAR.encode(written, max as u16)),
                        (Format::Exr, _) => f64::from(written as f32),
                        _ => written,
                    };
                    assert_eq!(read, expected, "{name}");
                }
            }
        }
    }
}

#[test]
fn unfinished_pixels_of_which_nothing_is_known_are_transparent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let alpha = |film: &Film| {
        linear(Format::Png { sixteen_bit: false }, 1).write(&path, film, None).unwrap();
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(std::fs::read(&path).unwrap())).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        assert_eq!(reader.next_frame(&mut data).unwrap().color_type, ::png::ColorType::Rgba);
        data.iter().skip(3).step_by(4).copied().collect::<Vec<u8>>()
    };
    let mut film = film(true);
    assert_eq!(alpha(&film), [255; 6], "some samples are there");
    film.pixels[5] = Rgb::black();
    assert_eq!(alpha(&film), [255, 255, 255, 255, 255, 0]);
}

#[test]
fn hostile_pictures_are_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, message) in [
        ("a.ppm", &b"P3 2 2 255 1 2 3"[..], "after 3 of 12 values"),
        ("a.ppm", b"P3 2 2 255", "cut off"),
        ("a.ppm", b"P6 2 2 255 1", "cut off"),
        ("a.ppm", b"P3 100000 100000 255", "too many"),
        ("a.ppm", b"P3 0 1 255", "no size"),
        ("a.ppm", b"P3 1 1 255 1 2 300", "above the largest"),
        ("a.ppm", b"P5 1 1 255", "neither"),
        ("a.ppm", b"P3 # only a comment", "ends where the width"),
        ("a.png", b"\x89PNG\r\n\x1a\n", ""),
        ("a.npy", b"\x93NUMPY\x01\x00\xff\xff{", "header is cut off"),
        (
            "a.npy",
            b"\x93NUMPY\x01\x00\x4a\x00{'descr': '<f8', 'fortran_order': False, 'shape': (99999, 999999, 3), }   ",
            "",
        ),
        ("a.exr", b"\x76\x2f\x31\x01", ""),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let report = read(&path).unwrap_err();
        assert!(report.message.contains(message), "{report}");
    }
    assert!(Format::of(Path::new("x.pgn")).unwrap_err().help.unwrap().contains(".png?"));
}

proptest! {
    /// A picture with some bytes changed or missing is read or refused, but breaks nothing.
    #[test]
    fn damaged_pictures_break_nothing(which in 0usize..4, at in 0usize..600, byte: u8, keep in 0usize..700) {
        let format = [Format::Png { sixteen_bit: false }, Format::Ppm { binary: false }, Format::Exr, Format::Npy][which];
        let mut out = std::io::Cursor::new(Vec::new());
        linear(format, 1).write_to(&mut out, &film(false), || Some("r".to_owned())).unwrap();
        let mut bytes = out.into_inner();
        if let Some(b) = bytes.get_mut(at) {
            *b = byte;
        }
        bytes.truncate(keep);
        let plain = |_| |color: Rgb| color;
        let _ = match format {
            Format::Png { .. } => png::read(&bytes, plain),
            Format::Ppm { .. } => ppm::read(&bytes, plain),
            Format::Exr => exr::read(&bytes, plain),
            Format::Npy => npy::read(&bytes, plain),
        };
    }
}

#[test]
fn a_recipe_is_read_without_pixels_and_what_was_cut_off_is_found() {
    let folder = tempfile::tempdir().unwrap();
    for (name, format) in [("a.png", Format::Png { sixteen_bit: false }), ("a.exr", Format::Exr)] {
        let path = folder.path().join(name);
        linear(format, 1).write(&path, &film(false), Some("a recipe, with ü")).unwrap();
        let memory = memory_of(&path).unwrap();
        assert!(memory.is_whole && memory.recipe.as_deref() == Some("a recipe, with ü"), "{name}: {memory:?}");
        let whole = std::fs::read(&path).unwrap();
        let mut remembered = 0;
        for length in 0..whole.len() {
            std::fs::write(&path, &whole[..length]).unwrap();
            if let Ok(memory) = memory_of(&path) {
                assert!(!memory.is_whole, "{name}, {length} of {} bytes", whole.len());
                remembered += usize::from(memory.recipe.is_some());
            }
        }
        assert!(remembered > 0, "{name}");
    }
    let path = folder.path().join("a.ppm");
    linear(Format::Ppm { binary: true }, 1).write(&path, &film(false), None).unwrap();
    assert!(memory_of(&path).is_err());
}
