//! Mending a mesh: what can be mended without guessing what was meant.
//!
//! In this order: broken faces go; vertices in one place become one; faces with two corners in one place and copies of faces
//! go; faces are turned so that neighbours agree; small holes are filled; faces that are a line are mended; solids are
//! turned outward; vertices that no face uses go. What is already right is left as it is, so that repairing twice is
//! repairing once. Faces keep their materials and texture coordinates; those that fill holes have no texture coordinates.

mod faces;
mod holes;
mod lines;
#[cfg(test)]
mod tests;
mod weld;

use super::topology::{Kind, Topology};
use super::{NO_COMPONENT, Report, structure};
use crate::geometry::TriangleMesh;

/// What to mend.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Vertices at most so far from each other become one, as a share of the diagonal of the mesh, from 0 (equal positions
    /// only) to 0.1.
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

    /// Was there nothing to do?
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// What one round mends can bring to light what another mends, in meshes that are hardly surfaces. After so many it is
/// enough.
const ROUNDS: usize = 8;

/// A mended mesh, and what was done to it. A solid stays one; what cannot be mended is left, and
/// [`check`](super::check) says of it.
pub fn repair(mesh: &TriangleMesh, options: &Options) -> (TriangleMesh, RepairLog) {
    let (mended, log) = mend(mesh, options);
    if options.weld > 0.0 {
        // A tolerance can weld what was meant to be two: a thin wall's sides.
        let (before, after) = (structure(mesh), structure(&mended));
        if before.is_solid() && !(after.is_solid() && after.components.len() == before.components.len()) {
            return mend(mesh, &Options { weld: 0.0, ..*options });
        }
    }
    (mended, log)
}

fn mend(mesh: &TriangleMesh, options: &Options) -> (TriangleMesh, RepairLog) {
    let (mut mesh, mut done) = (mesh.clone(), RepairLog::default());
    for _ in 0..ROUNDS {
        let log = round(&mut mesh, options);
        done.add(&log);
        if log.is_empty() {
            break;
        }
    }
    (mesh, done)
}

fn round(mesh: &mut TriangleMesh, options: &Options) -> RepairLog {
    let mut log = RepairLog::default();
    let kinds = Topology::of(mesh).kinds;
    log.broken_faces = keep(mesh, |face| kinds[face] != Kind::Broken);
    log.welded_vertices = weld::weld(mesh, options.weld.clamp(0.0, 0.1));
    let kinds = Topology::of(mesh).kinds;
    log.degenerate_faces = keep(mesh, |face| kinds[face] == Kind::Whole);
    log.duplicate_faces = faces::remove_copies(mesh);
    log.turned_faces = faces::agree(mesh);
    (log.filled_holes, log.new_faces) = holes::fill(mesh, options.largest_hole.min(1000));
    log.degenerate_faces += lines::mend(mesh);
    log.turned_components = turn_outward(mesh);
    log.unused_vertices = weld::drop_unused(mesh).saturating_sub(log.welded_vertices);
    log
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
