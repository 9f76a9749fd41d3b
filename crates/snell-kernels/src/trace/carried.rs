//! What rays carry. Only their model of light knows what that is: here it is a few columns.

use crate::lanes::{Columns, Lanes, Record, Row};
use core::ops::Range;

/// No model carries more numbers than this.
const MOST: usize = 6;

/// What rays carry, a row for each.
#[derive(Clone, Debug, Default)]
pub struct Carried {
    columns: Columns<MOST>,
    /// How many of the columns are used.
    used: usize,
}

/// The same for all rays.
#[derive(Clone, Copy, Debug)]
pub struct CarriedByAll {
    columns: [f64; MOST],
    used: usize,
}

impl CarriedByAll {
    pub fn new<T: Record>(row: &Row<T, f64>) -> Self {
        const { assert!(T::COLUMNS <= MOST, "the model carries more numbers than `MOST`") };
        let mut columns = [0.0; MOST];
        T::to_columns(row, &mut columns[..T::COLUMNS]);
        Self { columns, used: T::COLUMNS }
    }

    /// In lanes.
    #[inline(always)]
    pub fn rows<L: Lanes, T: Record>(&self) -> Row<T, L> {
        T::from_columns(&self.columns.map(L::splat)[..T::COLUMNS])
    }
}

impl Carried {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.columns.clear();
    }

    /// Appends the lanes that the mask names, in lane order.
    #[inline(always)]
    pub fn push<L: Lanes, T: Record>(&mut self, mask: L::Mask, row: &Row<T, L>) {
        const { assert!(T::COLUMNS <= MOST, "the model carries more numbers than `MOST`") };
        let mut columns = [L::splat(0.0); MOST];
        T::to_columns(row, &mut columns[..T::COLUMNS]);
        self.used = T::COLUMNS;
        self.columns.push_first::<L>(
            T::COLUMNS,
            mask,
            #[inline(always)]
            |column| columns[column],
        );
    }

    /// Appends the lanes of other rows, from a row on, that the mask names.
    #[inline(always)]
    pub fn push_rows<L: Lanes>(&mut self, mask: L::Mask, others: &Self, start: usize) {
        self.used = others.used;
        self.columns.push_first::<L>(
            others.used,
            mask,
            #[inline(always)]
            |column| others.columns.lanes::<L>(column, start),
        );
    }

    /// Appends what all carry, for each lane that the mask names.
    #[inline(always)]
    pub fn push_same<L: Lanes>(&mut self, mask: L::Mask, all: &CarriedByAll) {
        self.used = all.used;
        self.columns.push_first::<L>(
            all.used,
            mask,
            #[inline(always)]
            |column| L::splat(all.columns[column]),
        );
    }

    /// The rows from one on, one in each lane.
    #[inline(always)]
    pub fn rows<L: Lanes, T: Record>(&self, start: usize) -> Row<T, L> {
        let columns = self.columns.group::<L, MOST>(0, start);
        T::from_columns(&columns[..T::COLUMNS])
    }

    /// Appends neighbouring rows of others.
    #[inline(always)]
    pub fn copy_rows(&mut self, other: &Self, rows: Range<usize>) {
        self.used = self.used.max(other.used);
        self.columns.copy_rows(&other.columns, rows);
    }
}
