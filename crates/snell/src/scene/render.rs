//! How a picture is made.

use crate::film::transfer::{Encoding, Rounding, Transfer};
use crate::settings::{Integrator, Shadows};
use serde::{Deserialize, Serialize};

/// How the picture is made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Render {
    /// The model of light. Always written: there is no silent default.
    pub integrator: Integrator,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel: 1 looks through the point of the grid, more are spread over half a step around it.
    #[serde(default = "default_spp", skip_serializing_if = "is_default_spp")]
    pub spp: u32,
    /// Another number spreads the samples otherwise.
    #[serde(default, skip_serializing_if = "is_default_seed")]
    pub seed: u32,
    /// How many bounces may follow the camera ray.
    #[serde(default = "default_depth")]
    pub max_depth: u32,
    /// `whitted`: branches that carry less than this part of what they could, of white or of their band of light, are not
    /// followed, and counted as lost light.
    #[serde(default = "default_throughput", skip_serializing_if = "is_default_throughput")]
    pub min_throughput: f64,
    /// `whitted`: into how many wavelengths a ray splits at its first dispersive face; 1 for no colours.
    #[serde(default = "default_bands", skip_serializing_if = "is_default_bands")]
    pub bands: u32,
    /// What stands between a surface and a light; left out: `tinted` in `whitted`, `opaque` in the other models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadows: Option<Shadows>,
    /// The curve to 8 and 16 bit.
    #[serde(default)]
    pub transfer: Transfer,
    /// What happens to the fraction in 8 and 16 bit.
    #[serde(default)]
    pub rounding: Rounding,
}

impl Render {
    /// Everything but the model of light and the size of the picture as it is where a file leaves it out.
    pub fn new(integrator: Integrator, size: [u32; 2]) -> Self {
        Self {
            integrator,
            size,
            spp: 1,
            seed: 0,
            max_depth: default_depth(),
            min_throughput: MIN_THROUGHPUT,
            bands: BANDS,
            shadows: None,
            transfer: Transfer::default(),
            rounding: Rounding::default(),
        }
    }

    /// How colours become 8 or 16 bit.
    pub fn encoding(&self) -> Encoding {
        Encoding { transfer: self.transfer, rounding: self.rounding }
    }

    /// What stands between a surface and a light, also where that is left out.
    pub fn shadows(&self) -> Shadows {
        self.shadows.unwrap_or(match self.integrator {
            Integrator::Whitted => Shadows::Tinted,
            Integrator::Lecture | Integrator::Course2018 | Integrator::Course2020 => Shadows::Opaque,
        })
    }
}

/// The default of [`Render::min_throughput`].
pub const MIN_THROUGHPUT: f64 = 1.0 / 4096.0;

/// The default of [`Render::bands`].
pub const BANDS: u32 = 16;

fn default_spp() -> u32 {
    1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_default_spp(value: &u32) -> bool {
    *value == 1
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_default_seed(value: &u32) -> bool {
    *value == 0
}

fn default_bands() -> u32 {
    BANDS
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn is_default_bands(value: &u32) -> bool {
    *value == BANDS
}

fn default_depth() -> u32 {
    32
}

fn default_throughput() -> f64 {
    MIN_THROUGHPUT
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature of serde; what is small depends on the machine")]
fn is_default_throughput(value: &f64) -> bool {
    *value == MIN_THROUGHPUT
}
