//! A table of numbers by columns, written and read in whole lanes.

#![allow(unsafe_code, reason = "one check for all columns instead of one for each; each block says why it is sound")]

use super::{Lanes, MAX_WIDTH, Mask};

/// `N` columns of the same length. Behind the last row every column has room for a full group of lanes, so that the last
/// group is read like any other; what stands there are old values or zeros.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const N: usize> {
    /// All of length `room`.
    values: [Vec<f64>; N],
    room: usize,
    len: usize,
}

impl<const N: usize> Default for Columns<N> {
    fn default() -> Self {
        Self { values: [(); N].map(|()| vec![0.0; MAX_WIDTH]), room: MAX_WIDTH, len: 0 }
    }
}

impl<const N: usize> Columns<N> {
    /// How many rows.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Forgets all rows and keeps the memory.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// A column.
    #[inline(always)]
    pub fn column(&self, column: usize) -> &[f64] {
        &self.values[column][..self.len]
    }

    /// One number.
    #[inline(always)]
    pub fn at(&self, column: usize, row: usize) -> f64 {
        self.values[column][row]
    }

    /// One column, from a row on.
    #[inline(always)]
    pub fn lanes<L: Lanes>(&self, column: usize, start: usize) -> L {
        L::load(&self.values[column][start..])
    }

    /// Some neighbouring columns, from a row on.
    #[inline(always)]
    pub fn group<L: Lanes, const M: usize>(&self, first: usize, start: usize) -> [L; M] {
        assert!(start < self.room && start + L::WIDTH <= self.room, "no row {start}");
        let mut group = [L::splat(0.0); M];
        for (lanes, column) in group.iter_mut().zip(&self.values[first..first + M]) {
            // SAFETY: every column is of length `room`.
            *lanes = L::load(unsafe { column.get_unchecked(start..start + L::WIDTH) });
        }
        group
    }

    /// Replaces neighbouring columns from a row on, in all lanes, also those behind the last row.
    #[inline(always)]
    pub fn replace<L: Lanes, const M: usize>(&mut self, first: usize, start: usize, values: [L; M]) {
        assert!(start < self.room && start + L::WIDTH <= self.room, "no row {start}");
        for (value, column) in values.into_iter().zip(&mut self.values[first..first + M]) {
            // SAFETY: every column is of length `room`.
            value.store(unsafe { column.get_unchecked_mut(start..start + L::WIDTH) });
        }
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
        let room = needed.next_power_of_two();
        for column in &mut self.values {
            column.resize(room, 0.0);
        }
        // Only now: where there is not so much memory, `resize` does not come back.
        self.room = room;
    }

    /// Appends the lanes that the mask names, in lane order.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, mask: L::Mask, row: [L; N]) {
        self.reserve(L::WIDTH);
        let (start, count) = (self.len, mask.bits().count_ones() as usize);
        for (column, value) in self.values.iter_mut().zip(row) {
            // Mostly neighbours share their fate.
            let value = if count == L::WIDTH { value } else { value.compress(mask) };
            // SAFETY: every column is of length `room`, and `reserve` has left room for so many behind `len`.
            value.store(unsafe { column.get_unchecked_mut(start..start + L::WIDTH) });
        }
        self.len += count;
    }

    /// Appends some rows of another table.
    pub fn append(&mut self, other: &Self, rows: std::ops::Range<usize>) {
        self.reserve(rows.len());
        for (column, more) in self.values.iter_mut().zip(&other.values) {
            column[self.len..self.len + rows.len()].copy_from_slice(&more[rows.start..rows.end]);
        }
        self.len += rows.len();
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
        other.append(&table, 1..3);
        assert_eq!([other.len() as f64, other.at(0, 0), other.at(0, 1)], [2.0, 1.0, 3.0]);
    }
}
