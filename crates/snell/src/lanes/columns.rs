//! A table of numbers by columns, written and read in whole lanes.

use super::{Lanes, MAX_WIDTH, Mask};

/// `N` columns of the same length. Behind the last row every column has room for a full group of lanes, so that the last
/// group is read like any other; what stands there are old values or zeros.
#[derive(Clone, Debug)]
pub(crate) struct Columns<const N: usize> {
    columns: [Vec<f64>; N],
    len: usize,
}

impl<const N: usize> Default for Columns<N> {
    fn default() -> Self {
        Self { columns: [(); N].map(|()| vec![0.0; MAX_WIDTH]), len: 0 }
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

    /// A column, with some values of no meaning behind the last row.
    #[inline(always)]
    pub fn column(&self, column: usize) -> &[f64] {
        &self.columns[column]
    }

    /// One number.
    #[inline(always)]
    pub fn at(&self, column: usize, row: usize) -> f64 {
        self.columns[column][row]
    }

    /// One column, from a row on.
    #[inline(always)]
    pub fn lanes<L: Lanes>(&self, column: usize, start: usize) -> L {
        L::load(&self.columns[column][start..])
    }

    /// Some neighbouring columns, from a row on.
    #[inline(always)]
    pub fn group<L: Lanes, const M: usize>(&self, column: usize, start: usize) -> [L; M] {
        let mut group = [L::splat(0.0); M];
        for (i, lanes) in group.iter_mut().enumerate() {
            *lanes = self.lanes(column + i, start);
        }
        group
    }

    /// Replaces neighbouring columns from a row on, in all lanes, also those behind the last row.
    #[inline(always)]
    pub fn replace<L: Lanes, const M: usize>(&mut self, column: usize, start: usize, values: [L; M]) {
        for (i, value) in values.into_iter().enumerate() {
            value.store(&mut self.columns[column + i][start..]);
        }
    }

    /// Makes room for this many rows more.
    #[inline(always)]
    pub fn reserve(&mut self, rows: usize) {
        let needed = self.len + rows + MAX_WIDTH;
        if self.columns[0].len() < needed {
            self.grow(needed);
        }
    }

    #[cold]
    fn grow(&mut self, needed: usize) {
        for column in &mut self.columns {
            column.resize(needed.next_power_of_two(), 0.0);
        }
    }

    /// Appends the lanes that the mask names, in lane order.
    #[inline(always)]
    pub fn push<L: Lanes>(&mut self, mask: L::Mask, row: [L; N]) {
        self.reserve(L::WIDTH);
        for (column, value) in self.columns.iter_mut().zip(row) {
            value.compress(mask).store(&mut column[self.len..]);
        }
        self.len += mask.bits().count_ones() as usize;
    }

    /// Appends some rows of another table.
    pub fn append(&mut self, other: &Self, rows: std::ops::Range<usize>) {
        self.reserve(rows.len());
        for (column, more) in self.columns.iter_mut().zip(&other.columns) {
            column[self.len..self.len + rows.len()].copy_from_slice(&more[rows.clone()]);
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
