//! Triangle meshes as data, and their smooth normals.

use super::{Affine, Vec3, triangle};
use crate::lanes::elementary::sin_cos_degrees;

/// Triangles that share vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Positions in scene units.
    pub vertices: Vec<Vec3>,
    /// Three numbers of vertices for each face, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// For each face its slot in [`slots`](Self::slots); empty: no face names a material.
    pub face_slots: Vec<u32>,
    /// Names of the materials that the file's faces ask for.
    pub slots: Vec<String>,
    /// Texture coordinates `(u, v)`, `v` up; a picture covers 0 to 1. Finite; they have no order or number in common with
    /// the vertices, as a seam gives one vertex several.
    pub uvs: Vec<[f64; 2]>,
    /// For each face the numbers of its corners' texture coordinates, or [`NO_UVS`]; empty: no face has any.
    pub face_uvs: Vec<[u32; 3]>,
}

/// Of a face without texture coordinates.
pub const NO_UVS: [u32; 3] = [u32::MAX; 3];

/// A vertex that more faces share is not smoothed: the cost grows with the square of this number.
pub const MAX_SMOOTHED_VALENCE: usize = 512;

impl TriangleMesh {
    /// The three corners of a face.
    pub fn corners(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|v| self.vertices[v as usize])
    }

    /// The texture coordinates of a face's corners, if it has any.
    pub fn corner_uvs(&self, face: usize) -> Option<[[f64; 2]; 3]> {
        let numbers = *self.face_uvs.get(face)?;
        (numbers != NO_UVS).then(|| numbers.map(|number| self.uvs[number as usize]))
    }

    /// Turns a face so that it looks the other way.
    pub(crate) fn turn(&mut self, face: usize) {
        self.faces[face].swap(1, 2);
        if let Some(uvs) = self.face_uvs.get_mut(face) {
            uvs.swap(1, 2);
        }
    }

    /// The same mesh under a map; its texture sticks to it.
    #[must_use]
    pub fn transformed(&self, map: &Affine) -> Self {
        Self { vertices: self.vertices.iter().map(|&v| map.apply(v)).collect(), ..self.clone() }
    }

    /// Normals of each face's corners: a mean of the unit normals of those faces at the same vertex that lie within `cutoff`
    /// degrees of this face. A mean of unit vectors, so at most of unit length.
    pub fn smooth_normals(&self, cutoff: f64, weights: NormalWeights) -> Vec<[Vec3; 3]> {
        let normal = |face| Some(triangle::normal(self.corners(face))).filter(|n| n.is_finite());
        let flat: Vec<Option<Vec3>> = (0..self.faces.len()).map(normal).collect();
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); self.vertices.len()];
        for (face, corners) in self.faces.iter().enumerate() {
            for &vertex in corners {
                around[vertex as usize].push(face as u32);
            }
        }
        let least = if cutoff >= 180.0 { -2.0 } else { sin_cos_degrees(cutoff).1 };
        let at = |face: usize, vertex: u32| {
            let Some(own) = flat[face] else { return Vec3::default() };
            let neighbours = &around[vertex as usize];
            if neighbours.len() > MAX_SMOOTHED_VALENCE {
                return own;
            }
            let all = neighbours.iter().filter_map(|&f| Some((f as usize, flat[f as usize]?)));
            let near = all.filter(|(_, normal)| normal.dot(own) >= least);
            let (sum, total) = near.fold((Vec3::default(), 0.0), |(sum, total), (face, normal)| {
                let weight = match weights {
                    NormalWeights::Equal => 1.0,
                    NormalWeights::Angle => self.angle_at(face, vertex),
                };
                (sum + normal * weight, total + weight)
            });
            // Opposite normals can cancel.
            if sum == Vec3::default() { own } else { sum * (1.0 / total) }
        };
        (0..self.faces.len()).map(|face| self.faces[face].map(|vertex| at(face, vertex))).collect()
    }

    /// The angle of a face at one of its corners, in radians.
    fn angle_at(&self, face: usize, vertex: u32) -> f64 {
        let Some(first) = self.faces[face].iter().position(|&v| v == vertex) else { return 0.0 };
        let corners = self.corners(face);
        let (a, b) = (corners[(first + 1) % 3] - corners[first], corners[(first + 2) % 3] - corners[first]);
        libm::atan2(a.cross(b).length(), a.dot(b))
    }
}

/// What a face counts at a vertex, beside the others that meet there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalWeights {
    /// As much as each other one, as in the course's programs.
    Equal,
    /// Its angle there, so that it does not matter how a polygon is cut into triangles (Thürmer and Wüthrich, "Computing
    /// Vertex Normals from Polygonal Facets", 1998).
    Angle,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two faces of a roof that meet at 90 degrees along the x axis.
    fn roof() -> TriangleMesh {
        TriangleMesh {
            vertices: [[0., 0., 0.], [1., 0., 0.], [0., 1., -1.], [0., -1., -1.]].map(Vec3::from).to_vec(),
            faces: vec![[0, 1, 2], [1, 0, 3]],
            ..TriangleMesh::default()
        }
    }

    #[test]
    fn faces_beyond_the_cutoff_do_not_bend_the_normal() {
        let (sharp, smooth) =
            (roof().smooth_normals(80.0, NormalWeights::Equal), roof().smooth_normals(100.0, NormalWeights::Equal));
        let half = 0.5f64.sqrt();
        assert!((sharp[0][0].unit() - Vec3::new(0.0, half, half)).length() < 1e-15);
        assert!((smooth[0][0].unit() - Vec3::new(0.0, 0.0, 1.0)).length() < 1e-15, "the ridge points up");
        assert!((smooth[0][2].unit() - Vec3::new(0.0, half, half)).length() < 1e-15, "the eaves stay");
    }

    #[test]
    fn many_faces_at_a_corner_weigh_no_more_than_few() {
        // A pyramid: four faces meet at the tip, two at each foot.
        let feet = [[1., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [0., -1., 0.]];
        let mesh = TriangleMesh {
            vertices: [[0., 0., 1.]].into_iter().chain(feet).map(Vec3::from).collect(),
            faces: (0..4).map(|i| [0, i + 1, (i + 1) % 4 + 1]).collect(),
            ..TriangleMesh::default()
        };
        // Each face's normal is (±1, ±1, 1)/√3. At the tip x and y cancel; at the foot (1, 0, 0) y does.
        let [tip, foot, _] = mesh.smooth_normals(180.0, NormalWeights::Equal)[0];
        let s = 1.0 / 3.0f64.sqrt();
        assert!((tip - Vec3::new(0.0, 0.0, s)).length() < 1e-15, "{tip:?}");
        assert!((foot - Vec3::new(s, 0.0, s)).length() < 1e-15, "{foot:?}");
    }

    /// At the end of a cylinder one triangle meets a vertex from one side, and two from the other.
    #[test]
    fn by_angle_it_does_not_matter_how_a_wall_is_cut() {
        let corner = |step: u32, y: f64| {
            let (sin, cos) = sin_cos_degrees(f64::from(step) * 20.0);
            Vec3::new(cos, y, -sin)
        };
        let mesh = TriangleMesh {
            vertices: (0..18).flat_map(|step| [corner(step, 0.0), corner(step, 2.0)]).collect(),
            faces: (0..18u32)
                .flat_map(|i| {
                    let [low, high, next_low, next_high] = [2 * i, 2 * i + 1, (2 * i + 2) % 36, (2 * i + 3) % 36];
                    [[low, next_low, high], [high, next_low, next_high]]
                })
                .collect(),
            ..TriangleMesh::default()
        };
        let largest = |weights| {
            let normals = mesh.smooth_normals(30.0, weights);
            let corners = mesh.faces.iter().zip(&normals).flat_map(|(face, normals)| face.iter().zip(normals));
            let turned = corners.map(|(&v, n)| {
                let radius = Vec3 { y: 0.0, ..mesh.vertices[v as usize] };
                radius.cross(n.unit()).length()
            });
            turned.fold(0.0f64, f64::max)
        };
        // A sixth of a segment, 3.3 degrees; and a few roundings.
        assert!(largest(NormalWeights::Equal) > 0.05);
        assert!(largest(NormalWeights::Angle) < 1e-14, "{}", largest(NormalWeights::Angle));
    }

    #[test]
    fn a_face_without_area_has_no_normal_and_spoils_none() {
        let mut mesh = roof();
        mesh.faces.push([0, 0, 1]);
        assert_eq!(mesh.smooth_normals(100.0, NormalWeights::Equal)[2], [Vec3::default(); 3]);
        assert_eq!(
            mesh.smooth_normals(100.0, NormalWeights::Equal)[0],
            roof().smooth_normals(100.0, NormalWeights::Equal)[0]
        );
    }
}
