//! Who looks on while rays are traced: nobody for plain rendering, the recorder for explanations.

use super::hits::Hits;
use super::media::Media;
use super::queue::{Generation, RayQueue};
use super::shading::ShadowRays;
use super::tree::Ended;
use crate::film::Rgb;
use crate::world::{LightSource, World};

/// Sees every generation: first what light does at its hits, then its rays, hits and contributions, then what is not followed.
pub(crate) trait Observer {
    /// The local colours are those of the ambient light.
    fn ambient(&mut self, hits: &Hits, world: &World);
    /// What one light adds to them.
    fn light(&mut self, world: &World, light: &LightSource, hits: &Hits, shadow: &ShadowRays);
    fn generation(&mut self, rays: &impl Generation, hits: &Hits, media: &Media<'_>);
    /// A child of the last generation is not followed.
    fn ended(&mut self, children: &RayQueue, row: usize, why: Ended, media: &Media<'_>);
    /// A sample of each pixel is done; what each of them lost.
    fn sample(&mut self, lost: &[Rgb]);
}

/// Looks at nothing: plain rendering.
impl Observer for () {
    #[inline(always)]
    fn ambient(&mut self, _hits: &Hits, _world: &World) {}
    #[inline(always)]
    fn light(&mut self, _world: &World, _light: &LightSource, _hits: &Hits, _shadow: &ShadowRays) {}
    #[inline(always)]
    fn generation(&mut self, _rays: &impl Generation, _hits: &Hits, _media: &Media<'_>) {}
    #[inline(always)]
    fn ended(&mut self, _children: &RayQueue, _row: usize, _why: Ended, _media: &Media<'_>) {}
    #[inline(always)]
    fn sample(&mut self, _lost: &[Rgb]) {}
}
