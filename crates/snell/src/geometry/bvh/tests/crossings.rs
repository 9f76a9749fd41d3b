use crate::geometry::bvh::{self, MARGIN, Quality, Shapes};
use crate::geometry::{Sphere, Vec3};

/// A tree as deep as it gets, met by a ray in all of its boxes. Crowds of spheres stand around the origin, each a quarter
/// nearer than the one before, on the axes in turn: cut in the middle, each node splits off one crowd, down to where nodes
/// are cut by count, which is done with the crowd in the origin. A crowd of 35 fills seven leaves, and all leaves are so
/// large that it costs least to let them wait beside the rest.
#[test]
fn as_many_boxes_wait_as_the_deepest_tree_has() {
    let mut spheres = Vec::new();
    for i in 0..75 {
        let scale = libm::exp2(-0.4 * f64::from(i));
        let mut center = [0.0; 3];
        center[i as usize % 3] = -scale;
        spheres.extend([Sphere { center: center.into(), radius: 2.0 * scale }; 35]);
    }
    spheres.extend(vec![Sphere { center: Vec3::default(), radius: 1e-12 }; 50_000]);
    let shapes = Shapes { spheres: &spheres, ..Shapes::default() };
    let tree = bvh::build(&shapes, vec![], 10.0 * MARGIN, Quality::Fast, 1);
    assert!(tree.statistics().depth > 65, "only {} levels", tree.statistics().depth);
    let dir = Vec3::new(1.0, 1.0, 1.0).unit();
    let mut found = Vec::new();
    tree.crossings(dir * -9.0, dir, [0.0, 20.0], &mut found);
    assert_eq!(found.len(), 2 * spheres.len(), "into each and out of it");
}
