//! Where the pixels of a part of a picture are.

use snell::film::Crop;
use std::ops::Range;

/// The rows of a part, as ranges of pixels in what holds `whole` row by row; `None` where the part is empty or does not lie within
/// `whole`.
pub fn rows(part: Crop, whole: Crop) -> Option<impl Iterator<Item = Range<usize>>> {
    let along = |start: u32, length: u32, first: u32, have: u32| {
        let end = start.checked_add(length)?;
        (length > 0 && start >= first && end <= first + have).then(|| (start - first) as usize)
    };
    let left = along(part.x, part.width, whole.x, whole.width)?;
    let top = along(part.y, part.height, whole.y, whole.height)?;
    let starts = (top..top + part.height as usize).map(move |row| row * whole.width as usize + left);
    Some(starts.map(move |start| start..start + part.width as usize))
}
