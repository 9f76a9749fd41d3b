//! Materials: the lecture's coefficients, and what the physical model adds to them.

use super::one;
use crate::color::Rgb;
use crate::optics::absorption;
use crate::optics::dispersion::{Dispersion, Formula, VISIBLE_NM};
use crate::optics::glass::{self, UnknownGlass};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// What a surface does with light. What is left out is 0, but `ko` 1 (opaque), `spow` 16 and `eta` 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// Share of the ambient light.
    pub ka: Rgb,
    /// Diffuse reflectance.
    pub kd: Rgb,
    /// Colour of the highlight.
    pub ks: Rgb,
    /// Share that the mirror ray carries on.
    pub kr: Rgb,
    /// Opacity: the share `1 − ko` of the light goes through.
    pub ko: Rgb,
    /// Exponent of the highlight.
    pub spow: f64,
    /// Index of refraction.
    #[serde(default = "one")]
    pub eta: f64,
    /// Name of a glass of the catalogue, instead of `eta`: its index at the d line, and with `whitted` its colours.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub glass: Option<String>,
    /// `whitted`: the Abbe number of the glass whose index at the d line (587.56 nm) is `eta`; infinite for no dispersion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub abbe: Option<f64>,
    /// `whitted`: Cauchy's A, B and C instead of `eta`: the index at λ µm is A + B/λ² + C/λ⁴.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cauchy: Option<[f64; 3]>,
    /// `whitted`: Sellmeier's pairs B, C instead of `eta`: the index squared at λ µm is 1 + Σ Bλ²/(λ² − C), C in µm².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sellmeier: Option<Vec<[f64; 2]>>,
    /// Name of a texture, by which `ka` and `kd` are multiplied, and with `whitted` `ko` and `emission` by its alpha.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texture: Option<String>,
    /// `whitted`: each face is a whole pane of this thickness in scene units, with both of its sides, so that the
    /// mesh need not be closed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
    /// `whitted`: light that the surface sends out by itself.
    #[serde(skip_serializing_if = "is_default")]
    pub emission: Rgb,
    /// `whitted`: the colour of white light after `attenuation_distance` inside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attenuation_color: Option<Rgb>,
    /// `whitted`: at which thickness `attenuation_color` is seen, in scene units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub attenuation_distance: Option<f64>,
    /// `whitted`: absorption per scene unit, instead of a colour at a distance.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_a: Option<Rgb>,
    /// `whitted`: where solids overlap, the one of the highest priority is there; among equals the one entered last.
    #[serde(skip_serializing_if = "is_default")]
    pub priority: i32,
    /// `whitted`: transmitted light is multiplied by the diffuse colour `kd`. Older files call it `dyed`.
    #[serde(skip_serializing_if = "is_default", alias = "dyed")]
    pub tinted_transmission: bool,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Default for Material {
    fn default() -> Self {
        let none = Rgb::gray(0.0);
        Self {
            ka: none,
            kd: none,
            ks: none,
            kr: none,
            ko: Rgb::gray(1.0),
            spow: 16.0,
            eta: 1.0,
            glass: None,
            abbe: None,
            cauchy: None,
            sellmeier: None,
            texture: None,
            thickness: None,
            emission: none,
            attenuation_color: None,
            attenuation_distance: None,
            sigma_a: None,
            priority: 0,
            tinted_transmission: false,
        }
    }
}

impl Material {
    /// Does light go through it? `Σko < 3`, as in the lecture.
    pub fn is_transparent(&self) -> bool {
        self.ko.to_array().iter().sum::<f64>() < 3.0
    }

    /// How the index depends on the wavelength.
    ///
    /// # Errors
    /// An unknown glass, with the names that are most like it.
    pub fn dispersion(&self) -> Result<Dispersion, UnknownGlass> {
        let visible = |formula| Dispersion { formula, range_nm: VISIBLE_NM };
        Ok(match (&self.glass, &self.sellmeier, self.cauchy, self.abbe) {
            (Some(name), ..) => glass::find(name)?.dispersion.clone(),
            (None, Some(pairs), ..) => visible(Formula::SellmeierSquared(0.0, Cow::Owned(pairs.clone()))),
            (None, None, Some(cauchy), _) => visible(Formula::Cauchy(cauchy)),
            (None, None, None, Some(abbe)) if abbe.is_finite() => Dispersion::abbe(self.eta, abbe),
            (None, None, None, _) => Dispersion::constant(self.eta),
        })
    }

    /// Absorption per scene unit, from whichever of the two forms is given.
    pub fn absorption(&self) -> Rgb {
        match (self.sigma_a, self.attenuation_color, self.attenuation_distance) {
            (Some(sigma_a), ..) => sigma_a,
            (None, Some(color), Some(distance)) => absorption::sigma_a(color, distance),
            (None, ..) => Rgb::gray(0.0),
        }
    }
}
