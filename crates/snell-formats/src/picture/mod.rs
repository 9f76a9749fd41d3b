//! Pictures in and out.

mod exr;
pub(crate) mod npy;
mod png;
mod ppm;
mod stripes;

pub use exr::write_layers as write_layers_to;

use crate::files::{Out, in_memory};
use crate::report::{Report, nearest};
use snell::film::transfer::Encoding;
use snell::film::{Film, Rgb};
use std::path::Path;

/// A kind of picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics; 8 or 16 bit.
    Png {
        /// 16 instead of 8.
        sixteen_bit: bool,
    },
    /// Portable pixmap, 8 bit; `P3` as text or `P6` as bytes.
    Ppm {
        /// `P6` instead of `P3`.
        binary: bool,
    },
    /// `OpenEXR`, 32-bit float, linear.
    Exr,
    /// `NumPy` array, float64, height x width x 3: the film as it is.
    Npy,
}

const ENDINGS: &[&str] = &["png", "ppm", "exr", "npy"];

impl Format {
    /// The format of a picture that starts with these bytes.
    pub(crate) fn in_bytes(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x89, b'P', b'N', b'G', ..] => Some(Self::Png { sixteen_bit: false }),
            [b'P', b'3' | b'6', space, ..] if space.is_ascii_whitespace() => Some(Self::Ppm { binary: false }),
            [0x76, 0x2f, 0x31, 0x01, ..] => Some(Self::Exr),
            [0x93, b'N', b'U', b'M', b'P', b'Y', ..] => Some(Self::Npy),
            _ => None,
        }
    }

    /// What such a file is, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Png { .. } => "a PNG picture",
            Self::Ppm { .. } => "a PPM picture",
            Self::Exr => "an EXR picture",
            Self::Npy => "a NumPy array",
        }
    }

    /// The format that a file name asks for.
    ///
    /// # Errors
    /// When the ending is none of png, ppm, exr, npy.
    pub fn of(path: &Path) -> Result<Self, Report> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "png" => Ok(Self::Png { sixteen_bit: false }),
            "ppm" => Ok(Self::Ppm { binary: false }),
            "exr" => Ok(Self::Exr),
            "npy" => Ok(Self::Npy),
            _ => {
                let near =
                    nearest(&ending, ENDINGS.iter().copied()).map_or(String::new(), |n| format!("did you mean .{n}? "));
                Err(Report::error(format!("`{}` is not named like a picture", path.display()))
                    .help(near + "pictures are .png, .ppm, .exr or .npy"))
            }
        }
    }
}

/// How a film becomes a file.
#[derive(Clone, Copy, Debug)]
pub struct Writing {
    /// The kind of file.
    pub format: Format,
    /// The curve of PNG and PPM.
    pub encoding: Encoding,
    /// How many threads work on it, which changes no byte of it; 0 for the default number.
    pub threads: usize,
}

/// Fewer pixels are done before other threads have begun.
const WORTH_THREADS: usize = 1 << 16;

impl Writing {
    /// Writes a film. Unfinished pixels are transparent in EXR, and in PNG where they are black; NaN in NPY; as they are in PPM.
    ///
    /// `recipe` is kept in PNG and EXR: what is needed to render the picture again.
    ///
    /// # Errors
    /// When writing fails; what was there before stays.
    #[cfg(feature = "disk")]
    pub fn write(self, path: &Path, film: &Film, recipe: Option<&str>) -> Result<(), Report> {
        crate::disk::write(path, |out| self.write_to(out, film, || recipe.map(str::to_owned)))
    }

    /// The same, to anything that allows writing and seeking. The recipe is made while the pixels are encoded.
    ///
    /// # Errors
    /// When writing fails.
    pub fn write_to(
        self,
        out: &mut dyn Out,
        film: &Film,
        recipe: impl FnOnce() -> Option<String> + Send,
    ) -> std::io::Result<()> {
        let Self { format, encoding, threads } = self;
        let threads = if film.pixels.len() < WORTH_THREADS { 1 } else { threads };
        match format {
            Format::Png { sixteen_bit } => png::write(out, film, encoding, sixteen_bit, threads, recipe),
            Format::Ppm { binary } => ppm::write(out, film, encoding, binary, threads, || drop(recipe())),
            Format::Exr => exr::write(out, film, threads, recipe),
            Format::Npy => snell::threads::beside(threads, recipe, || npy::write(out, film)),
        }
    }
}

/// A film as the bytes of an 8-bit PNG, as [`Writing`] has it; `threads` work on it, 0 for the default number.
///
/// # Errors
/// When it is too large for one.
pub fn png_bytes(film: &Film, encoding: Encoding, threads: usize, recipe: Option<&str>) -> Result<Vec<u8>, Report> {
    let writing = Writing { format: Format::Png { sixteen_bit: false }, encoding, threads };
    in_memory(|out| writing.write_to(out, film, || recipe.map(str::to_owned)))
        .map_err(|e| Report::error(format!("the picture cannot become a PNG: {e}")))
}

/// A picture that was read, with pixels of some kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture<P = Rgb> {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Pixels, row by row, row 0 on top. Integers as they stand in the file.
    pub pixels: Vec<P>,
    /// Alpha from 0 to 1 as in the file, in the same order; `None` where the file has no such channel. PNG's colours are not
    /// multiplied by it; EXR's are.
    pub alpha: Option<Vec<f32>>,
    /// The largest integer (255, 65535), or `None` for floating point.
    pub max: Option<u32>,
    /// What is needed to render it again, if the file says so.
    pub recipe: Option<String>,
}

/// Pictures larger than this are not read, in pixels: 8192 x 8192, 1.6 gigabytes as `f64`.
const MAX_PIXELS: u64 = 1 << 26;

/// Memory for so many elements, or an error in words.
fn fallible<T>(count: usize) -> Result<Vec<T>, String> {
    let mut memory = Vec::new();
    let bytes = count.saturating_mul(size_of::<T>());
    memory.try_reserve_exact(count).map_err(|_| format!("{bytes} bytes of memory cannot be allocated"))?;
    Ok(memory)
}

/// Reads a PNG, PPM, EXR or NPY picture.
///
/// # Errors
/// When the file is not such a picture, is cut off, or is too large.
#[cfg(feature = "disk")]
pub fn read(path: &Path) -> Result<Picture, Report> {
    use crate::files::{Disk, Files, MAX_MODEL_BYTES};
    decode(path, &Disk.read(path, MAX_MODEL_BYTES)?, |_| |color| color)
}

/// What a picture remembers, without its pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Memory {
    /// What is needed to render it again, if the file says so.
    pub recipe: Option<String>,
    /// Is the file there to its end? One that was cut off may still tell its recipe.
    pub is_whole: bool,
}

/// Reads what a PNG or EXR remembers, in a fraction of the time that its pixels would take.
///
/// # Errors
/// When the file cannot be read, or is no such picture.
#[cfg(feature = "disk")]
pub fn memory_of(path: &Path) -> Result<Memory, Report> {
    use crate::files::{Disk, Files, MAX_MODEL_BYTES};
    let bytes = Disk.read(path, MAX_MODEL_BYTES)?;
    let memory = match Format::in_bytes(&bytes) {
        Some(Format::Png { .. }) => png::memory(&bytes),
        Some(Format::Exr) => exr::memory(&bytes),
        _ => Err("it is neither PNG nor EXR".to_owned()),
    };
    memory.map_err(|why| Report::error(format!("`{}` cannot be read: {why}", path.display())))
}

/// [`read`] from the bytes of a file, with pixels that become something smaller as they are read, so that a large picture is in
/// memory once. Told the largest integer ([`Picture::max`]), `convert` says how.
///
/// # Errors
/// As [`read`].
pub(crate) fn decode<P: Clone + 'static, F: Fn(Rgb) -> P + 'static>(
    path: &Path,
    bytes: &[u8],
    convert: impl FnOnce(Option<u32>) -> F,
) -> Result<Picture<P>, Report> {
    let format = Format::in_bytes(bytes).map_or_else(|| Format::of(path), Ok)?;
    let picture = match format {
        Format::Png { .. } => png::read(bytes, convert),
        Format::Ppm { .. } => ppm::read(bytes, convert),
        Format::Exr => exr::read(bytes, convert),
        Format::Npy => npy::read(bytes, convert),
    };
    picture.map_err(|why| Report::error(format!("`{}` cannot be read: {why}", path.display())))
}

/// The number of pixels of a picture that claims this size, if that is acceptable.
fn checked_pixels(width: u64, height: u64) -> Result<usize, String> {
    match width.checked_mul(height) {
        Some(0) | None => Err(format!("{width} x {height} is no size")),
        Some(pixels) if pixels > MAX_PIXELS => {
            Err(format!("{width} x {height} pixels are too many, at most {MAX_PIXELS} are read"))
        }
        Some(pixels) => Ok(pixels as usize),
    }
}

#[cfg(test)]
mod tests;
