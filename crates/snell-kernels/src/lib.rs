//! The kernels of Snell.
#![cfg_attr(not(test), no_std)]

extern crate alloc;

pub mod color;
pub mod geometry;
pub mod integrate;
pub mod lanes;
pub mod optics;
pub mod settings;
pub mod stage;
pub mod texture;
pub mod trace;
