//! What rays can hit: a file for each shape, and one list of them all.
//!
//! ```text
//!  shape/sphere.rs, triangle.rs, …     each one [`Shape`]: its numbers, its box, where rays meet it, what is there
//!        │  one line for each in `shapes!`
//!        ├──▶ Shapes       what a tree is built over: a list for each kind, numbered one after the other
//!        ├──▶ of_kind      the leaves of the tree: runs of one kind, tested by one loop
//!        └──▶ AnyShape     one shape, whatever its kind, for questions about a single hit
//! ```
//!
//! To add a shape, write its file and add its line to the list: no tree, traversal or tracer knows which shapes there are.

mod cuboid;
mod disc;
mod flat;
mod rectangle;
pub mod sphere;
pub mod triangle;

pub use cuboid::Cuboid;
pub use disc::Disc;
pub use rectangle::Rectangle;
pub use sphere::Sphere;
pub use triangle::{Triangle, Triangles};

use super::bvh::Instance;
use super::ray::{Heading, Ray, axes, main_axis};
use super::{Bounds, Vec3};
use crate::lanes::{Lanes, Mask};
use core::fmt::Debug;
use core::ops::Deref;

/// A kind of shape, as the tree sees it: numbers in the columns of a leaf, and the test of rays against them.
///
/// Tests are written once for all numbers of lanes. In the lanes stand either rays, and the same shape in each, or shapes,
/// and the same ray in each: by the same operations in the same order, so that the answer is the same to the bit.
pub trait Shape: Surface + Copy + Debug + 'static {
    /// So many numbers describe it in a leaf.
    const NUMBERS: usize;

    /// Does its test take vectors in the order of a ray's axes, with the shears ([`Heading`])?
    const SHEARED: bool;

    /// Is it what most scenes are made of, so that its test stands wherever leaves are tested? Leaves of others, and of several kinds,
    /// are tested by a function of their own, which must not stand in the way.
    const COMMON: bool;

    /// Its numbers, in the order of the columns.
    fn write(&self, put: impl FnMut(f64));

    /// The shape that has these numbers.
    fn read(number: impl Fn(usize) -> f64) -> Self;

    /// May a ray that leaves it hit it again? `two_sided` as in [`Query`].
    fn may_return(two_sided: bool) -> bool;

    /// Where rays meet it, and whether they do. Of several such places the first beyond `query.t_min`; what has only one need not
    /// look at that. Hits must lie in [`Surface::bounds`], to within the roundings for which the boxes of the tree have room.
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, query: &Query<L>) -> (L, L::Mask);

    /// Every place where the line of a ray crosses it, on both sides of its origin, in ascending order.
    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, found: impl FnMut(f64));
}

/// What is known of a single shape, whatever its kind.
pub trait Surface {
    /// A box that holds every hit.
    fn bounds(&self) -> Bounds;

    /// Is it all in one plane?
    fn is_flat(&self) -> bool {
        true
    }

    /// Does a ray come from the side to which its normal points, if it crosses it at `t`?
    fn enters(&self, origin: Vec3, dir: Vec3, t: f64) -> bool;

    /// Is a crossing at `t` of a ray that leaves the shape only its start? Not if it is a far side of what the ray goes through.
    /// Distances do not tell: at a grazing angle they are off by much.
    fn starts_at(&self, _origin: Vec3, _dir: Vec3, _t: f64) -> bool {
        true
    }

    /// Where a line meets it, on the side on which it was met at about `t`.
    fn meets_at(&self, origin: Vec3, dir: Vec3, t: f64) -> Option<f64>;

    /// Its unit normal at a point on it, outward.
    fn normal(&self, point: Vec3) -> Vec3;

    /// The same where a ray in this direction has met it, surely from within or from whichever side it came: of several faces near the
    /// point one that is crossed so. A way through it that is no longer than `tolerance`, as at an edge, is met from outside.
    fn normal_along(&self, point: Vec3, _dir: Vec3, _within: bool, _tolerance: f64) -> Vec3 {
        self.normal(point)
    }

    /// The normal where a ray crosses it at `t`, and how far the origin of the ray is in front of the plane across it there.
    fn height(&self, origin: Vec3, dir: Vec3, t: f64) -> (Vec3, f64);

    /// How far it rises above the plane through `origin` across `up`, which is of unit length.
    fn rises(&self, origin: Vec3, up: Vec3) -> f64;

    /// Does a ray that has just left another face really meet it, where the tests find it at `t`, perhaps behind the start? Only if
    /// it rises above the plane of that face; and where the start lies on it, only if the ray goes to its other side.
    fn is_met(&self, from: &Departure, t: f64) -> bool {
        if self.rises(from.origin, from.up) <= from.tolerance {
            return false;
        }
        let (normal, height) = self.height(from.origin, from.dir, t);
        // Four roundings: below that it is not known on which side the ray starts.
        if height.abs() > from.tolerance * 0.125 {
            return t > 0.0;
        }
        (normal.dot(from.dir) > 0.0) != (normal.dot(from.wo) > 0.0)
    }

    /// The same of a ray that has just left this shape itself.
    fn is_met_again(&self, from: &Departure, t: f64) -> bool {
        t > 0.0 && !self.starts_at(from.origin, from.dir, t)
    }

    /// Texture coordinates of a point on it.
    fn uv(&self, point: Vec3) -> [f64; 2];

    /// How far a point is from it.
    fn distance(&self, point: Vec3) -> f64;

    /// Triangles that look like it, or are it.
    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3]));
}

/// A ray that has just left a surface, while it is not yet clear of it.
#[derive(Clone, Copy, Debug)]
pub struct Departure {
    /// Where it starts.
    pub origin: Vec3,
    /// Of unit length.
    pub dir: Vec3,
    /// Towards where the light came from that it carries on or answers.
    pub wo: Vec3,
    /// The unit normal of the face that it leaves, on the side to which it goes.
    pub up: Vec3,
    /// What a hit may be off the plane of its face.
    pub tolerance: f64,
}

/// What a test needs to know of rays besides where they go.
#[derive(Clone, Copy, Debug)]
pub struct Query<L: Lanes> {
    /// Are spheres crossed from either side, or entered from outside only?
    pub two_sided: bool,
    /// Hits lie strictly beyond this distance.
    pub t_min: L,
    /// Which rays leave this shape. Of no meaning where none [may return](Shape::may_return).
    pub leaves: L::Mask,
}

/// The numbers of shapes in lanes.
pub trait Numbers<L: Lanes>: Copy {
    /// One of them.
    fn number(self, column: usize) -> L;

    /// Three of them.
    #[inline(always)]
    fn vector(self, [x, y, z]: [usize; 3]) -> Vec3<L> {
        Vec3::new(self.number(x), self.number(y), self.number(z))
    }
}

/// The same shape of a leaf in every lane.
#[derive(Clone, Copy, Debug)]
pub struct One<'a> {
    /// Those of the run.
    pub numbers: &'a [f64],
    /// How many shapes the run has.
    pub stride: usize,
    /// Which of them.
    pub place: usize,
}

impl<L: Lanes> Numbers<L> for One<'_> {
    #[inline(always)]
    fn number(self, column: usize) -> L {
        L::splat(self.numbers[column * self.stride + self.place])
    }
}

/// Neighbouring shapes of a leaf, one in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Neighbours<'a> {
    /// From the first one on.
    pub numbers: &'a [f64],
    /// How many shapes the run has.
    pub stride: usize,
}

impl<L: Lanes> Numbers<L> for Neighbours<'_> {
    #[inline(always)]
    fn number(self, column: usize) -> L {
        L::load(&self.numbers[column * self.stride..])
    }
}

/// Shapes in a row.
pub trait ShapeList<S>: Copy + Default {
    /// How many.
    fn count(self) -> usize;
    /// One of them.
    fn get(self, place: usize) -> S;
}

impl<S: Copy> ShapeList<S> for &[S] {
    fn count(self) -> usize {
        self.len()
    }

    fn get(self, place: usize) -> S {
        self[place]
    }
}

/// A shape's place in the list of kinds.
pub trait Kind: Shape {
    /// Its number.
    const KIND: usize;
    /// Those of this kind.
    fn list(shapes: &Shapes<'_>) -> impl ShapeList<Self>;
    /// As a shape of any kind.
    fn any(self) -> AnyShape;
}

/// Work that is done for shapes of one kind.
pub trait ForKind {
    /// What comes out.
    type Output: Default;
    /// Does the work.
    fn run<S: Kind>(self) -> Self::Output;
}

macro_rules! shapes {
    ($($Shape:ident, $list:ident: $List:ty, $what:literal;)+) => {
        enum Order { $($Shape,)+ Count }

        /// So many kinds there are.
        pub const KINDS: usize = Order::Count as usize;

        /// So many numbers describe a shape, by its kind.
        pub const NUMBERS: [usize; KINDS] = [$($Shape::NUMBERS),+];

        /// No shape has more.
        const MOST_NUMBERS: usize = {
            let mut most = 0;
            $(if $Shape::NUMBERS > most {
                most = $Shape::NUMBERS;
            })+
            most
        };

        /// What a tree is built over, numbered in this order: kind by kind, then the instances.
        #[derive(Clone, Copy, Debug, Default)]
        pub struct Shapes<'a> {
            $(#[doc = $what] pub $list: $List,)+
            /// Where other trees stand.
            pub instances: &'a [Instance],
        }

        $(impl Kind for $Shape {
            const KIND: usize = Order::$Shape as usize;

            fn list(shapes: &Shapes<'_>) -> impl ShapeList<Self> {
                shapes.$list
            }

            fn any(self) -> AnyShape {
                AnyShape::$Shape(self)
            }
        })+

        /// Does some work for the kind of this number; nothing for instances, which are of none.
        #[inline(always)]
        pub fn of_kind<W: ForKind>(kind: usize, work: W) -> W::Output {
            $(if kind == $Shape::KIND {
                return work.run::<$Shape>();
            })+
            W::Output::default()
        }

        /// The same for kinds that are common.
        #[inline(always)]
        pub fn of_common_kind<W: ForKind>(kind: usize, work: W) -> W::Output {
            $(if $Shape::COMMON && kind == $Shape::KIND {
                return work.run::<$Shape>();
            })+
            W::Output::default()
        }

        /// A bit for each kind that is common.
        pub const COMMON: u32 = $(($Shape::COMMON as u32) << $Shape::KIND)|+;

        /// A shape of any kind.
        #[derive(Clone, Copy, Debug)]
        pub enum AnyShape { $(#[doc = $what] $Shape($Shape),)+ }

        impl Deref for AnyShape {
            type Target = dyn Surface;

            fn deref(&self) -> &Self::Target {
                match self { $(Self::$Shape(shape) => shape,)+ }
            }
        }
    };
}

shapes! {
    Sphere, spheres: &'a [Sphere], "The spheres.";
    Triangle, triangles: Triangles<'a>, "The triangles.";
    Rectangle, rectangles: &'a [Rectangle], "The rectangles.";
    Cuboid, cuboids: &'a [Cuboid], "The boxes.";
    Disc, discs: &'a [Disc], "The discs.";
}

impl<L: Lanes> Query<L> {
    /// Of a line on both sides of its origin.
    #[inline(always)]
    pub fn everywhere() -> Self {
        Self { two_sided: true, t_min: L::splat(f64::NEG_INFINITY), leaves: L::Mask::from_bits(0) }
    }
}

/// Where a line meets a shape of which no ray is on both sides.
fn meet<S: Shape>(shape: &S, origin: Vec3, dir: Vec3) -> Option<f64> {
    let axes = if S::SHEARED { axes(main_axis(dir)) } else { [0, 1, 2] };
    let ray = Ray { origin: origin.permuted(axes), heading: Heading::new(dir.permuted(axes)), axes };
    // Not in memory of its own: this is asked for every ray that has left a mirror.
    let (mut numbers, mut written) = ([0.0; MOST_NUMBERS], 0);
    shape.write(|number| {
        numbers[written] = number;
        written += 1;
    });
    let (t, meets) = S::intersect(&ray, One { numbers: &numbers, stride: 1, place: 0 }, &Query::everywhere());
    meets.then_some(t)
}

impl Shapes<'_> {
    /// The number of the first shape of each kind, of the first instance, and of all.
    pub fn firsts(&self) -> [usize; KINDS + 2] {
        let mut firsts = [0; KINDS + 2];
        for kind in 0..KINDS {
            firsts[kind + 1] = firsts[kind] + of_kind(kind, Count(self));
        }
        firsts[KINDS + 1] = firsts[KINDS] + self.instances.len();
        firsts
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.firsts()[KINDS + 1]
    }

    /// The box of one of them.
    pub fn bounds(&self, number: usize) -> Bounds {
        self.bounds_from(&self.firsts(), number)
    }

    /// The same, where the [`firsts`](Self::firsts) are known.
    pub fn bounds_from(&self, firsts: &[usize; KINDS + 2], number: usize) -> Bounds {
        let kind = kind_of(firsts, number);
        let place = number - firsts[kind];
        of_kind(kind, BoundsOf(self, place)).unwrap_or_else(|| self.instances[place].bounds)
    }

    /// The box around them all, without the instances.
    pub fn extent(&self) -> Bounds {
        (0..KINDS).filter_map(|kind| of_kind(kind, Extent(self))).fold(Bounds::EMPTY, Bounds::union)
    }
}

struct Extent<'s, 'a>(&'s Shapes<'a>);

impl ForKind for Extent<'_, '_> {
    type Output = Option<Bounds>;
    fn run<S: Kind>(self) -> Option<Bounds> {
        let list = S::list(self.0);
        (0..list.count()).map(|place| list.get(place).bounds()).reduce(Bounds::union)
    }
}

/// The kind of a number, from those of the first of each; [`KINDS`] for instances.
pub fn kind_of(firsts: &[usize; KINDS + 2], number: usize) -> usize {
    firsts[1..=KINDS].partition_point(|&first| first <= number)
}

struct Count<'s, 'a>(&'s Shapes<'a>);

impl ForKind for Count<'_, '_> {
    type Output = usize;
    fn run<S: Kind>(self) -> usize {
        S::list(self.0).count()
    }
}

struct BoundsOf<'s, 'a>(&'s Shapes<'a>, usize);

impl ForKind for BoundsOf<'_, '_> {
    type Output = Option<Bounds>;
    fn run<S: Kind>(self) -> Option<Bounds> {
        Some(S::list(self.0).get(self.1).bounds())
    }
}
