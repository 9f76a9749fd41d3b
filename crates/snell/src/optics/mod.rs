//! Optics as pure functions: no scene, no queue, one formula each.

pub mod phong;
pub mod snell;
