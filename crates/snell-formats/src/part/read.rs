//! Reading parts, a few rows at a time.

use super::{HEADER, Header, LOST, SUMS, VERSION, counts};
use crate::files::MAX_SCENE_BYTES;
use crate::picture::npy;
use crate::report::Report;
use snell::film::{Crop, Rgb};
use snell::render::Piece;
use snell::scene::MAX_SPP;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};
use zip::{CompressionMethod, ZipArchive};

/// A part in a file, whose numbers stay there until somebody asks for them.
#[derive(Debug)]
pub struct PartFile {
    path: PathBuf,
    header: Header,
    file: File,
    /// Where the numbers of each piece begin in the file: its sums, and its lost light.
    starts: Vec<[u64; 2]>,
}

impl PartFile {
    /// Opens a part, and sees to it that all of it is there, and is what was written.
    ///
    /// # Errors
    /// If it cannot be read, is no part, is of another version, or has been cut off or changed.
    pub fn open(path: &Path) -> Result<Self, Report> {
        let shown = path.display();
        let failed = |why: String| {
            let report = Report::error(format!("the part `{shown}` cannot be read: {why}"));
            report.help("render it again: `snell render SCENE … --part FILE`")
        };
        let file = File::open(path).map_err(|e| match e.kind() {
            io::ErrorKind::NotFound => Report::error(format!("there is no file `{shown}`")),
            _ => Report::error(format!("cannot read `{shown}`: {e}")),
        })?;
        let not_whole = |e: zip::result::ZipError| match e {
            zip::result::ZipError::FileNotFound => "it has no `part.json`, `sums.npy` and `lost.npy`".to_owned(),
            other => format!("it is no whole ZIP archive ({other})"),
        };
        let mut archive = ZipArchive::new(BufReader::new(&file)).map_err(|e| failed(not_whole(e)))?;
        let mut text = Vec::new();
        archive
            .by_name(HEADER)
            .map_err(|e| failed(not_whole(e)))?
            .take(MAX_SCENE_BYTES)
            .read_to_end(&mut text)
            .map_err(|e| failed(e.to_string()))?;
        let version = serde_json::from_slice::<serde_json::Value>(&text).map_err(|e| failed(e.to_string()))?;
        let version = version.get("snell_part").and_then(serde_json::Value::as_u64);
        if version != Some(u64::from(VERSION)) {
            let read = version.map_or("none".to_owned(), |version| version.to_string());
            return Err(failed(format!("it is of version {read}, and this Snell reads {VERSION}")));
        }
        let header: Header = serde_json::from_slice(&text).map_err(|e| failed(format!("part.json: {e}")))?;
        let of_the_file = |e: String| failed(format!("part.json: {e}"));
        let [sums, lost] = check(header.size, header.crop, header.spp, &header.pieces).map_err(of_the_file)?;
        let mut array = |name: &str, beginning: Vec<u8>, numbers: u64| -> Result<u64, String> {
            let mut entry = archive.by_name(name).map_err(not_whole)?;
            let expected = beginning.len() as u64 + 8 * numbers;
            if entry.compression() != CompressionMethod::Stored || entry.size() != expected {
                return Err(format!("`{name}` has {} bytes, and {expected} were expected", entry.size()));
            }
            let mut read = vec![0; beginning.len()];
            entry.read_exact(&mut read).map_err(|e| e.to_string())?;
            if read != beginning {
                return Err(format!("`{name}` does not begin like the array that `part.json` speaks of"));
            }
            // Reading to the end compares the checksum, but not the length, which an archive may promise and not keep.
            let read = io::copy(&mut entry, &mut io::sink()).map_err(|e| format!("`{name}`: {e}"))?;
            if read != 8 * numbers {
                return Err(format!("`{name}` ends after {read} bytes of numbers, and {} were expected", 8 * numbers));
            }
            let start = entry.data_start().ok_or("its numbers are nowhere")?;
            Ok(start + beginning.len() as u64)
        };
        let sums_at = array(SUMS, npy::beginning("<f8", &format!("({sums}, 3)")), 3 * sums).map_err(failed)?;
        let lost_at = array(LOST, npy::beginning("<u8", &format!("({lost},)")), lost).map_err(failed)?;
        drop(archive);
        let mut at = [sums_at, lost_at];
        let mut starts = Vec::with_capacity(header.pieces.len());
        for piece in &header.pieces {
            starts.push(at);
            at[0] += 24 * piece.pixel_count() * piece.blocks().len() as u64;
            at[1] += 8 * piece.pixel_count();
        }
        Ok(Self { path: path.to_owned(), header, file, starts })
    }

    /// What it is called.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it says of itself.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The sums of some rows of a piece, by its number; the rows are those of the picture.
    ///
    /// # Errors
    /// When reading fails.
    pub fn sums(&mut self, piece: usize, rows: &Range<u32>) -> Result<Vec<Rgb>, Report> {
        let blocks = self.header.pieces[piece].blocks().len() as u64;
        let bytes = self.bytes(piece, 0, rows, 24 * blocks)?;
        let number = |bytes: &[u8]| bytes.as_chunks::<8>().0.first().map_or(0.0, |&b| f64::from_le_bytes(b));
        Ok(bytes
            .as_chunks::<24>()
            .0
            .iter()
            .map(|c| Rgb::new(number(&c[..8]), number(&c[8..16]), number(&c[16..])))
            .collect())
    }

    /// What the pixels of some rows of a piece have lost.
    ///
    /// # Errors
    /// When reading fails.
    pub fn lost(&mut self, piece: usize, rows: &Range<u32>) -> Result<Vec<u64>, Report> {
        let bytes = self.bytes(piece, 1, rows, 8)?;
        Ok(bytes.as_chunks::<8>().0.iter().map(|&b| u64::from_le_bytes(b)).collect())
    }

    fn bytes(&mut self, piece: usize, array: usize, rows: &Range<u32>, of_pixel: u64) -> Result<Vec<u8>, Report> {
        let Crop { y, width, .. } = self.header.pieces[piece].rect;
        let row = u64::from(width) * of_pixel;
        let start = self.starts[piece][array] + u64::from(rows.start - y) * row;
        let mut bytes = vec![0; (row * u64::from(rows.end - rows.start)) as usize];
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut bytes));
        read.map_err(|e| Report::error(format!("cannot read `{}`: {e}", self.path.display())))?;
        Ok(bytes)
    }
}

/// Are these pieces possible of a picture of this size, of which `crop` is wanted with `spp` samples? How many sums in threes, and
/// pixels, they have.
///
/// # Errors
/// With what is not.
pub fn check(size: [u32; 2], crop: Crop, spp: u32, pieces: &[Piece]) -> Result<[u64; 2], String> {
    let fits = |start: u32, length: u32, first: u32, have: u32| {
        length > 0 && start >= first && start.checked_add(length).is_some_and(|end| end <= first.saturating_add(have))
    };
    if !fits(crop.x, crop.width, 0, size[0]) || !fits(crop.y, crop.height, 0, size[1]) {
        return Err(format!("{crop:?} does not lie within {} x {} pixels", size[0], size[1]));
    }
    if spp == 0 || spp > MAX_SPP {
        return Err(format!("{spp} samples per pixel, where 1 to {MAX_SPP} are possible"));
    }
    for piece in pieces {
        let rect = piece.rect;
        if !fits(rect.x, rect.width, crop.x, crop.width) || !fits(rect.y, rect.height, crop.y, crop.height) {
            return Err(format!("the piece {rect:?} does not lie within {crop:?}"));
        }
        let mut from = 0;
        for (number, &[first, end]) in piece.samples.iter().enumerate() {
            if first >= end || end > spp || first < from || (number > 0 && first == from) {
                return Err(format!("{:?} are no ranges of {spp} samples in order", piece.samples));
            }
            from = end;
        }
        if piece.samples.is_empty() {
            return Err("a piece without samples".to_owned());
        }
    }
    counts(pieces).ok_or_else(|| "more pixels than can be counted".to_owned())
}
