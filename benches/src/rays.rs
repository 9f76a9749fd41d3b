//! Ray sets of three kinds on the knot: from the eye, towards the light, and bounced at random.

use crate::scenes::KNOT_LIGHT;
use crate::{lanes, to_f32, uniform};
use snell::geometry::{TriangleMesh, Vec3, triangle};
use snell::rays::{HitBatch, RayBatch, any_hits, closest_hits};
use snell::world::{NO_PRIMITIVE, World};
use std::f64::consts::PI;

/// Hits are moved this far off the surface, because Embree does not know the primitive that a ray leaves.
const OFFSET: f64 = 1e-4;

/// Sets have multiples of this many rays, so that the widest packets are full.
const PACKET: usize = 16;

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From the eye through a pixel's middle.
    Primary,
    /// From a primary hit to the light: is anything between?
    Shadow,
    /// From a primary hit in a random direction about the normal, with the density of the cosine.
    Bounce,
}

impl Kind {
    /// All kinds, with their names.
    pub const ALL: [(&str, Self); 3] = [("primary", Self::Primary), ("shadow", Self::Shadow), ("bounce", Self::Bounce)];
}

/// The three sets of a mesh.
#[derive(Clone, Debug)]
pub struct RaySets {
    /// One for each pixel, in tiles of 32 x 32, in these blocks of 4 x 4, row by row.
    pub primary: RayBatch,
    /// One for each primary hit, in the same order, from 0 to 1 times the vector to the light.
    pub shadow: RayBatch,
    /// Several for each primary hit, as many as there are pixels or more: the first ones of all hits, the second ones,
    /// ….
    pub bounce: RayBatch,
}

impl RaySets {
    /// The rays of a picture of `size` pixels a side, a multiple of 32. `world` is compiled from the mesh alone.
    pub fn new(world: &World, mesh: &TriangleMesh, size: u32) -> Self {
        let eye = world.camera.eye;
        let primary = primary(world, size);
        let mut hits = HitBatch::default();
        closest_hits(world, &primary, 1, lanes(), &mut hits);
        let surfaces: Vec<(Vec3, Vec3)> = (0..hits.t.len())
            .filter(|&row| hits.primitive[row] != NO_PRIMITIVE)
            .map(|row| {
                let dir = Vec3::new(primary.dir[0][row], primary.dir[1][row], primary.dir[2][row]);
                let corners = mesh.corners(hits.primitive[row] as usize);
                let normal = triangle::normal(corners);
                let facing = if normal.dot(dir) > 0.0 { -normal } else { normal };
                (eye + dir * hits.t[row] + facing * OFFSET, facing)
            })
            .collect();
        Self { shadow: shadow(&surfaces), bounce: bounce(&surfaces, size), primary }
    }

    /// The set of a kind.
    pub fn of(&self, kind: Kind) -> &RayBatch {
        match kind {
            Kind::Primary => &self.primary,
            Kind::Shadow => &self.shadow,
            Kind::Bounce => &self.bounce,
        }
    }
}

/// What came of a set of rays.
#[derive(Clone, Debug, Default)]
pub struct Found {
    hits: HitBatch,
    blocked: Vec<bool>,
}

impl Found {
    /// Traces a set; the memory of the last time is used again.
    pub fn trace(&mut self, world: &World, sets: &RaySets, kind: Kind, threads: usize) {
        match kind {
            Kind::Shadow => any_hits(world, &sets.shadow, threads, lanes(), &mut self.blocked),
            Kind::Primary | Kind::Bounce => closest_hits(world, sets.of(kind), threads, lanes(), &mut self.hits),
        }
    }

    /// How many rays of the last set of this kind hit, and the mean distance of the hits; 0 for shadow rays.
    pub fn summary(&self, kind: Kind) -> (usize, f64) {
        if kind == Kind::Shadow {
            return (self.blocked.iter().filter(|&&b| b).count(), 0.0);
        }
        let hits = || self.hits.primitive.iter().zip(&self.hits.t).filter(|&(&p, _)| p != NO_PRIMITIVE);
        let (count, sum) = (hits().count(), hits().map(|(_, &t)| t).sum::<f64>());
        (count, sum / count.max(1) as f64)
    }
}

fn primary(world: &World, size: u32) -> RayBatch {
    let [right, up, back] = world.camera.axes;
    let [_, edge, _, _] = world.camera.bounds;
    // The camera's bounds lie half a pixel within the picture's edges; see `scenes::camera`.
    let edge = edge / (1.0 - 1.0 / f64::from(world.camera.size[0]));
    let mut rays = RayBatch::default();
    let inner = |length: u32, step: u32| (0..length).step_by(step as usize);
    for (ty, tx) in inner(size, 32).flat_map(|y| inner(size, 32).map(move |x| (y, x))) {
        for (by, bx) in inner(32, 4).flat_map(|y| inner(32, 4).map(move |x| (y, x))) {
            for (y, x) in inner(4, 1).flat_map(|y| inner(4, 1).map(move |x| (y, x))) {
                let middle = |v: u32| (f64::from(v) + 0.5) / f64::from(size) * 2.0;
                let (px, py) = ((middle(tx + bx + x) - 1.0) * edge, (1.0 - middle(ty + by + y)) * edge);
                push(&mut rays, world.camera.eye, (-back + right * px + up * py).unit(), f64::INFINITY);
            }
        }
    }
    full_packets(rays)
}

fn shadow(surfaces: &[(Vec3, Vec3)]) -> RayBatch {
    let mut rays = RayBatch::default();
    for &(point, _) in surfaces {
        push(&mut rays, point, Vec3::from(KNOT_LIGHT) - point, 1.0);
    }
    full_packets(rays)
}

fn bounce(surfaces: &[(Vec3, Vec3)], size: u32) -> RayBatch {
    let mut rays = RayBatch::default();
    let each = ((size * size) as usize).div_ceil(surfaces.len().max(1));
    for number in 0..each * surfaces.len() {
        let (point, normal) = surfaces[number % surfaces.len()];
        push(&mut rays, point, cosine_direction(normal, number as u32), f64::INFINITY);
    }
    full_packets(rays)
}

/// A direction about a unit normal with the density `cos θ/π` (Malley's method), on the basis of Duff et al.,
/// *Building an Orthonormal Basis, Revisited*, JCGT 6 (2017).
fn cosine_direction(n: Vec3, number: u32) -> Vec3 {
    let (u, v) = (uniform(2 * number), uniform(2 * number + 1));
    let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    let first = Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    let second = Vec3::new(b, sign + n.y * n.y * a, -n.y);
    let (sin, cos) = libm::sincos(2.0 * PI * v);
    let r = u.sqrt();
    first * (r * cos) + second * (r * sin) + n * (1.0 - u).sqrt()
}

fn push(rays: &mut RayBatch, origin: Vec3, dir: Vec3, t_max: f64) {
    for axis in 0..3 {
        rays.origin[axis].push(to_f32(origin.component(axis)));
        rays.dir[axis].push(to_f32(dir.component(axis)));
    }
    rays.t_min.push(0.0);
    rays.t_max.push(t_max);
}

fn full_packets(mut rays: RayBatch) -> RayBatch {
    let count = rays.t_max.len() / PACKET * PACKET;
    let RayBatch { origin, dir, t_min, t_max } = &mut rays;
    for column in origin.iter_mut().chain(dir).chain([t_min, t_max]) {
        column.truncate(count);
    }
    rays
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{build, knot, scenes};
    use std::sync::Arc;

    #[test]
    fn directions_are_of_unit_length_and_follow_the_cosine() {
        let normal = Vec3::new(0.48, -0.6, -0.64);
        let cosines: Vec<f64> = (0..1 << 14).map(|i| cosine_direction(normal, i).dot(normal)).collect();
        let mean = cosines.iter().sum::<f64>() / cosines.len() as f64;
        // ∫ cos² θ/π = 2/3, standard deviation √(1/18); 16 384 samples leave 0.0018, of which four are allowed.
        assert!((mean - 2.0 / 3.0).abs() < 0.008, "{mean}");
        assert!(cosines.iter().all(|&c| c > 0.0));
        assert!((cosine_direction(normal, 7).length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn sets_start_on_the_near_side_of_what_the_eye_sees() {
        let mesh = Arc::new(knot::square(12.0, -1.6));
        let (world, _) = build(&scenes::knot_on_ground(Arc::clone(&mesh), 32), 1).unwrap();
        let sets = RaySets::new(&world, &mesh, 32);
        assert_eq!(sets.primary.t_max.len(), 1024);
        let hits = sets.shadow.t_max.len();
        assert!(hits > 200 && hits < 1024 && sets.bounce.t_max.len() >= 1008, "some see the ground, some the sky");
        // f32 keeps 7 digits of the height.
        assert!(sets.shadow.origin[2].iter().all(|z| (z - (-1.6 + OFFSET)).abs() < 1e-6));
        let mut found = Found::default();
        for kind in [Kind::Shadow, Kind::Bounce] {
            found.trace(&world, &sets, kind, 2);
            assert_eq!(found.summary(kind).0, 0, "nothing stands above a plane");
        }
        found.trace(&world, &sets, Kind::Primary, 2);
        let (primary, mean) = found.summary(Kind::Primary);
        assert!(primary >= hits && mean > 6.1, "the eye is 6.1 above the ground: {mean}");
    }
}
