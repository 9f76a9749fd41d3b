//! Large arrays of zeros.

#![allow(unsafe_code, reason = "one call of the system, which says why it is sound")]

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_as_many_zeros_as_asked_for_or_none() {
        for count in [0, 1, 1 << 20] {
            assert_eq!(zeros::<f64>(count).unwrap(), vec![0.0; count]);
        }
        assert!(zeros::<f64>(1 << 60).is_none());
    }
}
