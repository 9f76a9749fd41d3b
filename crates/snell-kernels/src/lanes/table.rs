//! Tables whose columns have names: a row is a struct in lanes, and its table keeps many of them in columns.

use super::Lanes;
use core::fmt::Debug;
use core::ops::Range;

/// Rows of the same kind, in columns. `()` is the table without any.
///
/// Whole numbers travel as `f64`, in which every `u32` is exact, so that all columns are of one kind.
pub trait Table: Record + Clone + Debug + Default {
    /// Forgets all rows and keeps the memory.
    fn clear(&mut self);
    /// Appends the lanes that the mask names, in lane order.
    fn push<L: Lanes>(&mut self, mask: L::Mask, row: &Self::Row<L>);
    /// The rows from one on, one in each lane; lanes behind the last row are of no meaning.
    fn rows<L: Lanes>(&self, start: usize) -> Self::Row<L>;
    /// Appends neighbouring rows of another table.
    fn copy_rows(&mut self, other: &Self, rows: Range<usize>);
}

/// A row of a record, in lanes.
pub type Row<T, L> = <T as Record>::Row<L>;

impl Table for () {
    #[inline(always)]
    fn clear(&mut self) {}
    #[inline(always)]
    fn push<L: Lanes>(&mut self, _mask: L::Mask, _row: &()) {}
    #[inline(always)]
    fn rows<L: Lanes>(&self, _start: usize) {}
    #[inline(always)]
    fn copy_rows(&mut self, _other: &Self, _rows: Range<usize>) {}
}

/// What a field of a row may be: some neighbouring columns.
pub trait Field<L: Lanes>: Copy {
    /// How many columns.
    const COLUMNS: usize;
    /// From its columns.
    fn from_columns(columns: &[L]) -> Self;
    /// Into its columns.
    fn to_columns(self, columns: &mut [L]);
}

impl<L: Lanes> Field<L> for L {
    const COLUMNS: usize = 1;
    #[inline(always)]
    fn from_columns(columns: &[L]) -> Self {
        columns[0]
    }
    #[inline(always)]
    fn to_columns(self, columns: &mut [L]) {
        columns[0] = self;
    }
}

/// A kind of row: a struct in lanes, and its columns.
pub trait Record {
    /// A row in each lane.
    type Row<L: Lanes>: Copy + Debug;
    /// How many columns.
    const COLUMNS: usize;
    /// A row from its columns.
    fn from_columns<L: Lanes>(columns: &[L]) -> Self::Row<L>;
    /// A row into its columns.
    fn to_columns<L: Lanes>(row: &Self::Row<L>, columns: &mut [L]);
}

impl Record for () {
    type Row<L: Lanes> = ();
    const COLUMNS: usize = 0;
    #[inline(always)]
    fn from_columns<L: Lanes>(_columns: &[L]) {}
    #[inline(always)]
    fn to_columns<L: Lanes>(_row: &(), _columns: &mut [L]) {}
}

/// Declares a row, whose fields are each a `Number`, `Vec3` or `Rgb` in lanes, and the type that stands for this kind.
macro_rules! record {
    (
        $(#[$row_doc:meta])*
        $row:ident,
        $(#[$record_doc:meta])*
        $record:ident { $($(#[$doc:meta])* $field:ident: $kind:ident,)+ }
    ) => {
        $(#[$record_doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $record;
        $crate::lanes::table::row!{ $(#[$row_doc])* $row, $record { $($(#[$doc])* $field: $kind,)+ } }
    };
}

/// Declares a row and its table. For each field there is a function that reads it alone.
macro_rules! table {
    (
        $(#[$row_doc:meta])*
        $row:ident,
        $(#[$table_doc:meta])*
        $table:ident { $($(#[$doc:meta])* $field:ident: $kind:ident,)+ }
    ) => {
        $(#[$table_doc])*
        #[derive(Clone, Debug, Default)]
        pub struct $table($crate::lanes::Columns<{ <$table as $crate::lanes::table::Record>::COLUMNS }>);
        $crate::lanes::table::row!{ $(#[$row_doc])* $row, $table { $($(#[$doc])* $field: $kind,)+ } }

        impl $table {
            $crate::lanes::table::fields!{ 0; $($field: $kind,)+ }

            /// How many rows.
            #[allow(dead_code, reason = "one table of several tells the length of all")]
            #[inline(always)]
            pub(crate) fn len(&self) -> usize {
                self.0.len()
            }

            /// Replaces a row.
            #[allow(dead_code, reason = "for the tables that are changed")]
            pub fn replace(&mut self, row: usize, value: &$row<f64>) {
                self.0.replace(0, row, $table::columns(value));
            }

            #[inline(always)]
            fn columns<L: $crate::lanes::Lanes>(
                row: &$row<L>,
            ) -> [L; <$table as $crate::lanes::table::Record>::COLUMNS] {
                let mut columns = [L::splat(0.0); <$table as $crate::lanes::table::Record>::COLUMNS];
                <$table as $crate::lanes::table::Record>::to_columns(row, &mut columns);
                columns
            }
        }

        impl $crate::lanes::Table for $table {
            #[inline(always)]
            fn clear(&mut self) {
                self.0.clear();
            }
            #[inline(always)]
            fn push<L: $crate::lanes::Lanes>(&mut self, mask: L::Mask, row: &$row<L>) {
                self.0.push(mask, $table::columns(row));
            }
            #[inline(always)]
            fn rows<L: $crate::lanes::Lanes>(&self, start: usize) -> $row<L> {
                let columns = self.0.group::<L, { <$table as $crate::lanes::table::Record>::COLUMNS }>(0, start);
                <$table as $crate::lanes::table::Record>::from_columns(&columns)
            }
            #[inline(always)]
            fn copy_rows(&mut self, other: &Self, rows: core::ops::Range<usize>) {
                self.0.copy_rows(&other.0, rows);
            }
        }
    };
}

/// The row of a record.
macro_rules! row {
    (
        $(#[$row_doc:meta])*
        $row:ident, $record:ident { $($(#[$doc:meta])* $field:ident: $kind:ident,)+ }
    ) => {
        $(#[$row_doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $row<L: $crate::lanes::Lanes> { $($(#[$doc])* pub $field: $kind<L>,)+ }

        impl $crate::lanes::table::Record for $record {
            type Row<L: $crate::lanes::Lanes> = $row<L>;
            const COLUMNS: usize = 0 $(+ <$kind<f64> as $crate::lanes::table::Field<f64>>::COLUMNS)+;
            #[inline(always)]
            fn from_columns<L: $crate::lanes::Lanes>(columns: &[L]) -> $row<L> {
                let mut at = 0;
                $(
                    let $field = <$kind<L> as $crate::lanes::table::Field<L>>::from_columns(&columns[at..]);
                    at += <$kind<L> as $crate::lanes::table::Field<L>>::COLUMNS;
                )+
                let _ = at;
                $row { $($field,)+ }
            }
            #[inline(always)]
            fn to_columns<L: $crate::lanes::Lanes>(row: &$row<L>, columns: &mut [L]) {
                let mut at = 0;
                $(
                    <$kind<L> as $crate::lanes::table::Field<L>>::to_columns(row.$field, &mut columns[at..]);
                    at += <$kind<L> as $crate::lanes::table::Field<L>>::COLUMNS;
                )+
                let _ = at;
            }
        }
    };
}

/// For each field the function that reads it; the first number counts the columns before it.
macro_rules! fields {
    ($at:expr;) => {};
    ($at:expr; $field:ident: $kind:ident, $($rest:tt)*) => {
        /// This field of the rows from one on.
        #[allow(dead_code, reason = "some fields are only read with their rows")]
        #[inline(always)]
        pub fn $field<L: $crate::lanes::Lanes>(&self, start: usize) -> $kind<L> {
            const WIDTH: usize = <$kind<f64> as $crate::lanes::table::Field<f64>>::COLUMNS;
            let columns = self.0.group::<L, WIDTH>($at, start);
            <$kind<L> as $crate::lanes::table::Field<L>>::from_columns(&columns)
        }
        $crate::lanes::table::fields!{ $at + <$kind<f64> as $crate::lanes::table::Field<f64>>::COLUMNS; $($rest)* }
    };
}

/// A field of one column.
pub type Number<L> = L;

pub(crate) use {fields, record, row, table};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;
    use crate::lanes::{ArrayLanes, Mask};

    table! {
        /// Something at a place.
        Thing,
        Things { number: Number, place: Vec3, other: Number, }
    }

    #[test]
    fn rows_come_back_by_names() {
        type Four = ArrayLanes<4>;
        let mut things = Things::default();
        for round in 0..9 {
            let number = Four::ramp(4 * round);
            let place = Vec3::new(number + Four::splat(0.1), number + Four::splat(0.2), number + Four::splat(0.3));
            things.push(Mask::from_bits(0b1101), &Thing { number, place, other: -number });
        }
        assert_eq!(things.len(), 27);
        for (row, n) in (0..36u32).filter(|n| n % 4 != 1).map(f64::from).enumerate() {
            let Thing { number, place, other } = things.rows::<f64>(row);
            assert_eq!((number, place, other), (n, Vec3::new(n + 0.1, n + 0.2, n + 0.3), -n));
            assert_eq!(
                (things.number::<f64>(row), things.place::<f64>(row), things.other::<f64>(row)),
                (n, place, other)
            );
        }
        things.replace(3, &Thing { number: 7.0, place: Vec3::new(8.0, 9.0, 10.0), other: 11.0 });
        let mut some = Things::default();
        some.copy_rows(&things, 3..4);
        some.copy_rows(&things, 0..things.len());
        assert_eq!((some.len(), some.place::<f64>(0), some.other::<f64>(4)), (28, Vec3::new(8.0, 9.0, 10.0), 11.0));
    }
}
