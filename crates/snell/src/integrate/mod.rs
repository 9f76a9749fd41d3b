//! Models of light: what a ray carries, what a surface adds, which rays leave it, and when a branch ends.
//!
//! Each model is one file and one implementation of [`Integrator`]. Queues, hits, recorder and world know none of them.

mod course;
mod first_hit;
mod lecture;
#[cfg(test)]
mod tests;
mod whitted;

use crate::film::Rgb;
use crate::lanes::{Lanes, Record, Row};
use crate::scene;
use crate::trace::interfaces::Interfaces;
use crate::trace::{Batch, Children, FirstSurface, Propagation, Settings};
use crate::world::{CompiledMaterial, World};
use std::fmt::Debug;

/// A model of light.
pub(crate) trait Integrator: Copy + Debug + Sync + 'static {
    /// How its rays go from surface to surface.
    type Propagation: Propagation;
    /// What a ray carries.
    type Carried: Record;

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
        _world: &World,
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
pub(crate) struct Most {
    /// What its local colour is multiplied by.
    pub local: Rgb,
    /// All that leaves it together.
    pub children: Rgb,
}

/// Work that can be done with any model of light.
pub(crate) trait WithIntegrator {
    /// What comes out.
    type Output;
    /// Does the work.
    fn run<I: Integrator>(self) -> Self::Output;
}

/// The only place where a model of light is chosen.
pub(crate) fn with_integrator<W: WithIntegrator>(which: scene::Integrator, work: W) -> W::Output {
    match which {
        scene::Integrator::Lecture => work.run::<lecture::Lecture>(),
        scene::Integrator::Course2018 => work.run::<course::Course2018>(),
        scene::Integrator::Course2020 => work.run::<course::Course2020>(),
        scene::Integrator::Whitted => work.run::<whitted::Whitted>(),
    }
}

/// The same with a model that only looks where the rays of the camera go, in the way of this model of light.
pub(crate) fn with_first_hit<W: WithIntegrator>(which: scene::Integrator, work: W) -> W::Output {
    if which.has_media() {
        work.run::<first_hit::FirstHit<Interfaces>>()
    } else {
        work.run::<first_hit::FirstHit<FirstSurface>>()
    }
}

/// Without signs.
pub(crate) fn size(c: Rgb) -> Rgb {
    Rgb::new(c.r.abs(), c.g.abs(), c.b.abs())
}
