//! The lecture's way from surface to surface: the first one in front of a ray is hit, spheres from outside only, and anything at all
//! stands in the way of light.

use super::hits::{Batch, Hits};
use super::leaving::Leaving;
use super::media::OUTSIDE;
use super::propagation::Propagation;
use super::queue::Generation;
use super::statistics::Statistics;
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{Nearest, PACKET, Packet};
use crate::lanes::{Lanes, Mask};
use crate::stage::{Side, Stage};

/// The first surface is hit; there are no media.
#[derive(Clone, Copy, Debug)]
pub struct FirstSurface;

impl Propagation for FirstSurface {
    type Travel = ();
    type Face = ();
    type State<'a> = ();

    /// The lecture's own number.
    const T_MIN: f64 = 1e-5;
    const TWO_SIDED: bool = false;

    fn new(_world: &Stage) {}

    fn medium_of_eye(_state: &()) -> u32 {
        OUTSIDE
    }

    #[inline(always)]
    fn from_camera<L: Lanes>(_medium: u32) {}

    #[inline(always)]
    fn find_hits<L: Lanes>(
        _state: &mut (),
        stage: &Stage,
        rays: &impl Generation<Self>,
        hits: &mut Hits<Self>,
        packet: &mut Packet,
        _statistics: &mut Statistics,
    ) {
        hits.clear();
        if let Some(spheres) = stage.tree.few_spheres() {
            let seen = hits.seen_of(spheres, rays);
            let all = if seen.is_empty() { 0 } else { rays.len() };
            for start in (0..all).step_by(L::WIDTH) {
                let (origin, dir) = rays.lines::<L>(start);
                let active = L::Mask::first(rays.len() - start);
                let (t_min, t_max) = (L::splat(Self::T_MIN), L::splat(f64::INFINITY));
                let none = Nearest::none(active, t_min, t_max, rays.sources(start));
                let Nearest { hit, t, primitive, .. } = none.among(false, &seen, origin, dir);
                if hit.any() {
                    hits.push(hit, start, (origin, dir), t, primitive, rays);
                }
            }
            hits.give_back(seen);
        } else {
            for first in (0..rays.len()).step_by(PACKET) {
                let all = rays.fill::<L>(packet, first, stage.tree.needs_shears());
                let hit = stage.tree.intersect::<L, false>(packet, all);
                for start in (0..PACKET).step_by(L::WIDTH) {
                    let mask = L::Mask::from_bits((hit >> start) as u32);
                    if mask.any() {
                        let (t, primitive) = (L::load(&packet.t[start..]), L::load(&packet.primitive[start..]));
                        let (line, row) = (packet.lines(start), first + start);
                        hits.push(mask, row, line, t, primitive, rays);
                    }
                }
            }
        }
        hits.look_up_surfaces::<L>(stage);
    }

    #[inline(always)]
    fn side<L: Lanes>(_faces: &(), _start: usize) -> Side<L> {
        Side::outside()
    }

    #[inline(always)]
    fn shadow_start<L: Lanes>(hits: &Batch<'_, L, Self>, _wi: Vec3<L>) -> (Vec3<L>, L) {
        (hits.point(), L::splat(Self::T_MIN))
    }

    fn light_along(_state: &mut (), _ray: &Leaving, _distance: f64, _medium: u32) -> Rgb {
        Rgb::gray(0.0)
    }

    #[inline(always)]
    fn medium_before<L: Lanes>(_hits: &Batch<'_, L, Self>) -> L {
        L::splat(f64::from(OUTSIDE))
    }

    fn medium_of_ray(_state: &(), stage: &Stage, _travel: &()) -> (f64, Option<u32>, Option<u32>) {
        (stage.eta_outside, None, None)
    }

    fn sides_of_hit(_state: &(), hit: &Batch<'_, f64, Self>) -> ([f64; 2], bool) {
        // Spheres are the only solids that light goes through, in one step.
        let material = &hit.stage.materials[hit.material_number(0) as usize];
        let inside = if material.is_transparent() && hit.is_sphere() { material.eta } else { hit.stage.eta_outside };
        ([hit.stage.eta_outside, inside], true)
    }

    fn is_in_the_way(stage: &Stage, ray: &Leaving, (t, primitive): (f64, u32), _tinted: bool) -> bool {
        let sphere = stage.spheres.get(primitive as usize);
        let enters = sphere.is_none_or(|sphere| t < (sphere.center - ray.origin).dot(ray.dir));
        t > Self::T_MIN && f64::from(primitive) != ray.source && enters
    }
}
