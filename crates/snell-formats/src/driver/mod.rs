//! The course's driver files, of every year.
//!
//! A driver is a list of lines, each a keyword and its values, in any order; `#` starts a comment. The years differ in
//! the meaning of some lines ([`Dialect`]), which is recognised from the lines themselves.

mod dialect;
mod scene;

pub use dialect::Dialect;
pub use scene::{Driver, Model, has_keywords, parse};

#[cfg(test)]
mod tests;
