//! What a model of light has to say.

use super::{Batch, Children, Propagation};
use crate::color::Rgb;
use crate::lanes::{Lanes, Record, Row};
use crate::settings::Settings;
use crate::stage::{CompiledMaterial, Stage};
use core::fmt::Debug;

/// A model of light.
pub trait Integrator: Copy + Debug + Sync + 'static {
    /// How its rays go from surface to surface.
    type Propagation: Propagation;
    /// What a ray carries.
    type Carried: Record;

    /// With these settings.
    fn new(settings: &Settings) -> Self;

    /// What the rays of the camera carry.
    fn from_camera<L: Lanes>() -> Row<Self::Carried, L>;

    /// What can be added to the pixel for each unit of radiance.
    fn throughput<L: Lanes>(carried: &Row<Self::Carried, L>) -> Rgb<L>;

    /// The same where rays arrive.
    #[inline(always)]
    fn arriving<L: Lanes>(hits: &Batch<'_, L, Self::Propagation>) -> Rgb<L> {
        Self::throughput(&hits.carried::<Self::Carried>())
    }

    /// Which hits show their own colour, and so have to ask for lights?
    #[inline(always)]
    fn asks_for_light<L: Lanes>(hits: &Batch<'_, L, Self::Propagation>) -> L::Mask {
        hits.active
    }

    /// What a batch of hits adds to its pixels; the rays that leave it go to `children`. One that carries nothing is not sent.
    fn scatter<L: Lanes>(
        self,
        hits: &Batch<'_, L, Self::Propagation>,
        state: &<Self::Propagation as Propagation>::State<'_>,
        children: &mut Children<Self::Propagation>,
    ) -> Rgb<L>;

    /// Does any branch end before the depth limit?
    fn ends_early(self) -> bool {
        false
    }

    /// Does this ray carry too little to be followed?
    fn carries_too_little(
        self,
        _world: &Stage,
        _carried: &Row<Self::Carried, f64>,
        _travel: &Row<<Self::Propagation as Propagation>::Travel, f64>,
    ) -> bool {
        false
    }

    /// What a surface of this material can make of what arrives, at most. `brightest` is the largest colour of any pattern.
    fn most(material: &CompiledMaterial, brightest: Rgb) -> Most;
}

/// The most that a hit can add, and that its children can carry, for each unit of throughput and without signs.
#[derive(Clone, Copy, Debug)]
pub struct Most {
    /// What its local colour is multiplied by.
    pub local: Rgb,
    /// All that leaves it together.
    pub children: Rgb,
}
