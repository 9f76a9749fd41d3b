//! The area vector of a triangle: twice its area, along its normal.

use super::Vec3;
use crate::lanes::{Kernel, Lanes, Mask};

/// `(b − a) × (c − a)`, by the right-hand rule, good to a few units in the last place of its length for a triangle of any shape.
///
/// The plain formula errs by some `2⁻⁵³·|b − a|·|c − a|`, which is much beside the result where these two are nearly parallel: a
/// sliver would get a tilted plane. Below 30 degrees, and above 150, it is computed from differences and products without
/// error. Triangles stand in the tree with their largest angle first, so that only those with three corners nearly on a line
/// come to this.
#[inline(always)]
pub fn area_vector<L: Lanes>(corners: [Vec3<L>; 3]) -> Vec3<L> {
    let [a, b, c] = corners;
    let (p, q) = (b - a, c - a);
    let plain = p.cross(q);
    // sin² < 1/4
    let flat = (plain.dot(plain) * L::splat(4.0)).lt(p.dot(p) * q.dot(q));
    if flat.any() { Vec3::select(flat, L::call(WithoutCancellation(corners)), plain) } else { plain }
}

/// How far to turn the corners of a triangle, so that the one opposite its longest edge comes first.
pub fn largest_angle([a, b, c]: [Vec3; 3]) -> usize {
    let [opposite_a, opposite_b, opposite_c] = [c - b, a - c, b - a].map(|edge| edge.dot(edge));
    if opposite_a >= opposite_b && opposite_a >= opposite_c {
        0
    } else if opposite_b >= opposite_c {
        1
    } else {
        2
    }
}

/// A function of its own, as few triangles need it.
struct WithoutCancellation<L: Lanes>([Vec3<L>; 3]);

impl<K: Lanes> Kernel for WithoutCancellation<K> {
    type Output = Vec3<K>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec3<K> {
        let Self([a, b, c]) = self;
        let (p, q) = (difference(b, a), difference(c, a));
        Vec3::new(minor(p.y, p.z, q.y, q.z), minor(p.z, p.x, q.z, q.x), minor(p.x, p.y, q.x, q.y))
    }
}

/// A number as the sum of a rounded one and of its error.
type Pair<L> = (L, L);

#[inline(always)]
fn difference<L: Lanes>(v: Vec3<L>, w: Vec3<L>) -> Vec3<Pair<L>> {
    Vec3::new(two_diff(v.x, w.x), two_diff(v.y, w.y), two_diff(v.z, w.z))
}

/// `p·s − q·r`, with an error of some `2⁻¹⁰⁰` of the products.
#[inline(always)]
fn minor<L: Lanes>(p: Pair<L>, q: Pair<L>, r: Pair<L>, s: Pair<L>) -> L {
    let ((ps, ps_rest), (qr, qr_rest)) = (product(p, s), product(q, r));
    let (difference, rest) = two_diff(ps, qr);
    difference + (rest + (ps_rest - qr_rest))
}

#[inline(always)]
fn product<L: Lanes>((a, a_rest): Pair<L>, (b, b_rest): Pair<L>) -> Pair<L> {
    let (ab, rest) = two_product(a, b);
    (ab, rest + (a * b_rest + a_rest * b))
}

/// `a − b` and its error, both exact (Knuth, *The Art of Computer Programming* 2, 4.2.2, theorem B).
#[inline(always)]
fn two_diff<L: Lanes>(a: L, b: L) -> Pair<L> {
    let x = a - b;
    let b_virtual = a - x;
    let a_virtual = x + b_virtual;
    (x, (a - a_virtual) + (b_virtual - b))
}

/// `a·b` and its error (Dekker, *A Floating-Point Technique for Extending the Available Precision*, 1971), to `2⁻¹⁰⁶` of the
/// product: the heads have 26 bits and what is left 27, so that only the last product of four is rounded.
#[inline(always)]
fn two_product<L: Lanes>(a: L, b: L) -> Pair<L> {
    let (a_head, b_head) = (a.head(), b.head());
    let (a_tail, b_tail) = (a - a_head, b - b_head);
    let ab = a * b;
    (ab, ((a_head * b_head - ab) + a_head * b_tail + a_tail * b_head) + a_tail * b_tail)
}
