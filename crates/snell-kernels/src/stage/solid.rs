//! Solids: what encloses a medium, and which primitives are its surface.

use super::Stage;
use super::material::NONE;
use crate::color::Rgb;
use crate::geometry::{Bounds, Vec3};

/// "No solid", where the number of one is expected: a primitive that lets no light through.
pub const NO_SOLID: u32 = u32::MAX;

/// A closed surface with a medium inside.
#[derive(Clone, Debug)]
pub struct Solid {
    /// What it is made of.
    pub medium: Medium,
    /// Do its faces look inward?
    pub inward: bool,
    /// May it touch something else, so that a ray meets both in one place?
    pub touches: bool,
    /// For a medium between interfaces, which has no surface of its own: the number of its material.
    pub between_faces_of: Option<u32>,
    /// One of its primitives.
    pub primitive: u32,
    /// Its box.
    pub bounds: Bounds,
}

/// What fills a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Index of refraction, of all colours or of the d line.
    pub eta: f64,
    /// Where the indices of the bands stand in [`Stage::spectra`], if they differ.
    pub spectrum: Option<u32>,
    /// Absorption per scene unit.
    pub sigma_a: Rgb,
    /// Where solids overlap, the highest is there.
    pub priority: i32,
}

impl Stage {
    /// The index of a material for a band of light.
    pub fn eta_of(&self, material: u32, band: Option<u32>) -> f64 {
        let m = &self.materials[material as usize];
        match band {
            Some(band) if m.spectrum != NONE => self.spectra[m.spectrum as usize][band as usize],
            _ => m.eta,
        }
    }

    /// The solid whose surface a primitive is, or [`NO_SOLID`].
    #[inline(always)]
    pub fn interior_of(&self, primitive: usize) -> u32 {
        match self.surfaces.interior_of.get(primitive) {
            Some(&solid) => solid,
            None => self.solid_in_model(primitive),
        }
    }

    /// The solid in front of a primitive, if that is an interface between two; or [`NO_SOLID`].
    #[inline(always)]
    pub fn exterior_of(&self, primitive: usize) -> u32 {
        self.surfaces.exterior_of.get(primitive).copied().unwrap_or(NO_SOLID)
    }

    fn solid_in_model(&self, primitive: usize) -> u32 {
        let Some((placement, id)) = self.placement(primitive) else { return NO_SOLID };
        match self.models[placement.model].interior_of.get(id) {
            Some(&solid) if solid != NO_SOLID => placement.first_solid + solid,
            _ => NO_SOLID,
        }
    }

    /// Does a ray that crosses a primitive of this solid at `t` enter it?
    pub fn enters(&self, primitive: usize, solid: u32, origin: Vec3, dir: Vec3, t: f64) -> bool {
        let mirrored = self.placement(primitive).is_some_and(|(placement, _)| placement.to_world.mirrors());
        let enters = self.ask_of_ray(primitive, (origin, dir), |surface, origin, dir| surface.enters(origin, dir, t));
        enters != (self.solids[solid as usize].inward != mirrored)
    }
}
