//! Optics as pure functions: no scene, no queue, one formula each.

pub mod absorption;
pub mod dispersion;
pub mod fresnel;
pub mod phong;
pub mod snell;
pub mod spectrum;
pub mod thin;
