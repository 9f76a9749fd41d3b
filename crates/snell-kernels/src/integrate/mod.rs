//! Models of light: what a ray carries, what a surface adds, which rays leave it, and when a branch ends.
//!
//! Each model is one file and one implementation of [`Integrator`]. Queues, hits, recorder and world know none of them.

mod course;
mod first_hit;
mod lecture;
#[cfg(test)]
mod tests;
mod whitted;

use crate::color::Rgb;
use crate::settings;
use crate::trace::interfaces::Interfaces;
use crate::trace::{FirstSurface, Integrator};

/// Work that can be done with any model of light.
pub trait WithIntegrator {
    /// What comes out.
    type Output;
    /// Does the work.
    fn run<I: Integrator>(self) -> Self::Output;
}

/// The only place where a model of light is chosen.
pub fn with_integrator<W: WithIntegrator>(which: settings::Integrator, work: W) -> W::Output {
    match which {
        settings::Integrator::Lecture => work.run::<lecture::Lecture>(),
        settings::Integrator::Course2018 => work.run::<course::Course2018>(),
        settings::Integrator::Course2020 => work.run::<course::Course2020>(),
        settings::Integrator::Whitted => work.run::<whitted::Whitted>(),
    }
}

/// The same with a model that only looks where the rays of the camera go, in the way of this model of light.
pub fn with_first_hit<W: WithIntegrator>(which: settings::Integrator, work: W) -> W::Output {
    if which.has_media() {
        work.run::<first_hit::FirstHit<Interfaces>>()
    } else {
        work.run::<first_hit::FirstHit<FirstSurface>>()
    }
}

/// Without signs.
pub fn size(c: Rgb) -> Rgb {
    Rgb::new(c.r.abs(), c.g.abs(), c.b.abs())
}
