//! Who looks on while rays are traced: nobody for plain rendering, the recorder for explanations.

use super::hits::Hits;
use super::integrator::Integrator;
use super::propagation::Propagation;
use super::queue::{Generation, RayQueue};
use super::shading::ShadowRays;
use super::tree::Cutoff;
use crate::color::Rgb;
use crate::settings::Shadows;
use crate::stage::{LightSource, Stage};

/// What the propagation of a model of light remembers.
pub type StateOf<'a, I> = <<I as Integrator>::Propagation as Propagation>::State<'a>;

/// Sees every generation: first what light does at its hits, then its rays, hits and contributions, then what is not followed.
pub trait Observer {
    /// The local colours are those of the ambient light.
    fn ambient<P: Propagation>(&mut self, hits: &Hits<P>, stage: &Stage);
    /// What one light adds to them. Only hits that have a bit in `asks` ask for it.
    fn light<P: Propagation>(
        &mut self,
        stage: &Stage,
        shadows: Shadows,
        light: &LightSource,
        hits: &Hits<P>,
        asks: &[u64],
        shadow: &ShadowRays,
    );
    fn generation<I: Integrator>(
        &mut self,
        stage: &Stage,
        rays: &impl Generation<I::Propagation>,
        hits: &Hits<I::Propagation>,
        state: &StateOf<'_, I>,
    );
    /// A child of the last generation is not followed.
    fn cut_off<I: Integrator>(
        &mut self,
        stage: &Stage,
        children: &RayQueue<I::Propagation>,
        row: usize,
        why: Cutoff,
        state: &StateOf<'_, I>,
    );
    /// A sample of each pixel is done; what each of them lost.
    fn sample(&mut self, lost: &[Rgb]);
}

/// Looks at nothing: plain rendering.
impl Observer for () {
    #[inline(always)]
    fn ambient<P: Propagation>(&mut self, _: &Hits<P>, _: &Stage) {}
    #[inline(always)]
    fn light<P: Propagation>(
        &mut self,
        _: &Stage,
        _: Shadows,
        _: &LightSource,
        _: &Hits<P>,
        _: &[u64],
        _: &ShadowRays,
    ) {
    }
    #[inline(always)]
    fn generation<I: Integrator>(
        &mut self,
        _: &Stage,
        _: &impl Generation<I::Propagation>,
        _: &Hits<I::Propagation>,
        _: &StateOf<'_, I>,
    ) {
    }
    #[inline(always)]
    fn cut_off<I: Integrator>(
        &mut self,
        _: &Stage,
        _: &RayQueue<I::Propagation>,
        _: usize,
        _: Cutoff,
        _: &StateOf<'_, I>,
    ) {
    }
    #[inline(always)]
    fn sample(&mut self, _: &[Rgb]) {}
}
