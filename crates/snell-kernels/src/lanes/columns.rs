//! A table of numbers by columns, written and read in whole lanes.

#![allow(unsafe_code, reason = "one check for all columns instead of one for each; each block says why it is sound")]

use super::{Lanes, MAX_WIDTH, Mask};
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

/// A cache line: columns begin at one.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
struct Line([f64; MAX_WIDTH]);

/// `N` columns of the same length. Behind the last row every column has room for a full group of lanes, so that the last
/// group is read like any other; what stands there are old values or zeros.
///
/// The columns stand one behind the other, an odd number of cache lines apart: columns that are a power of two apart would
/// compete for the same few places of the cache, and a row of many columns would never be in it.
#[derive(Clone, Debug)]
pub struct Columns<const N: usize> {
    /// `N·room` numbers.
    lines: Vec<Line>,
    /// Rows that a column has room for: an odd number of lines.
    room: usize,
    len: usize,
}

impl<const N: usize> Default for Columns<N> {
    fn default() -> Self {
        Self { lines: vec![Line::default(); N], room: MAX_WIDTH, len: 0 }
    }
}

impl<const N: usize> Columns<N> {
    /// How many rows.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Forgets all rows and keeps the memory.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    #[inline(always)]
    fn values(&self) -> &[f64] {
        bytemuck::must_cast_slice(&self.lines)
    }

    #[inline(always)]
    fn values_mut(&mut self) -> &mut [f64] {
        bytemuck::must_cast_slice_mut(&mut self.lines)
    }

    /// A column.
    #[inline(always)]
    pub fn column(&self, column: usize) -> &[f64] {
        &self.values()[column * self.room..][..self.len]
    }

    /// One number.
    #[inline(always)]
    pub fn at(&self, column: usize, row: usize) -> f64 {
        self.column(column)[row]
    }

    /// One column, from a row on.
    #[inline(always)]
    pub fn lanes<L: Lanes>(&self, column: usize, start: usize) -> L {
        let [lanes] = self.group(column, start);
        lanes
    }

    /// Some neighbouring columns, from a row on.
    #[inline(always)]
    pub fn group<L: Lanes, const M: usize>(&self, first: usize, start: usize) -> [L; M] {
        self.check::<L>(first + M, start);
        let (values, room) = (self.values(), self.room);
        let mut group = [L::splat(0.0); M];
        for (i, lanes) in group.iter_mut().enumerate() {
            let at = (first + i) * room + start;
            // SAFETY: there are `N` columns of `room` numbers, and this one is among them, with room for these rows.
            *lanes = L::load(unsafe { values.get_unchecked(at..at + L::WIDTH) });
        }
        group
    }

    /// Replaces neighbouring columns from a row on, in all lanes, also those behind the last row.
    #[inline(always)]
    pub fn replace<L: Lanes, const M: usize>(&mut self, first: usize, start: usize, values: [L; M]) {
        self.check::<L>(first + M, start);
        let room = self.room;
        for (i, value) in values.into_iter().enumerate() {
            let at = (first + i) * room + start;
            // SAFETY: there are `N` columns of `room` numbers, and this one is among them, with room for these rows.
            value.store(unsafe { self.values_mut().get_unchecked_mut(at..at + L::WIDTH) });
        }
    }

    /// The columns before `end` have a full group of lanes from this row on.
    #[inline(always)]
    fn check<L: Lanes>(&self, end: usize, start: usize) {
        assert!(end <= N && start < self.room && start + L::WIDTH <= self.room, "no row {start}");
    }

    /// Makes room for this many rows more.
    #[inline(always)]
    pub fn reserve(&mut self, rows: usize) {
        if self.room - self.len < rows + MAX_WIDTH {
            self.grow(self.len + rows + MAX_WIDTH);
        }
    }

    #[cold]
    fn grow(&mut self, needed: usize) {
        let room = needed.next_power_of_two().max(2 * MAX_WIDTH) + MAX_WIDTH;
        let mut larger = Self { lines: vec![Line::default(); N * (room / MAX_WIDTH)], room, len: 0 };
        larger.copy_rows(self, 0..self.len);
        *self = larger;
    }

    /// Appends the lanes that the mask names, in lane order.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, mask: L::Mask, row: [L; N]) {
        self.reserve(L::WIDTH);
        let (start, room, count) = (self.len, self.room, mask.bits().count_ones() as usize);
        let values = self.values_mut();
        for (column, value) in row.into_iter().enumerate() {
            // Mostly neighbours share their fate.
            let value = if count == L::WIDTH { value } else { value.compress(mask) };
            let at = column * room + start;
            // SAFETY: there are `N` columns of `room` numbers, and `reserve` has left room for so many behind `len`.
            value.store(unsafe { values.get_unchecked_mut(at..at + L::WIDTH) });
        }
        self.len += count;
    }

    /// Appends the lanes that the mask names, of the first `used` columns only, in lane order.
    #[inline(always)]
    pub(crate) fn push_first<L: Lanes>(&mut self, used: usize, mask: L::Mask, value: impl Fn(usize) -> L) {
        assert!(used <= N, "no column {used}");
        self.reserve(L::WIDTH);
        let (start, room, count) = (self.len, self.room, mask.bits().count_ones() as usize);
        for column in 0..used {
            let value = if count == L::WIDTH { value(column) } else { value(column).compress(mask) };
            let at = column * room + start;
            // SAFETY: there are `N` columns of `room` numbers, `used` is not more, and `reserve` has left room behind `len`.
            value.store(unsafe { self.values_mut().get_unchecked_mut(at..at + L::WIDTH) });
        }
        self.len += count;
    }

    /// Appends neighbouring rows of another table.
    #[inline(always)]
    pub(crate) fn copy_rows(&mut self, other: &Self, rows: Range<usize>) {
        assert!(rows.end <= other.len, "no row {}", rows.end);
        let count = rows.len();
        self.reserve(count);
        let (start, room) = (self.len, self.room);
        let (values, others) = (self.values_mut(), other.values());
        for column in 0..N {
            let (to, from) = (&mut values[column * room + start..], &others[column * other.room + rows.start..]);
            // In whole lines, which is no call; there is room for one behind the last row of both.
            for row in (0..count).step_by(MAX_WIDTH) {
                to[row..row + MAX_WIDTH].copy_from_slice(&from[row..row + MAX_WIDTH]);
            }
        }
        self.len += count;
    }

    /// Makes it this many rows, with any numbers in them.
    pub fn resize(&mut self, rows: usize) {
        self.reserve(rows.saturating_sub(self.len));
        self.len = rows;
    }

    /// All columns, to be written.
    pub fn columns_mut(&mut self) -> [&mut [f64]; N] {
        let (room, len) = (self.room, self.len);
        let mut rest = self.values_mut();
        [(); N].map(|()| {
            let (column, after) = core::mem::take(&mut rest).split_at_mut(room);
            rest = after;
            &mut column[..len]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::ArrayLanes;

    #[test]
    fn only_named_lanes_are_appended_and_in_order() {
        type Four = ArrayLanes<4>;
        let mut table = Columns::<2>::default();
        for round in 0..40 {
            let base = f64::from(4 * round);
            let row = [Four::from_fn(|i| base + i as f64), Four::from_fn(|i| -base - i as f64)];
            table.push(Mask::from_bits(0b1011), row);
        }
        assert_eq!(table.len(), 120);
        let expected = (0..160u32).filter(|i| i % 4 != 2).map(f64::from);
        for (row, value) in expected.enumerate() {
            assert_eq!((table.at(0, row), table.at(1, row)), (value, -value));
        }
        let last: [Four; 2] = table.group(0, 118);
        assert_eq!([last[0].lane(0), last[0].lane(1), last[1].lane(1)], [157.0, 159.0, -159.0]);
        let mut other = Columns::<2>::default();
        other.copy_rows(&table, 2..3);
        other.copy_rows(&table, 0..120);
        other.copy_rows(&table, 0..50);
        other.copy_rows(&table, 50..50);
        other.copy_rows(&table, 50..120);
        assert_eq!(other.len(), 241);
        for row in 0..241 {
            let from = if row == 0 { 2 } else { (row - 1) % 120 };
            assert_eq!([0, 1].map(|c| other.at(c, row)), [0, 1].map(|c| table.at(c, from)));
        }
        other.resize(3);
        let [first, second] = other.columns_mut();
        second.copy_from_slice(&[7.0, 8.0, 9.0]);
        assert_eq!((first.len(), other.at(1, 2), other.at(0, 2)), (3, 9.0, 1.0));
    }
}
