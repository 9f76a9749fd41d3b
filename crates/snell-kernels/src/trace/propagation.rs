//! How rays go from where they start to what they meet, and how light gets from a lamp to a surface.

use super::hits::{Batch, Hits};
use super::leaving::Leaving;
use super::queue::Generation;
use super::statistics::Statistics;
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::Packet;
use crate::lanes::{Lanes, Row, Table};
use crate::stage::{Side, Stage};
use core::fmt::Debug;

/// How rays go from surface to surface. Models of light share it: [`FirstSurface`](super::FirstSurface) for those of the lecture and
/// the course, [`Interfaces`](super::interfaces::Interfaces) for real optics.
pub trait Propagation: Debug + Sized + Sync + 'static {
    /// What rays have for it, besides a line and the primitive that they leave.
    type Travel: Table;
    /// What it knows of the hits, besides their places.
    type Face: Table;
    /// What a worker remembers.
    type State<'a>: Debug;

    /// No hit nearer than this counts, in scene units.
    const T_MIN: f64;
    /// Are surfaces met from both sides? Then it is known of each hit on which side it is, a ray may meet the place that it has just
    /// left, which has to be looked at (`Leaving`), and the sky is a hit like others.
    const TWO_SIDED: bool;

    /// What a worker remembers, at first.
    fn new(stage: &Stage) -> Self::State<'_>;

    /// A tile begins: what is remembered of others may be forgotten.
    fn start_tile(_state: &mut Self::State<'_>) {}

    /// The number of the medium in which the camera stands.
    fn medium_of_eye(state: &Self::State<'_>) -> u32;

    /// What rays of the camera have, in this medium.
    fn from_camera<L: Lanes>(medium: u32) -> Row<Self::Travel, L>;

    /// Finds what all rays meet.
    fn find_hits<L: Lanes>(
        state: &mut Self::State<'_>,
        stage: &Stage,
        rays: &impl Generation<Self>,
        hits: &mut Hits<Self>,
        packet: &mut Packet,
        statistics: &mut Statistics,
    );

    /// On which side of surfaces rays are, for the hits from a row on.
    fn side<L: Lanes>(faces: &Self::Face, start: usize) -> Side<L>;

    /// Where shadow rays in this direction start, and from where on they are clear of the surface.
    fn shadow_start<L: Lanes>(hits: &Batch<'_, L, Self>, wi: Vec3<L>) -> (Vec3<L>, L);

    /// What of the light from `distance` away reaches the start of a shadow ray, through what is transparent.
    fn light_along(state: &mut Self::State<'_>, ray: &Leaving, distance: f64, medium: u32) -> Rgb;

    /// In which medium rays were that met these hits: their numbers.
    fn medium_before<L: Lanes>(hits: &Batch<'_, L, Self>) -> L;

    /// The index of refraction where a ray travels, the solid whose medium it is, and the ray's band of light; `None` for the space
    /// between the objects, and for all bands.
    fn medium_of_ray(
        state: &Self::State<'_>,
        stage: &Stage,
        travel: &Row<Self::Travel, f64>,
    ) -> (f64, Option<u32>, Option<u32>);

    /// The indices before and behind a hit, and whether it is on the outer side of its surface.
    fn sides_of_hit(state: &Self::State<'_>, hit: &Batch<'_, f64, Self>) -> ([f64; 2], bool);

    /// Does something that a shadow ray crosses at a distance really lie in its way? `tinted`: can light go through things?
    fn is_in_the_way(stage: &Stage, ray: &Leaving, crossing: (f64, u32), tinted: bool) -> bool;
}
