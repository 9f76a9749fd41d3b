//! Large arrays of zeros.

#![allow(unsafe_code, reason = "two blocks, each of which says why it is sound")]

use crate::color::Rgb;
use bytemuck::Zeroable;

/// So many zeros, or `None` where there is not so much memory.
///
/// The system hands out zeroed memory when it is first touched, so this takes no time; and in pages of 2 megabytes
/// instead of 4 kilobytes where it can, of which there are far fewer to ask for.
pub(crate) fn zeros<T: Zeroable>(count: usize) -> Option<Vec<T>> {
    let values = bytemuck::allocation::try_zeroed_vec(count).ok()?;
    #[cfg(target_os = "linux")]
    ask_for_large_pages(&values);
    Some(values)
}

#[cfg(target_os = "linux")]
fn ask_for_large_pages<T>(values: &[T]) {
    const LARGE_PAGE: usize = 1 << 21;
    let range = values.as_ptr_range();
    let (start, end) = (range.start.addr().next_multiple_of(LARGE_PAGE), range.end.addr() & !(LARGE_PAGE - 1));
    if start < end {
        // SAFETY: the pages belong to `values`, and the advice does not change what is in them. Without large pages
        // everything works all the same, so the answer does not matter.
        unsafe {
            libc::madvise(range.start.with_addr(start).cast_mut().cast(), end - start, libc::MADV_HUGEPAGE);
        }
    }
}

/// The numbers of colours, three for each, where they are.
pub(crate) fn numbers(colors: &[Rgb]) -> &[f64] {
    const { assert!(size_of::<Rgb>() == 3 * size_of::<f64>() && align_of::<Rgb>() == align_of::<f64>()) };
    // SAFETY: an `Rgb` is three `f64` in a row (`repr(C)`, and nothing between them), so `colors` is three times as many,
    // borrowed for as long. `bytemuck` cannot derive this for a generic type.
    unsafe { std::slice::from_raw_parts(colors.as_ptr().cast(), colors.len() * 3) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_numbers_in_a_row() {
        assert_eq!(numbers(&[Rgb::new(1.0, 2.0, 3.0), Rgb::gray(4.0)]), [1.0, 2.0, 3.0, 4.0, 4.0, 4.0]);
        assert!(numbers(&[]).is_empty());
    }

    #[test]
    fn there_are_as_many_zeros_as_asked_for_or_none() {
        for count in [0, 1, 1 << 20] {
            assert_eq!(zeros::<f64>(count).unwrap(), vec![0.0; count]);
        }
        assert!(zeros::<f64>(1 << 60).is_none());
    }
}
