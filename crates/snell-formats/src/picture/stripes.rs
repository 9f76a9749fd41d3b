//! Stripes of rows, or other parts of a picture, which are encoded on several threads and written in their order.

use snell::threads::{join, map, share};
use std::ops::Range;

/// Stripes that are in memory before they are written.
const BATCH: usize = 64;

/// Parts of a picture, cut into stripes whose size does not depend on the number of threads, so neither does the file.
pub(super) struct Stripes {
    left: Range<usize>,
    each: usize,
    threads: usize,
}

impl Stripes {
    /// Stripes of `each` parts out of `parts`; `threads` work on them, 0 for the default number.
    pub fn new(parts: usize, each: usize, threads: usize) -> Self {
        Self { left: 0..parts, each, threads }
    }

    /// Encodes the next stripes; none if there are none left.
    pub fn next<T: Send>(&mut self, encode: impl Fn(Range<usize>) -> T + Sync + Send) -> Vec<T> {
        self.next_and(encode, || ()).0
    }

    /// The same while something else is done.
    pub fn next_and<T: Send, M: Send>(
        &mut self,
        encode: impl Fn(Range<usize>) -> T + Sync + Send,
        meanwhile: impl FnOnce() -> M + Send,
    ) -> (Vec<T>, M) {
        let (first, end, each) = (self.left.start, self.left.end, self.each);
        let batch = (end - first).div_ceil(each).min(BATCH);
        self.left.start = (first + batch * each).min(end);
        let stripe = |number: usize| {
            let start = first + number * each;
            encode(start..(start + each).min(end))
        };
        share(self.threads, |parallel| {
            if parallel {
                join(|| map(true, 0..batch, stripe), meanwhile)
            } else {
                (map(false, 0..batch, stripe), meanwhile())
            }
        })
    }
}
