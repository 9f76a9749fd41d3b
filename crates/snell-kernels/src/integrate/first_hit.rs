//! No light at all: only what the rays of the camera meet.

use crate::color::Rgb;
use crate::lanes::{Lanes, Mask};
use crate::settings::Settings;
use crate::stage::CompiledMaterial;
use crate::trace::{Batch, Children, Integrator, Most, Propagation};
use core::marker::PhantomData;

/// No light at all; rays go from the camera to what they meet, in this way.
#[derive(Clone, Copy, Debug)]
pub struct FirstHit<P>(PhantomData<P>);

impl<P: Propagation + Copy> Integrator for FirstHit<P> {
    type Propagation = P;
    type Carried = ();

    fn new(_settings: &Settings) -> Self {
        Self(PhantomData)
    }

    #[inline(always)]
    fn from_camera<L: Lanes>() {}

    #[inline(always)]
    fn throughput<L: Lanes>(_carried: &()) -> Rgb<L> {
        Rgb::gray(1.0).splat()
    }

    #[inline(always)]
    fn asks_for_light<L: Lanes>(_hits: &Batch<'_, L, P>) -> L::Mask {
        L::Mask::from_bits(0)
    }

    #[inline(always)]
    fn scatter<L: Lanes>(self, _hits: &Batch<'_, L, P>, _state: &P::State<'_>, _children: &mut Children<P>) -> Rgb<L> {
        Rgb::black()
    }

    fn most(_material: &CompiledMaterial, _brightest: Rgb) -> Most {
        Most { local: Rgb::gray(0.0), children: Rgb::gray(0.0) }
    }
}
