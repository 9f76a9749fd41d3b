//! The kernels' shapes against exact arithmetic and brute force.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod area;
mod exact;
mod shapes;
mod soak;
