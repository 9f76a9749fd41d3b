//! Materials as the kernels see them: plain numbers.

use super::Medium;
use crate::color::Rgb;

/// "None", where the number of a spectrum or a pattern is expected.
pub const NONE: u32 = u32::MAX;

/// What a surface does with light; by the names of a scene's materials.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompiledMaterial {
    /// Share of the light from everywhere.
    pub ka: Rgb,
    /// Diffuse share.
    pub kd: Rgb,
    /// Share of the highlight.
    pub ks: Rgb,
    /// Share of what is mirrored.
    pub kr: Rgb,
    /// Opacity: 1 lets nothing through.
    pub ko: Rgb,
    /// Exponent of the highlight.
    pub spow: f64,
    /// Light that it sends out by itself.
    pub emission: Rgb,
    /// Index of refraction, of all colours or of the d line.
    pub eta: f64,
    /// Absorption per scene unit.
    pub sigma_a: Rgb,
    /// Thickness of a pane in scene units; negative for what is none.
    pub thickness: f64,
    /// Where solids overlap, the highest is there.
    pub priority: i32,
    /// 1 where `kd` tints what goes through, else 0.
    pub tints: f64,
    /// Which of the spectra its indices are; [`NONE`] where they do not depend on the band.
    pub spectrum: u32,
    /// Which of the patterns is on it; [`NONE`] for none.
    pub pattern: u32,
    /// Are there places on it where not all of it is there?
    pub has_holes: bool,
}

impl CompiledMaterial {
    /// Opaque, and neither reflects nor sends out any light.
    pub const BLACK: Self = {
        let black = Rgb::gray(0.0);
        Self {
            ka: black,
            kd: black,
            ks: black,
            kr: black,
            ko: Rgb::gray(1.0),
            spow: 1.0,
            emission: black,
            eta: 1.0,
            sigma_a: black,
            thickness: -1.0,
            priority: 0,
            tints: 0.0,
            spectrum: NONE,
            pattern: NONE,
            has_holes: false,
        }
    };

    /// Does light go through it? `Σko < 3`, as in the lecture.
    pub fn is_transparent(&self) -> bool {
        self.ko.to_array().iter().sum::<f64>() < 3.0
    }

    /// What fills a solid of it.
    pub fn medium(&self) -> Medium {
        let spectrum = (self.spectrum != NONE).then_some(self.spectrum);
        Medium { eta: self.eta, spectrum, sigma_a: self.sigma_a, priority: self.priority }
    }

    /// Is each of its faces a whole pane?
    pub fn is_pane(&self) -> bool {
        self.thickness >= 0.0
    }
}
