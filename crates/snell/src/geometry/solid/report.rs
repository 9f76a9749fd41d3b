//! What [`check`](super::check) finds, as plain data.

use crate::geometry::{Bounds, Vec3};

/// So many findings of a kind are located; the others are counted.
pub const LOCATED: usize = 10;

/// In [`Report::component_of`]: the face belongs to no component, because it has two corners in one place or is broken.
pub const NO_COMPONENT: u32 = u32::MAX;

/// Findings of one kind: how many, and where the first ones are.
#[derive(Clone, Debug, PartialEq)]
pub struct Found<T> {
    /// How many there are.
    pub count: usize,
    /// The first [`LOCATED`] of them.
    pub first: Vec<T>,
}

impl<T> Default for Found<T> {
    fn default() -> Self {
        Self { count: 0, first: Vec::new() }
    }
}

impl<T> Found<T> {
    pub(super) fn add(&mut self, place: impl FnOnce() -> T) {
        self.count += 1;
        if self.first.len() < LOCATED {
            self.first.push(place());
        }
    }

    /// Was nothing found?
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// A face that is odd.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacePlace {
    /// Its number in the mesh, from 0.
    pub face: u32,
    /// Its middle, in scene units; not finite where the face has no place.
    pub at: Vec3,
}

/// An edge that is odd.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePlace {
    /// Its two ends, in scene units.
    pub ends: [Vec3; 2],
    /// One of its faces, from 0.
    pub face: u32,
    /// How many faces it has.
    pub faces: usize,
}

/// Two faces that meet in more than a vertex or an edge that they share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Their numbers in the mesh, from 0.
    pub faces: [u32; 2],
    /// The middle of what their boxes share, in scene units: near where they meet.
    pub at: Vec3,
}

/// Which way the faces of a component look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// Away from what they enclose: the signed volume is positive.
    Outward,
    /// Into it: inside out, or the wall of a cavity.
    Inward,
    /// The signed volume is 0 to within rounding, or the component does not enclose anything.
    None,
}

/// Faces that hang together over edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Number of faces.
    pub faces: usize,
    /// Number of places where it has vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Edges with an odd number of its faces: where it is open. A boundary edge has one.
    pub open_edges: usize,
    /// Closed edges that its faces do not pass equally often in both directions.
    pub misoriented_edges: usize,
    /// Can its faces be turned so that neighbours agree? A Möbius strip cannot.
    pub orientable: bool,
    /// Signed volume in cubic scene units. It means something where the component is a solid.
    pub volume: f64,
    /// Which way its faces look; [`Orientation::None`] where it is not a solid: open, at odds with itself, or flat.
    pub orientation: Orientation,
    /// It looks inward and lies in a solid: a cavity, as it should be.
    pub cavity: bool,
    /// It encloses less than nothing: it looks inward without being a cavity, or it lies in something that does.
    pub inside_out: bool,
    /// Its box.
    pub bounds: Bounds,
}

impl Component {
    /// Is every edge closed?
    pub fn is_closed(&self) -> bool {
        self.open_edges == 0
    }

    /// Do neighbouring faces look the same way?
    pub fn is_oriented(&self) -> bool {
        self.misoriented_edges == 0 && self.orientable
    }

    /// Closed, consistently oriented, and with a volume: light that enters it leaves it.
    pub fn is_solid(&self) -> bool {
        self.is_closed() && self.is_oriented() && self.orientation != Orientation::None
    }

    /// V − E + F: 2 for a ball, 0 for a torus.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }
}

/// What can be said in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Closed, consistently oriented, with a volume, outward.
    Solid,
    /// Closed and consistently oriented, but a component is inside out.
    InsideOut,
    /// Closed and consistently oriented, but a component has no volume: a sheet with two sides.
    Flat,
    /// Closed, but neighbouring faces do not look the same way.
    Misoriented,
    /// Not closed, or with a face that has no place.
    Open,
    /// No faces, or none with three different corners.
    Empty,
}

/// Everything that [`check`](super::check) says of a mesh. Vertices at equal positions count as one.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Number of faces that belong to components.
    pub faces: usize,
    /// Number of places where they have vertices.
    pub vertices: usize,
    /// Number of their edges.
    pub edges: usize,
    /// Faces that name a vertex that is not there, or one that is not finite.
    pub broken: Found<FacePlace>,
    /// Faces without area: two corners in one place, or three on a line (exactly).
    pub degenerate: Found<FacePlace>,
    /// Faces with the same three positions as one before them, in any order.
    pub duplicate: Found<FacePlace>,
    /// Edges with one face.
    pub boundary: Found<EdgePlace>,
    /// Edges with more than two faces.
    pub non_manifold: Found<EdgePlace>,
    /// Closed edges that faces of one component do not pass equally often in both directions.
    pub misoriented: Found<EdgePlace>,
    /// Faces that would have to be turned to agree with the others of their component, where that is possible.
    pub against: Found<FacePlace>,
    /// Pairs of faces that cross or touch each other in more than a vertex or an edge that they share. Decided exactly.
    pub crossing: Found<Crossing>,
    /// Were all pairs of faces looked at? If not, [`crossing`](Self::crossing) may miss some, and
    /// components may be called inside out that are cavities.
    pub complete: bool,
    /// The components, in the order of their first faces.
    pub components: Vec<Component>,
    /// For each face of the mesh the number of its component, or [`NO_COMPONENT`].
    pub component_of: Vec<u32>,
}

impl Report {
    /// Closed, consistently oriented and with a volume, every component: what may refract. See [`verdict`](Self::verdict) for those that
    /// are inside out.
    pub fn is_solid(&self) -> bool {
        self.broken.is_empty() && !self.components.is_empty() && self.components.iter().all(Component::is_solid)
    }

    /// The answer in one word.
    pub fn verdict(&self) -> Verdict {
        let all = |good: fn(&Component) -> bool| self.components.iter().all(good);
        match () {
            () if self.components.is_empty() => Verdict::Empty,
            () if !self.broken.is_empty() || !all(Component::is_closed) => Verdict::Open,
            () if !all(Component::is_oriented) => Verdict::Misoriented,
            () if !all(Component::is_solid) => Verdict::Flat,
            () if !all(|c| !c.inside_out) => Verdict::InsideOut,
            () => Verdict::Solid,
        }
    }

    /// V − E + F of the whole mesh.
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }

    /// Signed volume of all components, in cubic scene units; means something where all are solids.
    pub fn volume(&self) -> f64 {
        self.components.iter().map(|c| c.volume).sum()
    }
}
