//! Known answers, on meshes whose answers can be seen.

use super::*;
use crate::geometry::TriangleMesh;
use std::time::{Duration, Instant};

fn mesh(vertices: &[[f64; 3]], faces: &[[u32; 3]]) -> TriangleMesh {
    let vertices = vertices.iter().map(|&v| v.into()).collect();
    TriangleMesh { vertices, faces: faces.to_vec(), ..TriangleMesh::default() }
}

fn tetra() -> TriangleMesh {
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]], &faces)
}

/// A cube of edge `size` with its lowest corner at `at`.
fn cube(at: [f64; 3], size: f64) -> TriangleMesh {
    let corner = |i: u32| [0, 1, 2].map(|axis| at[axis] + if i >> axis & 1 == 1 { size } else { 0.0 });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh(&(0..8).map(corner).collect::<Vec<_>>(), &faces)
}

pub(super) fn torus(around: u32, across: u32) -> TriangleMesh {
    let turn = |i: u32, n: u32| crate::lanes::elementary::sin_cos_degrees(360.0 * f64::from(i) / f64::from(n));
    let vertex = |i: u32| {
        let ((sin, cos), (s, c)) = (turn(i / across, around), turn(i % across, across));
        [(3.0 + c) * cos, (3.0 + c) * sin, s]
    };
    let number = |i: u32, j: u32| i % around * across + j % across;
    let faces: Vec<[u32; 3]> = (0..around * across)
        .flat_map(|k| {
            let (i, j) = (k / across, k % across);
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    mesh(&(0..around * across).map(vertex).collect::<Vec<_>>(), &faces)
}

fn both(mut a: TriangleMesh, b: &TriangleMesh) -> TriangleMesh {
    let first = a.vertices.len() as u32;
    a.vertices.extend(&b.vertices);
    a.faces.extend(b.faces.iter().map(|f| f.map(|v| v + first)));
    a
}

fn turned(mut mesh: TriangleMesh) -> TriangleMesh {
    mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
    mesh
}

/// Every face with vertices of its own.
fn unwelded(m: &TriangleMesh) -> TriangleMesh {
    let vertices = m.faces.iter().flatten().map(|&v| m.vertices[v as usize]).collect();
    TriangleMesh {
        vertices,
        faces: (0..m.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect(),
        ..m.clone()
    }
}

/// Mends, mends again, and checks that the second time there was nothing to do.
fn mended(m: &TriangleMesh) -> (TriangleMesh, RepairLog) {
    let (once, log) = repair(m, &Options::default());
    let (twice, nothing) = repair(&once, &Options::default());
    assert!(nothing.is_empty() && twice == once, "{nothing:?} after {log:?}");
    (once, log)
}

/// A solid that repair leaves as it is.
fn solid(m: &TriangleMesh, volume: f64, euler: i64, components: usize) -> Report {
    let report = check(m);
    assert_eq!(report.verdict(), Verdict::Solid, "{report:?}");
    // Sums of a few hundred roundings of numbers near 1.
    assert!((report.volume() - volume).abs() < 1e-12, "{}", report.volume());
    assert_eq!((report.euler(), report.components.len()), (euler, components));
    assert!(report.is_solid() && report.complete);
    assert!(report.component_of.iter().all(|&c| (c as usize) < components));
    assert_eq!(mended(m), (m.clone(), RepairLog::default()));
    report
}

#[test]
fn solids_are_solids() {
    for m in [tetra(), cube([0., 0., 0.], 1.0), torus(9, 7)] {
        let report = check(&m);
        assert!(report.crossing.is_empty() && report.non_manifold.is_empty() && report.against.is_empty());
        assert!(report.duplicate.is_empty() && report.degenerate.is_empty() && report.broken.is_empty());
    }
    solid(&tetra(), 1.0 / 6.0, 2, 1);
    let cube_at = cube([-5., 2., 1.], 2.0);
    assert_eq!(solid(&cube_at, 8.0, 2, 1).components[0].orientation, Orientation::Outward);
    let m = torus(9, 7);
    // The polygon swept around, as a sum of the same tetrahedra in another order.
    let volume: f64 =
        m.faces.iter().map(|f| f.map(|v| m.vertices[v as usize])).map(|[a, b, c]| a.dot(b.cross(c))).sum();
    solid(&m, volume / 6.0, 0, 1);
    let two = solid(&both(tetra(), &cube([5., 5., 5.], 1.0)), 7.0 / 6.0, 4, 2);
    assert_eq!(two.component_of, [vec![0; 4], vec![1; 12]].concat());
}

#[test]
fn equal_positions_are_one_vertex() {
    let mut m = unwelded(&cube([0., 0., 0.], 1.0));
    m.vertices[0].x = -0.0;
    let report = check(&m);
    assert_eq!((report.verdict(), report.vertices, report.edges, report.euler()), (Verdict::Solid, 8, 18, 2));
    let (welded, log) = mended(&m);
    assert_eq!((welded.vertices.len(), log.welded_vertices, log.unused_vertices), (8, 28, 0));
}

#[test]
fn a_flipped_face_is_found_and_turned_back() {
    let mut m = cube([0., 0., 0.], 1.0);
    m.faces[5].swap(0, 1);
    let report = check(&m);
    assert_eq!(report.verdict(), Verdict::Misoriented);
    assert!(!report.is_solid() && report.boundary.is_empty());
    assert_eq!((report.misoriented.count, report.against.count, report.against.first[0].face), (3, 1, 5));
    let (mended, log) = mended(&m);
    assert_eq!(log, RepairLog { turned_faces: 1, ..RepairLog::default() });
    solid(&mended, 1.0, 2, 1);
}

#[test]
fn inside_out_is_found_and_turned_but_a_cavity_is_none() {
    let big = cube([0., 0., 0.], 3.0);
    let report = check(&turned(big.clone()));
    assert_eq!((report.verdict(), report.components[0].orientation), (Verdict::InsideOut, Orientation::Inward));
    assert!(report.is_solid(), "closed and consistent all the same");
    assert_eq!(mended(&turned(big.clone())).1, RepairLog { turned_components: 1, ..RepairLog::default() });

    let hollow = both(big.clone(), &turned(cube([1., 1., 1.], 1.0)));
    let report = solid(&hollow, 26.0, 4, 2);
    assert!(report.components[1].cavity && !report.components[0].cavity);
    // A solid in the cavity, and the whole inside out: every part is turned, and only then.
    let nested = both(hollow, &cube([1.25, 1.25, 1.25], 0.5));
    solid(&nested, 26.125, 6, 3);
    let (again, log) = mended(&turned(nested.clone()));
    assert_eq!(log.turned_components, 3);
    solid(&again, 26.125, 6, 3);
    // Beside it, inside out is inside out.
    assert_eq!(check(&both(big, &turned(cube([5., 1., 1.], 1.0)))).verdict(), Verdict::InsideOut);
}

#[test]
fn a_pinhole_is_found_and_filled() {
    let mut m = torus(40, 30);
    let whole = check(&m).volume();
    m.faces.remove(1234);
    let report = check(&m);
    assert_eq!((report.verdict(), report.boundary.count, report.euler()), (Verdict::Open, 3, -1));
    let (filled, log) = mended(&m);
    assert_eq!((log.filled_holes, log.new_faces), (1, 1));
    // The same triangle, in another place of the sum.
    assert!((check(&filled).volume() - whole).abs() < 1e-10);
    assert_eq!(check(&filled).verdict(), Verdict::Solid);
    // A larger one, not in a plane, and one of two triangles.
    let mut m = torus(40, 30);
    m.faces.retain(|f| !(f.contains(&615) || f.contains(&616) || f.contains(&645)));
    m.faces.drain(10..12);
    let (filled, log) = mended(&m);
    assert_eq!((log.filled_holes, check(&filled).verdict()), (2, Verdict::Solid));
    assert!(check(&filled).crossing.is_empty());
    let (left, log) = repair(&m, &Options { largest_hole: 4, ..Options::default() });
    assert!(log.filled_holes == 1 && check(&left).verdict() == Verdict::Open);
}

#[test]
fn an_open_tube_is_closed_and_a_sheet_is_not() {
    let mut m = cube([0., 0., 0.], 1.0);
    m.faces.drain(0..4);
    let (filled, log) = mended(&m);
    assert_eq!((log.filled_holes, log.new_faces), (2, 4));
    solid(&filled, 1.0, 2, 1);
    for faces in [&[[0, 1, 2]][..], &[[0, 1, 2], [0, 2, 3]], &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]] {
        let sheet = mesh(&[[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.], [1., 1., 0.]], faces);
        assert_eq!(mended(&sheet).1.filled_holes, 0, "{faces:?}");
        assert_eq!(check(&sheet).verdict(), Verdict::Open);
    }
}

#[test]
fn copies_of_faces() {
    let mut m = cube([0., 0., 0.], 1.0);
    m.faces.push([m.faces[3][1], m.faces[3][2], m.faces[3][0]]);
    let report = check(&m);
    assert_eq!((report.duplicate.count, report.duplicate.first[0].face, report.verdict()), (1, 12, Verdict::Open));
    assert!(report.crossing.is_empty());
    let (once, log) = mended(&m);
    assert_eq!(log, RepairLog { duplicate_faces: 1, ..RepairLog::default() });
    solid(&once, 1.0, 2, 1);
    // Two cubes that share a wall, each with its own: both are solids, and stay.
    let touching = both(cube([0., 0., 0.], 1.0), &cube([1., 0., 0.], 1.0));
    let report = check(&touching);
    assert_eq!((report.verdict(), report.components.len(), report.non_manifold.count), (Verdict::Solid, 2, 5));
    assert_eq!((report.components[0].volume, report.components[1].faces), (1.0, 12));
    assert_eq!(mended(&touching).1.duplicate_faces, 0);
    for (which, m) in [
        both(turned(cube([0., 0., 0.], 1.0)), &cube([1., 0., 0.], 1.0)),
        both(cube([0., 0., 0.], 1.0), &turned(cube([1., 0., 0.], 1.0))),
    ]
    .iter()
    .enumerate()
    {
        let components = check(m).components;
        // The two walls look the same way now, and are one too many.
        assert!(components.len() != 2 || components[which].inside_out && !components[1 - which].inside_out);
    }
    // Around a cube all of whose vertices are others' too.
    let cross = [
        [1., 0., 0.],
        [0., 1., 0.],
        [0., 0., 1.],
        [2., 1., 1.],
        [1., 2., 1.],
        [1., 1., 2.],
        [0., 1., 1.],
        [1., 0., 1.],
    ];
    let stack = cross.iter().fold(turned(cube([9., 0., 0.], 1.0)), |m, &at| both(m, &cube(at, 1.0)));
    let report = check(&both(stack, &cube([1., 1., 1.], 1.0)));
    assert_eq!(report.components.iter().filter(|c| c.inside_out).count(), 1, "{report:?}");
    assert!(report.components[0].inside_out);
    // Every face for both of its sides.
    let m = cube([0., 0., 0.], 1.0);
    let (single, log) = mended(&both(m.clone(), &turned(m.clone())));
    assert_eq!((log.duplicate_faces, check(&single).verdict()), (12, Verdict::Solid));
}

#[test]
fn a_copy_that_closes_another_solid_stays() {
    // Two tetrahedra on one base: without one of its copies, one of them would be open.
    let low = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.1, 0.1, 1.], [0.1, 0.1, 2.]];
    let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]];
    let nested = mesh(&low, &faces);
    assert_eq!((check(&nested).verdict(), check(&nested).duplicate.count), (Verdict::Solid, 1));
    assert_eq!(mended(&nested), (nested.clone(), RepairLog::default()));
    // Elsewhere in the same mesh a copy is one too many all the same.
    let mut beside = cube([5., 0., 0.], 1.0);
    beside.faces.push(beside.faces[3]);
    let (once, log) = mended(&both(nested, &beside));
    assert_eq!((once.faces.len(), log), (20, RepairLog { duplicate_faces: 1, ..RepairLog::default() }));
    assert_eq!(check(&once).verdict(), Verdict::Solid);
}

#[test]
fn a_hole_with_something_in_it_is_left_open() {
    let mut m = cube([0., 0., 0.], 1.0);
    let lid = |f: &[u32; 3]| f.iter().all(|&v| v >= 4);
    m.faces.retain(|f| !lid(f));
    assert!(mended(&m).1.filled_holes == 1);
    let spike = cube([0.4, 0.4, 0.5], 0.2);
    let within = both(m.clone(), &spike);
    assert_eq!(check(&mended(&within).0).verdict(), Verdict::Solid);
    let longer = |v: &Vec3| Vec3::new(v.x, v.y, if v.z > 0.6 { 1.5 } else { v.z });
    let tall = TriangleMesh { vertices: spike.vertices.iter().map(longer).collect(), ..spike };
    let through = both(m, &tall);
    assert_eq!(mended(&through), (through.clone(), RepairLog { obstructed_holes: 1, ..RepairLog::default() }));
}

#[test]
fn faces_without_area() {
    let mut m = cube([0., 0., 0.], 1.0);
    m.faces.push([0, 0, 1]);
    m.faces.push([0, 1, 99]);
    m.vertices.push([f64::NAN, 0., 0.].into());
    m.faces.push([0, 1, 8]);
    let report = check(&m);
    assert_eq!((report.degenerate.count, report.broken.count, report.verdict()), (1, 2, Verdict::Open));
    assert_eq!(report.component_of[12..], [NO_COMPONENT; 3]);
    let (clean, log) = mended(&m);
    assert_eq!((log.degenerate_faces, log.broken_faces, log.unused_vertices), (1, 2, 1));
    solid(&clean, 1.0, 2, 1);
}

#[test]
fn a_vertex_on_an_edge() {
    // The edge 0-1 of the face below has a vertex in its middle on the face in front.
    let mut m = cube([0., 0., 0.], 1.0);
    m.vertices.push([0.5, 0., 0.].into());
    let front = m.faces.iter().position(|f| f[..2] == [0, 1]).unwrap();
    let other = m.faces[front][2];
    m.faces[front] = [0, 8, other];
    m.faces.push([8, 1, other]);
    // Open along the edge: nothing wide, but light gets lost there.
    assert_eq!((check(&m).verdict(), check(&m).boundary.count), (Verdict::Open, 3));
    let (closed, log) = mended(&m);
    assert_eq!((log.filled_holes, log.new_faces, log.degenerate_faces), (1, 1, 1));
    solid(&closed, 1.0, 2, 1);
    // A face without area that fills the crack makes it closed, and is said.
    m.faces.push([0, 1, 8]);
    assert_eq!((check(&m).verdict(), check(&m).degenerate.count), (Verdict::Solid, 1));
    solid(&mended(&m).0, 1.0, 2, 1);
}

#[test]
fn a_moebius_strip_cannot_be_oriented() {
    let n = 12;
    let turn = |degrees: f64| crate::lanes::elementary::sin_cos_degrees(degrees);
    let vertex = |i: u32| {
        let ((sin, cos), (s, c)) = (turn(30.0 * f64::from(i / 2)), turn(15.0 * f64::from(i / 2)));
        let side = if i.is_multiple_of(2) { 0.5 } else { -0.5 };
        [(2.0 + side * c) * cos, (2.0 + side * c) * sin, side * s]
    };
    let vertices: Vec<[f64; 3]> = (0..2 * n).map(vertex).collect();
    let quad = |i: u32| {
        let next = if i + 1 < n { [2 * i + 2, 2 * i + 3] } else { [1, 0] };
        [[2 * i, 2 * i + 1, next[0]], [2 * i + 1, next[1], next[0]]]
    };
    let strip = mesh(&vertices, &(0..n).flat_map(quad).collect::<Vec<_>>());
    let report = check(&strip);
    assert_eq!((report.euler(), report.boundary.count, report.components.len()), (0, 24, 1));
    assert!(!report.components[0].orientable && report.verdict() == Verdict::Open);
    assert_eq!(report.misoriented.count, 1);
    assert_eq!(mended(&strip).0, strip, "nothing to mend");
}

#[test]
fn cubes_that_share_an_edge_are_two_solids() {
    let m = both(cube([0., 0., 0.], 1.0), &cube([1., 1., 0.], 1.0));
    let report = check(&m);
    assert_eq!((report.non_manifold.count, report.non_manifold.first[0].faces), (1, 4));
    assert!(report.crossing.is_empty());
    assert_eq!((report.components.len(), report.components[0].euler(), report.euler()), (2, 2, 3));
    assert_eq!(report.verdict(), Verdict::Solid);
    let (welded, log) = mended(&m);
    assert_eq!(log, RepairLog { welded_vertices: 2, ..RepairLog::default() });
    assert_eq!(check(&welded).components, report.components);
    let one_turned = both(cube([0., 0., 0.], 1.0), &turned(cube([1., 1., 0.], 1.0)));
    let report = check(&one_turned);
    assert_eq!(
        (report.components.len(), report.verdict(), report.components[1].inside_out),
        (2, Verdict::InsideOut, true)
    );
    // Four cubes in a ring around a hole, each of them edge to edge with the next.
    let at = [[0., 1., 0.], [1., 0., 0.], [2., 1., 0.], [1., 2., 0.]];
    let ring = at.iter().skip(1).fold(cube(at[0], 1.0), |m, &at| both(m, &cube(at, 1.0)));
    assert_eq!((check(&ring).non_manifold.count, check(&ring).components.len()), (4, 4));
    // Inside out, what lies between faces is what is around the cubes: one thing, which is turned.
    assert_eq!(check(&repair(&turned(ring.clone()), &Options::default()).0).verdict(), Verdict::Solid);
}

#[test]
fn boxes_that_cross_are_found() {
    let m = both(cube([0., 0., 0.], 1.0), &cube([0.5, 0.25, 0.25], 1.0));
    let report = check(&m);
    assert_eq!(report.verdict(), Verdict::Solid);
    assert!(report.crossing.count > 0 && report.complete);
    for crossing in &report.crossing.first {
        assert!(crossing.faces[0] < 12 && crossing.faces[1] >= 12);
        assert!((0.0..=1.0).contains(&crossing.at.x) && (0.25..=1.0).contains(&crossing.at.y), "{crossing:?}");
    }
    let far = mesh(&m.vertices.iter().map(|v| [v.x * 1e12, v.y * 1e12, v.z * 1e12]).collect::<Vec<_>>(), &m.faces);
    assert_eq!(check(&far).crossing.count, report.crossing.count);
    assert!((check(&far).crossing.first[0].at - report.crossing.first[0].at * 1e12).length() < 1.0);
    assert_eq!(structure(&m).crossing.count, 0);
    // Apart, and one within the other without touching.
    assert!(check(&both(cube([0., 0., 0.], 1.0), &cube([2., 0., 0.], 1.0))).crossing.is_empty());
    assert!(check(&both(cube([0., 0., 0.], 3.0), &cube([1., 1., 1.], 1.0))).crossing.is_empty());
    // One face folded onto its neighbour, and a tip that pierces its own fan.
    let fold = mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.2, 0.5, 0.]], &[[0, 1, 2], [1, 0, 3]]);
    assert_eq!(check(&fold).crossing.count, 1);
    let fan = mesh(&[[0., 0., 0.], [4., 0., 0.], [0., 4., 0.], [2., 2., -1.], [1., 1., 1.]], &[[0, 1, 2], [0, 3, 4]]);
    assert_eq!(check(&fan).crossing.count, 1);
}

#[test]
fn a_tolerance_welds_what_is_near_but_no_walls() {
    let mut m = unwelded(&cube([0., 0., 0.], 1.0));
    for (i, v) in m.vertices.iter_mut().enumerate() {
        v.x += 1e-7 * f64::from(i as u32 % 3);
    }
    assert_eq!(check(&m).verdict(), Verdict::Open);
    let options = Options { weld: 1e-6, ..Options::default() };
    let (welded, _) = repair(&m, &options);
    assert_eq!((check(&welded).verdict(), welded.vertices.len()), (Verdict::Solid, 8));
    assert!(repair(&welded, &options).1.is_empty());
    let sheet = mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &[[0, 1, 2], [2, 1, 0]]);
    assert!(check(&sheet).verdict() == Verdict::Flat && !check(&sheet).is_solid());
    let thin = mesh(&tetra().vertices.iter().map(|v| [v.x, v.y, v.z * 1e-8]).collect::<Vec<_>>(), &tetra().faces);
    assert_eq!(repair(&thin, &options).0, thin);
    // What is closed is left as it is, however short its edges are; beside it a crack is closed all the same.
    let (wide, fine) = (Options { weld: 0.05, ..Options::default() }, torus(60, 40));
    assert_eq!(repair(&fine, &wide), (fine.clone(), RepairLog::default()));
    let (welded, log) = repair(&both(fine.clone(), &m), &wide);
    assert_eq!((check(&welded).verdict(), welded.vertices.len()), (Verdict::Solid, fine.vertices.len() + 8));
    assert_eq!((&welded.faces[..fine.faces.len()], log.degenerate_faces), (&fine.faces[..], 0));
}

#[test]
fn a_weld_that_would_leave_nothing_is_undone() {
    let ribbon = mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 0.01, 0.], [1., 0.01, 0.]], &[[0, 1, 3], [0, 3, 2]]);
    let log = RepairLog { undone: vec![Step::Weld], ..RepairLog::default() };
    assert_eq!(repair(&ribbon, &Options { weld: 0.1, ..Options::default() }), (ribbon.clone(), log));
}

/// Each would take hours where time grows with the square of the number of faces. The limit is generous for slow machines.
#[test]
fn hostile_meshes_are_fast() {
    let n = 200_000u32;
    let number = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) % 1_000_003) / 1e6;
    let at_random = |i: u32| [number(3 * i), number(3 * i + 1), number(3 * i + 2)];
    let (usual, start) = (torus(600, 300), Instant::now());
    assert!(check(&usual).complete && start.elapsed() < Duration::from_mins(1));
    let soup: Vec<[f64; 3]> = (0..3 * n).map(at_random).collect();
    let own: Vec<[u32; 3]> = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let tetras: Vec<TriangleMesh> = vec![turned(tetra())];
    let row = |i: u32| tetras[0].vertices.iter().map(move |v| [v.x + 2.0 * f64::from(i), v.y, v.z]);
    let in_a_row: Vec<[f64; 3]> = (0..n / 4).flat_map(row).collect();
    let in_a_row_faces = (0..n / 4).flat_map(|i| tetras[0].faces.iter().map(move |f| f.map(|v| v + 4 * i)));
    for (what, m, complete) in [
        ("all in one place", mesh(&[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], &vec![[0, 1, 2]; n as usize]), true),
        ("all at a point", mesh(&[[1., 1., 1.]], &vec![[0, 0, 0]; n as usize]), true),
        ("a tangle", mesh(&soup, &own), false),
        ("around one edge", mesh(&soup, &(2..n).map(|i| [0, 1, i]).collect::<Vec<_>>()), false),
        ("around one vertex", mesh(&soup, &(1..n).map(|i| [0, i, i + 1]).collect::<Vec<_>>()), false),
        ("inside out in a row", mesh(&in_a_row, &in_a_row_faces.collect::<Vec<_>>()), false),
    ] {
        let start = Instant::now();
        let report = check(&m);
        let checked = start.elapsed();
        repair(&m, &Options::default());
        let both = start.elapsed();
        assert_eq!(report.complete, complete, "{what}: {report:?}");
        assert!(both < Duration::from_mins(1), "{what}: {checked:?}, {both:?}");
    }
}
