//! Writing parts, piece by piece and row by row.

use super::{HEADER, Header, LOST, SUMS};
use crate::files::Out;
use crate::picture::npy;
use snell::film::Rgb;
use snell::render::PartialFilm;
use std::io::{self, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Writes what is there of a picture.
///
/// # Errors
/// When writing fails.
pub fn write(out: &mut dyn Out, header: &Header, film: &PartialFilm) -> io::Result<()> {
    let mut writer = Writer::new(out, header)?;
    let (mut sums, mut lost) = (Vec::new(), Vec::new());
    for piece in &header.pieces {
        for y in piece.rect.y..piece.rect.y + piece.rect.height {
            sums.clear();
            film.row(piece, y, &mut sums);
            writer.sums(&sums)?;
        }
    }
    writer.begin_lost(header)?;
    for piece in &header.pieces {
        for y in piece.rect.y..piece.rect.y + piece.rect.height {
            lost.clear();
            film.lost_row(piece, y, &mut lost);
            writer.lost(&lost)?;
        }
    }
    writer.finish(header)
}

/// Writes the arrays one after the other, and the header behind them, as only then it is known what all samples took.
pub(super) struct Writer<'o> {
    archive: ZipWriter<&'o mut dyn Out>,
    bytes: Vec<u8>,
}

impl<'o> Writer<'o> {
    /// Begins with the sums of these pieces.
    pub fn new(out: &'o mut dyn Out, header: &Header) -> io::Result<Self> {
        let mut writer = Self { archive: ZipWriter::new(out), bytes: Vec::new() };
        let [sums, _] = counts(header)?;
        writer.begin(SUMS, "<f8", &format!("({sums}, 3)"))?;
        Ok(writer)
    }

    fn begin(&mut self, name: &str, descr: &str, shape: &str) -> io::Result<()> {
        self.archive.start_file(name, options())?;
        self.archive.write_all(&npy::beginning(descr, shape))
    }

    pub fn sums(&mut self, sums: &[Rgb]) -> io::Result<()> {
        self.bytes.clear();
        self.bytes.extend(sums.iter().flat_map(|sum| sum.to_array()).flat_map(f64::to_le_bytes));
        self.archive.write_all(&self.bytes)
    }

    pub fn begin_lost(&mut self, header: &Header) -> io::Result<()> {
        let [_, lost] = counts(header)?;
        self.begin(LOST, "<u8", &format!("({lost},)"))
    }

    pub fn lost(&mut self, lost: &[u64]) -> io::Result<()> {
        self.bytes.clear();
        self.bytes.extend(lost.iter().copied().flat_map(u64::to_le_bytes));
        self.archive.write_all(&self.bytes)
    }

    pub fn finish(mut self, header: &Header) -> io::Result<()> {
        self.archive.start_file(HEADER, options())?;
        serde_json::to_writer(&mut self.archive, header)?;
        self.archive.finish().map(drop).map_err(io::Error::from)
    }
}

/// As they are, of any size; without a time, so that the same part is the same file.
fn options() -> SimpleFileOptions {
    SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true)
}

fn counts(header: &Header) -> io::Result<[u64; 2]> {
    super::counts(&header.pieces).ok_or_else(|| io::Error::other("there are more sums than can be counted"))
}
