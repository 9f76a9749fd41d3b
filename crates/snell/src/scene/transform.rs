//! Where shapes stand.

use crate::geometry::{Affine, Vec3};
use serde::{Deserialize, Serialize};

/// One step of a placement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Transform {
    /// Turns about an axis through the origin, right-handed.
    Rotate {
        /// Direction of the axis, of any length but 0.
        axis: [f64; 3],
        /// Angle in degrees.
        degrees: f64,
    },
    /// Scales along the three axes.
    Scale([f64; 3]),
    /// Moves.
    Move([f64; 3]),
}

impl Transform {
    /// The step as a map; `None` for a rotation about no axis by another angle than 0.
    pub fn map(&self) -> Option<Affine> {
        match *self {
            Self::Rotate { axis: [0.0, 0.0, 0.0], degrees: 0.0 } => Some(Affine::IDENTITY),
            Self::Rotate { axis, degrees } => Affine::rotation(axis.into(), degrees),
            Self::Scale(factors) => Some(Affine::scaling(factors.into())),
            Self::Move(offset) => Some(Affine::translation(Vec3::from(offset))),
        }
    }
}

/// Some steps, one after the other.
pub(crate) fn whole_map(steps: &[Transform]) -> Affine {
    steps.iter().filter_map(Transform::map).fold(Affine::IDENTITY, Affine::then)
}
