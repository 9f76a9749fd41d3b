//! Optics as pure functions, which are the kernels', and a catalogue of glasses.

pub mod glass;

pub use snell_kernels::optics::{absorption, dispersion, fresnel, phong, snell, spectrum, thin};
