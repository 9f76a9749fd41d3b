//! Mending a mesh: what can be mended without guessing what was meant.
//!
//! In this order: broken faces go; vertices in one place become one; faces with two corners in one place and copies of faces
//! go; faces are turned so that neighbours agree; small holes are filled; faces that are a line are mended; solids are
//! turned outward; vertices that no face uses go. What is already right is left as it is, so that repairing twice is
//! repairing once. Faces keep their materials and texture coordinates; those that fill holes have no texture coordinates.
//!
//! Each step is tried, and undone if it leaves the mesh worse than it was (`faults`).

mod faces;
mod faults;
mod holes;
mod lines;
#[cfg(test)]
mod tests;
mod weld;

use super::topology::{Kind, Topology};
use super::{NO_COMPONENT, Report, structure};
use crate::geometry::TriangleMesh;
use faults::Faults;

/// What to mend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Vertices on open edges become one where they are at most so far from each other, as a share of the diagonal of the
    /// mesh, from 0 (equal positions only) to 0.1. It closes cracks: what is closed keeps its details.
    pub weld: f64,
    /// Holes of at most so many edges are filled; 0: none. At most 1000.
    pub largest_hole: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { weld: 0.0, largest_hole: 100 }
    }
}

/// What was done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RepairLog {
    /// Vertices that became one with another.
    pub welded_vertices: usize,
    /// Faces that named a vertex that is not there or not finite: removed.
    pub broken_faces: usize,
    /// Faces without area: removed, or their neighbour divided so that they are not needed.
    pub degenerate_faces: usize,
    /// Copies of faces: removed.
    pub duplicate_faces: usize,
    /// Faces that were turned to agree with their neighbours.
    pub turned_faces: usize,
    /// Components that were inside out: turned.
    pub turned_components: usize,
    /// Holes that were filled.
    pub filled_holes: usize,
    /// Faces that fill them.
    pub new_faces: usize,
    /// Vertices that no face used: removed.
    pub unused_vertices: usize,
    /// Holes that were left open, because what would fill them meets other faces.
    pub obstructed_holes: usize,
    /// Steps that were undone, because they would have left the mesh worse.
    pub undone: Vec<Step>,
}

/// A part of the repair that can be undone by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Vertices near each other become one.
    Weld,
    /// Copies of faces go.
    Copies,
    /// Faces are turned so that neighbours agree.
    Turn,
    /// Holes are filled.
    Fill,
    /// Faces that are a line are mended.
    Lines,
    /// Components are turned outward.
    Outward,
}

impl RepairLog {
    fn add(&mut self, more: &Self) {
        self.welded_vertices += more.welded_vertices;
        self.broken_faces += more.broken_faces;
        self.degenerate_faces += more.degenerate_faces;
        self.duplicate_faces += more.duplicate_faces;
        self.turned_faces += more.turned_faces;
        self.turned_components += more.turned_components;
        self.filled_holes += more.filled_holes;
        self.new_faces += more.new_faces;
        self.unused_vertices += more.unused_vertices;
    }

    /// Is the mesh as it was?
    pub fn is_empty(&self) -> bool {
        let left = Self { obstructed_holes: self.obstructed_holes, undone: self.undone.clone(), ..Self::default() };
        *self == left
    }
}

/// What one round mends can bring to light what another mends, in meshes that are hardly surfaces. After so many it is
/// enough.
const ROUNDS: usize = 8;

/// Mends one kind of thing, and says what was done.
type Mend = fn(&mut TriangleMesh, &Options) -> RepairLog;

const STEPS: [(Step, Mend); 6] = [
    (Step::Weld, |mesh, options| RepairLog {
        welded_vertices: weld::near(mesh, options.weld.clamp(0.0, 0.1)),
        degenerate_faces: keep_kind(mesh, |kind| kind == Kind::Whole),
        ..RepairLog::default()
    }),
    (Step::Copies, |mesh, _| RepairLog { duplicate_faces: faces::remove_copies(mesh), ..RepairLog::default() }),
    (Step::Turn, |mesh, _| RepairLog { turned_faces: faces::agree(mesh), ..RepairLog::default() }),
    (Step::Fill, |mesh, options| holes::fill(mesh, options.largest_hole.min(1000))),
    (Step::Lines, |mesh, _| RepairLog { degenerate_faces: lines::mend(mesh), ..RepairLog::default() }),
    (Step::Outward, |mesh, _| RepairLog { turned_components: turn_outward(mesh), ..RepairLog::default() }),
];

/// A mended mesh, and what was done to it. What cannot be mended is left, and [`check`](super::check) says of it.
///
/// The mended mesh has no more faults than the mesh, and a solid stays one.
pub fn repair(mesh: &TriangleMesh, options: &Options) -> (TriangleMesh, RepairLog) {
    let (mut mesh, mut done) = (mesh.clone(), RepairLog::default());
    // Nothing of this changes what the surface is.
    done.broken_faces = keep_kind(&mut mesh, |kind| kind != Kind::Broken);
    done.welded_vertices = weld::equal(&mut mesh);
    done.degenerate_faces = keep_kind(&mut mesh, |kind| kind == Kind::Whole);
    let mut faults = Faults::of(&mesh);
    for _ in 0..ROUNDS {
        let before = done.clone();
        (done.obstructed_holes, done.undone) = (0, Vec::new());
        for (step, mend) in STEPS {
            let mut tried = mesh.clone();
            let log = mend(&mut tried, options);
            done.obstructed_holes += log.obstructed_holes;
            if log.is_empty() {
                continue;
            }
            let left = Faults::of(&tried);
            if left.worse_than(&faults) {
                done.undone.push(step);
            } else {
                (mesh, faults) = (tried, left);
                done.add(&log);
            }
        }
        if done == before {
            break;
        }
    }
    done.unused_vertices = weld::drop_unused(&mut mesh).saturating_sub(done.welded_vertices);
    (mesh, done)
}

/// Keeps the faces of the kinds that are wanted; returns how many are gone.
fn keep_kind(mesh: &mut TriangleMesh, wanted: impl Fn(Kind) -> bool) -> usize {
    let kinds = Topology::of(mesh).kinds;
    keep(mesh, |face| wanted(kinds[face]))
}

/// Keeps the faces that are wanted; returns how many are gone.
fn keep(mesh: &mut TriangleMesh, wanted: impl Fn(usize) -> bool) -> usize {
    let before = mesh.faces.len();
    let mut number = 0..;
    mesh.faces.retain(|_| number.next().is_none_or(&wanted));
    let mut number = 0..;
    mesh.face_slots.retain(|_| number.next().is_none_or(&wanted));
    let mut number = 0..;
    mesh.face_uvs.retain(|_| number.next().is_none_or(&wanted));
    before - mesh.faces.len()
}

/// Turns what is inside out, if that leaves less of it: in a tangle of faces one may be inside out because of another, and
/// would be turned to and fro.
fn turn_outward(mesh: &mut TriangleMesh) -> usize {
    let inside_out = |report: &Report| report.components.iter().filter(|c| c.inside_out).count();
    let report = structure(mesh);
    let before = inside_out(&report);
    if before == 0 {
        return 0;
    }
    let mut turned = mesh.clone();
    for (face, &component) in report.component_of.iter().enumerate() {
        if component != NO_COMPONENT && report.components[component as usize].inside_out {
            turned.turn(face);
        }
    }
    if inside_out(&structure(&turned)) >= before {
        return 0;
    }
    *mesh = turned;
    before
}
