//! NPY: `NumPy`'s array file, version 1.0 (NEP 1), as float64 of shape height x width x 3.

use super::{Picture, checked_pixels};
use snell::film::{Film, Rgb};
use std::io::Write;

const MAGIC: &[u8] = b"\x93NUMPY";

/// How an array of this type and shape begins, as Python writes them: `<f8`, `(2, 3)`.
pub(crate) fn beginning(descr: &str, shape: &str) -> Vec<u8> {
    let mut header = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}");
    // Padded with spaces so that the data starts at a multiple of 64.
    while !(MAGIC.len() + 4 + header.len() + 1).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    [MAGIC, &[1, 0], &(header.len() as u16).to_le_bytes(), header.as_bytes()].concat()
}

/// How many numbers are turned into bytes at a time, where they cannot be written as they are.
const BLOCK: usize = 4096;

pub(super) fn write(out: &mut dyn Write, film: &Film) -> std::io::Result<()> {
    out.write_all(&beginning("<f8", &format!("({}, {}, 3)", film.height(), film.width())))?;
    if cfg!(target_endian = "little") && film.is_finished() {
        return out.write_all(bytemuck::cast_slice(film.numbers()));
    }
    for (pixels, finished) in film.pixels.chunks(BLOCK).zip(film.finished.chunks(BLOCK)) {
        let known = pixels.iter().zip(finished).map(|(pixel, &done)| if done { *pixel } else { Rgb::gray(f64::NAN) });
        let bytes: Vec<u8> = known.flat_map(Rgb::to_array).flat_map(f64::to_le_bytes).collect();
        out.write_all(&bytes)?;
    }
    Ok(())
}

pub(super) fn read<P, F: Fn(Rgb) -> P>(
    bytes: &[u8],
    convert: impl FnOnce(Option<u32>) -> F,
) -> Result<Picture<P>, String> {
    if !bytes.starts_with(MAGIC) {
        return Err("it is no NPY file".to_owned());
    }
    let (length, start) = match (bytes.get(6), bytes.get(8..10), bytes.get(8..12)) {
        (Some(1), Some(l), _) => (usize::from(l[0]) + usize::from(l[1]) * 256, 10),
        (Some(2 | 3), _, Some(l)) => (u32::from_le_bytes([l[0], l[1], l[2], l[3]]) as usize, 12),
        _ => return Err("its header is cut off or of an unknown version".to_owned()),
    };
    let header = bytes.get(start..start + length).ok_or("its header is cut off")?;
    let header = String::from_utf8_lossy(header).replace([' ', '"'], "").replace('\'', "");
    if !header.contains("descr:<f8") || !header.contains("fortran_order:False") {
        return Err("expected little-endian float64 in C order ('<f8')".to_owned());
    }
    let shape = header.split("shape:(").nth(1).and_then(|s| s.split(')').next()).unwrap_or_default();
    let shape: Vec<u64> = shape.split(',').filter(|s| !s.is_empty()).map_while(|s| s.parse().ok()).collect();
    let &[height, width, 3] = shape.as_slice() else {
        return Err(format!("expected the shape (height, width, 3), read {shape:?}"));
    };
    let count = checked_pixels(width, height)? * 24;
    let data = bytes.get(start + length..).unwrap_or_default();
    if data.len() < count {
        return Err(format!("it is cut off: {} of {count} bytes of pixels are there", data.len()));
    }
    let value = |bytes: &[u8]| bytes.as_chunks::<8>().0.first().map_or(0.0, |&b| f64::from_le_bytes(b));
    let color = |p: &[u8; 24]| Rgb::new(value(&p[..8]), value(&p[8..16]), value(&p[16..]));
    let pixel = convert(None);
    let pixels = data[..count].as_chunks::<24>().0.iter().map(|p| pixel(color(p))).collect();
    Ok(Picture { width: width as usize, height: height as usize, pixels, alpha: None, max: None, recipe: None })
}
