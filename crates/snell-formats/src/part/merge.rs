//! Joining parts, a few rows of all of them at a time.

use super::write::Writer;
use super::{Header, PartFile, VERSION};
use crate::files::Out;
use crate::report::Report;
use snell::film::{Crop, Film, Rgb};
use snell::render::{Grid, PartialFilm, Piece};
use snell::trace::Statistics;
use std::io;
use std::ops::Range;

/// So many rows are in memory at a time.
const ROWS: u32 = 16;

/// So many rectangles are named.
const NAMED: usize = 5;

/// Parts of one picture, of which no sample is there twice.
#[derive(Debug)]
pub struct Merge {
    parts: Vec<PartFile>,
    /// Which of them says what the whole is: the first one of those that want the most samples.
    leading: usize,
    crop: Crop,
    grid: Grid,
    /// Of each cell, which samples are there.
    there: Vec<Vec<[u32; 2]>>,
}

impl Merge {
    /// Parts that belong together. Those of a picture to which samples were added later may want fewer of them.
    ///
    /// # Errors
    /// If they are of different pictures, with the first difference, or have samples in common, with their pixels.
    pub fn new(parts: Vec<PartFile>) -> Result<Self, Report> {
        let Some((first, others)) = parts.split_first() else { return Err(Report::error("there are no parts")) };
        for other in others {
            same_picture(first, other)?;
        }
        let crop = first.header().crop;
        let leading = (0..parts.len()).rev().max_by_key(|&number| parts[number].header().spp).unwrap_or_default();
        let rects = parts.iter().flat_map(|part| part.header().pieces.iter().map(|piece| piece.rect));
        let grid = Grid::new(crop, u32::MAX, rects);
        let mut there: Vec<Vec<([u32; 2], usize)>> = vec![Vec::new(); grid.cells().count()];
        for (number, part) in parts.iter().enumerate() {
            for piece in &part.header().pieces {
                for cell in grid.within(piece.rect) {
                    there[cell].extend(piece.samples.iter().map(|&samples| (samples, number)));
                }
            }
        }
        for ranges in &mut there {
            ranges.sort_unstable();
        }
        let twice = |cell: usize| {
            let pairs = there[cell].windows(2).filter(|pair| pair[1].0[0] < pair[0].0[1]);
            pairs.map(|pair| ([pair[1].0[0], pair[0].0[1].min(pair[1].0[1])], [pair[0].1, pair[1].1])).next()
        };
        if let Some((rect, (samples, [a, b]))) = grid.rectangles(twice).into_iter().next() {
            let (a, b) = (parts[a].path().display(), parts[b].path().display());
            let message = format!("{} are there twice: in `{a}` and in `{b}`", words(rect, &[samples]));
            return Err(Report::error(message).help("leave out one of the two"));
        }
        let joined = |ranges: &Vec<([u32; 2], usize)>| {
            let mut joined: Vec<[u32; 2]> = Vec::new();
            for &([first, end], _) in ranges {
                match joined.last_mut() {
                    Some(last) if last[1] == first => last[1] = end,
                    _ => joined.push([first, end]),
                }
            }
            joined
        };
        let there = there.iter().map(joined).collect();
        Ok(Self { parts, leading, crop, grid, there })
    }

    /// What is said of the picture by the part that wants the most samples.
    pub fn header(&self) -> &Header {
        self.parts[self.leading].header()
    }

    /// Fails with what is missing of the picture, if anything is.
    ///
    /// # Errors
    /// With pixels and samples, the first ones of many.
    pub fn check_complete(&self) -> Result<(), Report> {
        let spp = self.header().spp;
        let missing = |cell: usize| {
            let mut from = 0;
            let mut gaps = Vec::new();
            for &[first, end] in &self.there[cell] {
                if first > from {
                    gaps.push([from, first.min(spp)]);
                }
                from = end;
            }
            gaps.push([from, spp]);
            gaps.retain(|[first, end]| first < end);
            Some(gaps).filter(|gaps| !gaps.is_empty())
        };
        let missing = self.grid.rectangles(missing);
        let pieces: Vec<Piece> = missing.into_iter().map(|(rect, samples)| Piece { rect, samples }).collect();
        match incomplete(&pieces) {
            None => Ok(()),
            Some(report) => Err(report.help(
                "render what is missing with --rows, --samples and --part, or join what is there into a part: -o FILE.npz",
            )),
        }
    }

    /// What all samples took, without the worst pixel.
    fn counted(&self) -> Statistics {
        let mut all = Statistics::default();
        self.parts.iter().for_each(|part| all.merge(&part.header().statistics));
        all
    }

    /// Rows that are cut nowhere, from the top.
    fn bands(&self) -> Vec<Range<u32>> {
        let rows = self.grid.rows().windows(2).flat_map(|edges| {
            (edges[0]..edges[1]).step_by(ROWS as usize).map(move |first| first..edges[1].min(first + ROWS))
        });
        rows.collect()
    }

    /// The samples of some rows; `sums` and `lost` say whether those are read, or left black and 0.
    fn band(&mut self, rows: &Range<u32>, sums: bool, lost: bool) -> Result<PartialFilm, Report> {
        let Self { parts, crop, .. } = self;
        let band = Crop { y: rows.start, height: rows.end - rows.start, ..*crop };
        let meets = |rect: Crop| rect.y < rows.end && rect.y + rect.height > rows.start;
        let rects = parts.iter().flat_map(|part| part.header().pieces.iter().map(|piece| piece.rect));
        let grid = Grid::new(band, u32::MAX, rects.filter(|rect| meets(*rect)));
        let mut film = PartialFilm::new(parts[0].header().size, band, grid);
        for part in parts {
            for number in 0..part.header().pieces.len() {
                let piece = part.header().pieces[number].clone();
                if !meets(piece.rect) {
                    continue;
                }
                let rect = Crop { y: rows.start, height: band.height, ..piece.rect };
                let pixels = rect.width as usize * rect.height as usize;
                let piece = Piece { rect, samples: piece.samples };
                let sums =
                    if sums { part.sums(number, rows)? } else { vec![Rgb::black(); pixels * piece.blocks().len()] };
                let lost = if lost { part.lost(number, rows)? } else { vec![0; pixels] };
                // It has been seen to that nothing is there twice.
                film.insert(&piece, &sums, &lost).map_err(|twice| Report::error(twice.to_string()))?;
            }
        }
        Ok(film)
    }

    /// The whole picture, and what it took.
    ///
    /// # Errors
    /// When something is missing, or cannot be read, or there is no memory for the picture.
    pub fn film(&mut self) -> Result<(Film, Statistics), Report> {
        self.check_complete()?;
        let (spp, size, crop) = (self.header().spp, self.header().size, self.crop);
        let mut film = Film::new(size, crop).map_err(|e| Report::error(e.to_string()))?;
        let mut statistics = self.counted();
        let mut worst = Statistics::default();
        for rows in self.bands() {
            let band = self.band(&rows, true, true)?;
            band.put_into(&mut film, spp);
            worst.lost = worst.lost.or_worse(&band.statistics().lost);
        }
        statistics.lost = statistics.lost.with_worst(&worst.lost);
        Ok((film, statistics))
    }

    /// Writes all that is there as one part.
    ///
    /// # Errors
    /// When a part cannot be read any more, or writing fails.
    pub fn write(&mut self, out: &mut dyn Out) -> io::Result<()> {
        let failed = |report: Report| io::Error::other(report.to_string());
        let bands = self.bands();
        let mut header = Header { snell_part: VERSION, pieces: self.pieces(&bands), ..self.header().clone() };
        let (mut sums, mut lost) = (Vec::new(), Vec::new());
        let mut writer = Writer::new(out, &header)?;
        for rows in &bands {
            let band = self.band(rows, true, false).map_err(failed)?;
            for piece in band.pieces() {
                for y in piece.rect.y..piece.rect.y + piece.rect.height {
                    sums.clear();
                    band.row(&piece, y, &mut sums);
                    writer.sums(&sums)?;
                }
            }
        }
        writer.begin_lost(&header)?;
        let mut worst = Statistics::default();
        for rows in &bands {
            let band = self.band(rows, false, true).map_err(failed)?;
            worst.lost = worst.lost.or_worse(&band.statistics().lost);
            for piece in band.pieces() {
                for y in piece.rect.y..piece.rect.y + piece.rect.height {
                    lost.clear();
                    band.lost_row(&piece, y, &mut lost);
                    writer.lost(&lost)?;
                }
            }
        }
        header.statistics = self.counted();
        header.statistics.lost = header.statistics.lost.with_worst(&worst.lost);
        writer.finish(&header)
    }

    /// What is there, band by band. Where a band is all of one piece, as that above it is, they are one.
    fn pieces(&self, bands: &[Range<u32>]) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        let mut alone = false;
        for rows in bands {
            let band = Crop { y: rows.start, height: rows.end - rows.start, ..self.crop };
            let row = self.grid.rows().partition_point(|&edge| edge <= rows.start) - 1;
            let columns = self.grid.cells().take_while(|cell| cell.y == self.crop.y).count();
            let cells: Vec<Crop> = self.grid.cells().skip(row * columns).take(columns).collect();
            let mut here: Vec<Piece> = Vec::new();
            for (cell, samples) in cells.iter().zip(&self.there[row * columns..]).filter(|(_, s)| !s.is_empty()) {
                match here.last_mut() {
                    Some(last) if last.samples == *samples && last.rect.x + last.rect.width == cell.x => {
                        last.rect.width += cell.width;
                    }
                    _ => {
                        let rect = Crop { x: cell.x, width: cell.width, ..band };
                        here.push(Piece { rect, samples: samples.clone() });
                    }
                }
            }
            let one = here.len() == 1;
            match (pieces.last_mut(), &here[..]) {
                (Some(last), [piece])
                    if alone
                        && last.samples == piece.samples
                        && (last.rect.x, last.rect.width) == (piece.rect.x, piece.rect.width)
                        && last.rect.y + last.rect.height == piece.rect.y =>
                {
                    last.rect.height += piece.rect.height;
                }
                _ => pieces.append(&mut here),
            }
            alone = one;
        }
        pieces
    }
}

/// Do two parts belong to one picture?
fn same_picture(a: &PartFile, b: &PartFile) -> Result<(), Report> {
    let (first, other) = (a.header(), b.header());
    let what = if first.size != other.size {
        let [a, b] = [first.size, other.size].map(|[width, height]| format!("{width} x {height}"));
        Some(format!("its size is {a} in one and {b} in the other"))
    } else if first.crop != other.crop {
        let words = |crop: Crop| format!("{} x {} pixels at {},{}", crop.width, crop.height, crop.x, crop.y);
        Some(format!("it is of {} in one and of {} in the other", words(first.crop), words(other.crop)))
    } else {
        // A sample is the same however many there are; but one alone is the point of the grid, which is none of many.
        let mut recipe = other.recipe.clone();
        if first.spp > 1 && other.spp > 1 {
            recipe.spp = first.recipe.spp;
        }
        first.recipe.difference(&recipe)
    };
    match what {
        None => Ok(()),
        Some(what) => {
            let (a, b) = (a.path().display(), b.path().display());
            Err(Report::error(format!("`{a}` and `{b}` are parts of different pictures: {what}")))
        }
    }
}

/// What is said of pixels and samples that are missing of a picture: the first ones of many. `None` if none are.
pub fn incomplete(missing: &[Piece]) -> Option<Report> {
    let mut lines: Vec<String> = missing.iter().take(NAMED).map(|piece| words(piece.rect, &piece.samples)).collect();
    if missing.len() > NAMED {
        lines.push(format!("and {} more", missing.len() - NAMED));
    }
    let message = format!("the picture is not complete; missing: {}", lines.join("; "));
    (!missing.is_empty()).then(|| Report::error(message))
}

/// Pixels and samples, for people.
pub fn words(rect: Crop, samples: &[[u32; 2]]) -> String {
    let Crop { x, y, width, height } = rect;
    let range =
        |first: u32, end: u32| if end == first + 1 { first.to_string() } else { format!("{first} to {}", end - 1) };
    let samples: Vec<String> = samples.iter().map(|&[first, end]| range(first, end)).collect();
    format!("rows {}, columns {}, samples {}", range(y, y + height), range(x, x + width), samples.join(" and "))
}
