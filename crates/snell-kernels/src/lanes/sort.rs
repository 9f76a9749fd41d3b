//! Sorting up to eight numbers, where there are no instructions for it.

/// As [`Lanes::sort_descending`](super::Lanes::sort_descending).
#[inline(always)]
pub(super) fn by_insertion(
    mut named: u32,
    numbers: &[f64; 8],
    tags: &[u64; 8],
    (sorted, sorted_tags): (&mut [f64; 8], &mut [u64; 8]),
) {
    let mut count = 0;
    while named != 0 {
        let place = named.trailing_zeros() as usize & 7;
        named &= named - 1;
        let number = numbers[place];
        let mut at = count;
        while at > 0 && sorted[at - 1] < number {
            (sorted[at & 7], sorted_tags[at & 7]) = (sorted[at - 1], sorted_tags[at - 1]);
            at -= 1;
        }
        (sorted[at & 7], sorted_tags[at & 7]) = (number, tags[place]);
        count += 1;
    }
}
