//! Trees within a tree: a model that stands in many places and is held once.

use super::packet::{Packet, groups};
use super::{Bvh, MARGIN};
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::{Kernel, Lanes};

/// One place where a model stands.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// Which of the models.
    pub model: usize,
    /// From the space of the tree into the model's own.
    pub to_model: Affine,
    /// The id of its first triangle; the others follow in the model's order.
    pub first: u32,
    /// Its box in the space of the tree, with room for whatever a hit may be off.
    pub bounds: Bounds,
    /// How far from its plane a triangle may be hit, in the space of the tree: 32 times what the maps round.
    pub off: f64,
}

impl Instance {
    /// `bounds`: the box of its vertices. `reach`: how far away rays start. `farthest`: the largest coordinate of all. Fails
    /// for a placement that makes the model flat.
    ///
    /// Rays are taken into the space of the model, in which the test of a triangle is as exact as ever; but a hit there is
    /// off by the roundings of the map and of its inverse, `2⁻⁵³` of all coordinates, larger by the condition of the map
    /// `‖M‖·‖M⁻¹‖`. How far the map moves counts too: it may bring a model back that is far from its own origin. The box is
    /// larger by 32 times as much. Off its plane a hit is by less where a map stretches along axes, which the test of a
    /// triangle takes axis by axis.
    pub fn new(model: usize, to_world: &Affine, first: u32, bounds: Bounds, reach: f64, farthest: f64) -> Option<Self> {
        let to_model = to_world.inverse()?;
        let moved = to_world.apply(Vec3::<f64>::default()).length();
        let margin = MARGIN * to_world.norm() * to_model.norm() * (reach + farthest + moved);
        let room = Vec3::new(margin, margin, margin);
        let bounds = Bounds { min: bounds.min - room, max: bounds.max + room };
        let off = MARGIN * to_world.condition(&to_model) * (reach + farthest + moved);
        Some(Self { model, to_model, first, bounds, off })
    }
}

impl Bvh {
    /// Takes some rays into the space of an instance's model, lets its tree find their nearest hits, and says which of them
    /// have a nearer one than before. Distances are the same in both spaces, as directions keep what length they get.
    #[inline(always)]
    pub(super) fn visit<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, rays: u64, instance: &Instance) -> u64 {
        let mut inner = packet.inner.take().unwrap_or_default();
        let first = L::splat(f64::from(instance.first));
        inner.two_sided = packet.two_sided;
        for (start, _) in groups::<L>(rays) {
            let origin = instance.to_model.apply(Packet::vector::<L>(&packet.origin, start, [0, 1, 2]));
            let dir = instance.to_model.turn(Packet::vector::<L>(&packet.dir, start, [0, 1, 2]));
            let (t_min, t) = (L::load(&packet.t_min[start..]), L::load(&packet.t[start..]));
            inner.set(start, origin, dir, t_min, t, L::load(&packet.source[start..]) - first, true);
            // Ids of other instances, and "none" too, are then none of this one's, but still in their order.
            (L::load(&packet.primitive[start..]) - first).store(&mut inner.primitive[start..]);
        }
        let hit = self.models[instance.model].intersect::<L, ANY>(&mut inner, rays);
        for (start, nearer) in groups::<L>(hit) {
            let (t, primitive) = (L::load(&inner.t[start..]), L::load(&inner.primitive[start..]) + first);
            L::select(nearer, t, L::load(&packet.t[start..])).store(&mut packet.t[start..]);
            L::select(nearer, primitive, L::load(&packet.primitive[start..])).store(&mut packet.primitive[start..]);
        }
        packet.inner = Some(inner);
        hit
    }

    /// Visits all instances of a leaf, whose numbers these are.
    #[inline(always)]
    pub(super) fn visit_each<L: Lanes, const ANY: bool>(&self, packet: &mut Packet, rays: u64, numbers: &[f64]) -> u64 {
        L::call(VisitEach::<ANY> { tree: self, packet, rays, numbers })
    }
}

/// A function of its own: most leaves have no instances, and nothing of this should stand in their way.
struct VisitEach<'a, const ANY: bool> {
    tree: &'a Bvh,
    packet: &'a mut Packet,
    rays: u64,
    numbers: &'a [f64],
}

impl<const ANY: bool> Kernel for VisitEach<'_, ANY> {
    type Output = u64;
    #[inline(always)]
    fn run<L: Lanes>(self) -> u64 {
        let Self { tree, packet, rays, numbers } = self;
        let mut hit = 0;
        for &number in numbers {
            let open = if ANY { rays & !hit } else { rays };
            if open != 0 {
                hit |= tree.visit::<L, ANY>(packet, open, &tree.instances[number as usize]);
            }
        }
        hit
    }
}
