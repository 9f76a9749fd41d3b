//! Is a mesh a solid? What is wrong with it, where, and how to mend it.
//!
//! Refraction needs solids: a ray that enters must leave. [`check`] says of a mesh whether it is closed, whether its faces
//! look the same way and outward, where it crosses itself, and what its parts are; [`repair()`] mends what can be mended
//! without guessing. Both take time in proportion to n log n for n faces, whatever the faces are: where a mesh is so
//! entangled that looking at all pairs would take longer, they stop and say so.
//!
//! Vertices at equal positions are one vertex. Everything that is decided (on a line, in a plane, crossing) is decided
//! exactly, without a tolerance; only volumes are rounded.

mod around;
mod crossing;
mod exact;
mod parts;
pub mod repair;
mod report;
#[cfg(test)]
mod tests;
mod topology;
mod tree;

pub use repair::{Options, RepairLog, Step, repair};
pub use report::{
    Component, Crossing, EdgePlace, FacePlace, Found, LOCATED, NO_COMPONENT, Orientation, Report, Verdict,
};

use super::{Bounds, TriangleMesh, Vec3};
use crossing::{Shapes, with_area};
use topology::{Kind, Topology, Use};

/// Looks at everything: [`structure`], and where the mesh crosses itself.
pub fn check(mesh: &TriangleMesh) -> Report {
    let mut outline = Outline::of(mesh);
    outline.find_crossings(mesh);
    outline.find_cavities();
    outline.report
}

/// The same without looking for crossings, which takes most of the time: enough to decide whether a mesh may refract.
/// [`Report::crossing`] stays empty.
pub fn structure(mesh: &TriangleMesh) -> Report {
    let mut outline = Outline::of(mesh);
    outline.find_cavities();
    outline.report
}

/// What can be said without asking where faces are, and what is needed to ask that.
struct Outline {
    topology: Topology,
    /// Without crossings and cavities.
    report: Report,
    /// The faces that have to be turned so that neighbours agree.
    turned: Vec<u32>,
    /// Copies of faces, each with the first.
    copies: Vec<(u32, u32)>,
    /// The vertices, scaled so that exact answers are exact.
    points: Vec<Vec3>,
    /// The faces with area.
    with_area: Vec<u32>,
}

impl Outline {
    fn of(mesh: &TriangleMesh) -> Self {
        let topology = Topology::of(mesh);
        let points = exact::scaled(&mesh.vertices);
        let mut parts = topology.parts(&points);
        let (component_of, count) = topology.components(&mut parts);
        let mut report = Report {
            faces: topology.uses.len() / 3,
            vertices: 0,
            edges: 0,
            broken: Found::default(),
            degenerate: Found::default(),
            duplicate: Found::default(),
            boundary: Found::default(),
            non_manifold: Found::default(),
            misoriented: Found::default(),
            against: Found::default(),
            crossing: Found::default(),
            complete: true,
            components: measured(mesh, &topology, &component_of, count),
            component_of,
        };
        for &face in &parts.contradictions {
            report.components[report.component_of[face as usize] as usize].orientable = false;
        }
        count_vertices(&topology, &mut report);
        look_at_edges(mesh, &topology, &mut report);
        // What is open or at odds with itself has no inside.
        let no_inside = |c: &&mut Component| !(c.is_closed() && c.is_oriented());
        report.components.iter_mut().filter(no_inside).for_each(|c| c.orientation = Orientation::None);
        let turned = turned(&topology, &mut parts, &report);
        for &face in &turned {
            report.against.add(|| place(mesh, face));
        }

        let (with_area, flat) = with_area(topology.whole(), &points, &topology.corners);
        let mut flat = flat.into_iter().peekable();
        for (face, kind) in (0u32..).zip(&topology.kinds) {
            match kind {
                Kind::Broken => report.broken.add(|| place(mesh, face)),
                Kind::Void => report.degenerate.add(|| place(mesh, face)),
                Kind::Whole if flat.next_if_eq(&face).is_some() => report.degenerate.add(|| place(mesh, face)),
                Kind::Whole => {}
            }
        }
        let copies = topology.duplicates();
        for &(face, _) in &copies {
            report.duplicate.add(|| place(mesh, face));
        }
        Self { topology, report, turned, copies, points, with_area }
    }

    fn find_crossings(&mut self, mesh: &TriangleMesh) {
        // Of faces in the same place one is enough.
        let mut copies = self.copies.iter().map(|copy| copy.0).peekable();
        let once = self.with_area.iter().copied().filter(|&face| {
            while copies.next_if(|&copy| copy < face).is_some() {}
            copies.peek() != Some(&face)
        });
        let shapes = Shapes::new(&self.points, &self.topology.corners, once.collect());
        let (mut crossing, complete) = shapes.crossings();
        let scale = scale(mesh, &self.points);
        crossing.first.iter_mut().for_each(|c| c.at = c.at * scale);
        self.report.crossing = crossing;
        self.report.complete &= complete;
    }

    /// Nothing may be enclosed less than not at all: the surfaces wind 0 times or more around every point. So what looks
    /// inward must lie in something else, and is then a cavity. Each component is asked just within, under its largest face:
    /// on the face itself another one may lie.
    fn find_cavities(&mut self) {
        let Self { topology, report, points, with_area, .. } = self;
        if !report.components.iter().any(|c| c.orientation == Orientation::Inward) {
            return;
        }
        let mut within = vec![(0.0, None); report.components.len()];
        for &face in with_area.iter() {
            let number = report.component_of[face as usize] as usize;
            let [a, b, c] = topology.corners[face as usize].map(|v| points[v as usize]);
            let normal = (b - a).cross(c - a);
            let size = normal.length();
            if size > within[number].0 {
                // A millionth of the size of the face: thinner than any wall, thicker than roundings.
                let depth = if report.components[number].orientation == Orientation::Inward { 1e-6 } else { -1e-6 };
                let under = (a + b + c) * (1.0 / 3.0) + normal.unit() * (depth * size.sqrt());
                within[number] = (size, Some(under).filter(|p| p.is_finite()));
            }
        }
        let asked: Vec<(u32, Vec3)> = (0u32..)
            .zip(&report.components)
            .filter(|(_, component)| component.is_solid())
            .filter_map(|(number, _)| within[number as usize].1.map(|p| (number, p)))
            .collect();
        let solid: Vec<u32> = with_area
            .iter()
            .copied()
            .filter(|&face| report.components[report.component_of[face as usize] as usize].is_solid())
            .collect();
        let shapes = Shapes::new(points, &topology.corners, solid);
        let others = |part: u32, face: u32| report.component_of[face as usize] != part;
        for ((number, _), winding) in asked.iter().zip(shapes.windings(&asked, others)) {
            report.complete &= winding.is_some();
            let component = &mut report.components[*number as usize];
            let (others, inward) = (winding.unwrap_or(0), component.orientation == Orientation::Inward);
            component.cavity = inward && others > 0;
            component.inside_out = others < 0 || (inward && others == 0);
        }
    }
}

/// The factor from scaled points back to the mesh's own: a power of two.
fn scale(mesh: &TriangleMesh, points: &[Vec3]) -> f64 {
    let pairs = mesh.vertices.iter().zip(points).filter(|(v, _)| v.is_finite());
    let pairs = pairs.flat_map(|(v, p)| [(v.x, p.x), (v.y, p.y), (v.z, p.z)]);
    pairs.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).map_or(1.0, |(v, p)| if p == 0.0 { 1.0 } else { v / p })
}

fn place(mesh: &TriangleMesh, face: u32) -> FacePlace {
    let corner = |v: u32| mesh.vertices.get(v as usize).copied().unwrap_or(Vec3::new(f64::NAN, f64::NAN, f64::NAN));
    let [a, b, c] = mesh.faces[face as usize].map(corner);
    FacePlace { face, at: a * (1.0 / 3.0) + b * (1.0 / 3.0) + c * (1.0 / 3.0) }
}

/// The components with what can be summed over their faces: number, box and volume.
fn measured(mesh: &TriangleMesh, topology: &Topology, component_of: &[u32], count: usize) -> Vec<Component> {
    let empty = Component {
        faces: 0,
        vertices: 0,
        edges: 0,
        open_edges: 0,
        misoriented_edges: 0,
        orientable: true,
        volume: 0.0,
        orientation: Orientation::None,
        cavity: false,
        inside_out: false,
        bounds: Bounds::EMPTY,
    };
    let mut components = vec![empty; count];
    for face in topology.whole() {
        let component = &mut components[component_of[face as usize] as usize];
        component.faces += 1;
        component.bounds = component.bounds.union(Bounds::of(mesh.corners(face as usize)));
    }
    // A sixth of the volumes between the faces and a point (the divergence theorem). The point is near, so that little is
    // lost to rounding far from the origin.
    let mut sums = vec![(0.0, 0.0); count];
    for face in topology.whole() {
        let component = component_of[face as usize] as usize;
        let near = components[component].bounds.min;
        let [a, b, c] = mesh.corners(face as usize).map(|p| p - near);
        let six = a.dot(b.cross(c));
        let (sum, size): &mut (f64, f64) = &mut sums[component];
        (*sum, *size) = (*sum + six, *size + six.abs());
    }
    for (component, (sum, size)) in components.iter_mut().zip(sums) {
        component.volume = sum / 6.0;
        // Each face is off by less than 16 roundings of its own part, and each addition by one of the sum.
        let error = (component.faces + 16) as f64 * f64::EPSILON * size;
        component.orientation = match sum {
            _ if sum > error => Orientation::Outward,
            _ if sum < -error => Orientation::Inward,
            _ => Orientation::None,
        };
    }
    components
}

fn count_vertices(topology: &Topology, report: &mut Report) {
    let component_of = &report.component_of;
    let at = |face: u32| topology.corners[face as usize].map(|v| (v, component_of[face as usize]));
    let mut corners: Vec<(u32, u32)> = topology.whole().flat_map(at).collect();
    corners.sort_unstable();
    corners.dedup();
    for &(_, component) in &corners {
        report.components[component as usize].vertices += 1;
    }
    report.vertices = corners.chunk_by(|a, b| a.0 == b.0).count();
}

fn look_at_edges(mesh: &TriangleMesh, topology: &Topology, report: &mut Report) {
    for edge in topology.edges() {
        report.edges += 1;
        let place = || {
            let ends = edge[0].ends.map(|v| mesh.vertices[v as usize]);
            EdgePlace { ends, face: edge[0].face, faces: edge.len() }
        };
        match edge.len() {
            1 => report.boundary.add(place),
            2 => {}
            _ => report.non_manifold.add(place),
        }
        let mut misoriented = false;
        let mut look = |uses: &[(u32, bool)]| {
            let component = &mut report.components[uses[0].0 as usize];
            component.edges += 1;
            let forward = uses.iter().filter(|u| u.1).count();
            if uses.len() % 2 == 1 {
                component.open_edges += 1;
            } else if 2 * forward != uses.len() {
                component.misoriented_edges += 1;
                misoriented = true;
            }
        };
        let component = |u: &Use| (report.component_of[u.face as usize], u.forward);
        if let [a, b] = edge {
            look(&[component(a), component(b)]);
        } else {
            let mut uses: Vec<(u32, bool)> = edge.iter().map(component).collect();
            uses.sort_unstable();
            uses.chunk_by(|a, b| a.0 == b.0).for_each(look);
        }
        if misoriented {
            report.misoriented.add(place);
        }
    }
}

/// The faces that have to be turned so that neighbours agree, in components where that is possible: the fewer ones.
fn turned(topology: &Topology, parts: &mut parts::Parts, report: &Report) -> Vec<u32> {
    let mut counts = vec![0; report.components.len()];
    let which: Vec<(u32, u32, bool)> = topology
        .whole()
        .map(|face| (face, report.component_of[face as usize], parts.find(face).1))
        .inspect(|&(_, component, turned)| counts[component as usize] += usize::from(turned))
        .collect();
    let fewer = |component: u32| 2 * counts[component as usize] <= report.components[component as usize].faces;
    let against = |&(_, component, turned): &(u32, u32, bool)| {
        report.components[component as usize].orientable && turned == fewer(component)
    };
    which.iter().filter(|one| against(one)).map(|one| one.0).collect()
}
