//! Writing meshes: as OBJ for people and other programs, as PLY for what is large.

use snell::geometry::{NO_UVS, TriangleMesh};
use std::io::{Result, Write};

/// Writes a mesh as OBJ, with its texture coordinates and the names of its material libraries. Every number is written with as many digits as bring back the same `f64`.
///
/// # Errors
/// When the writer fails.
pub fn write_obj(mesh: &TriangleMesh, libraries: &[String], out: &mut (impl Write + ?Sized)) -> Result<()> {
    for library in libraries {
        writeln!(out, "mtllib {library}")?;
    }
    for v in &mesh.vertices {
        writeln!(out, "v {} {} {}", v.x, v.y, v.z)?;
    }
    for [u, v] in &mesh.uvs {
        writeln!(out, "vt {u} {v}")?;
    }
    let mut slot = None;
    for (number, face) in mesh.faces.iter().enumerate() {
        let own = mesh.face_slots.get(number).copied();
        // Faces before the first `usemtl` have the empty name; it cannot be said later.
        if let Some(name) = own.and_then(|s| mesh.slots.get(s as usize)).filter(|name| own != slot && !name.is_empty())
        {
            writeln!(out, "usemtl {name}")?;
        }
        slot = own;
        let [a, b, c] = face.map(|v| u64::from(v) + 1);
        match mesh.face_uvs.get(number).filter(|uvs| **uvs != NO_UVS) {
            Some(uvs) => {
                let [u, v, w] = uvs.map(|uv| u64::from(uv) + 1);
                writeln!(out, "f {a}/{u} {b}/{v} {c}/{w}")?;
            }
            None => writeln!(out, "f {a} {b} {c}")?,
        }
    }
    Ok(())
}

/// Writes vertices and faces of a mesh as a binary PLY, with the bits of every `f64`.
///
/// # Errors
/// When the writer fails.
pub fn write_ply(mesh: &TriangleMesh, out: &mut (impl Write + ?Sized)) -> Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.vertices.len())?;
    writeln!(out, "property double x\nproperty double y\nproperty double z\nelement face {}", mesh.faces.len())?;
    writeln!(out, "property list uchar uint vertex_indices\nend_header")?;
    for v in &mesh.vertices {
        out.write_all(&[v.x, v.y, v.z].map(f64::to_le_bytes).concat())?;
    }
    for face in &mesh.faces {
        out.write_all(&[3])?;
        out.write_all(&face.map(u32::to_le_bytes).concat())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{parse_obj, parse_ply};
    use crate::report::Source;

    #[test]
    fn what_is_written_is_read_back() {
        let text = "mtllib m.mtl\nv 0.1 -0 1e-300\nv 1e300 0.3333333333333333 2\nv 0 1 0\nvt 0.1 -3\nvt 1e-9 0\nf 1/1 2/2 3/1\nusemtl a b\nf 3 2 1\nusemtl c\nf 2 1 3\n";
        let model = parse_obj(&Source::new("a.obj", text)).unwrap();
        let mut bytes = Vec::new();
        write_obj(&model.mesh, &model.libraries, &mut bytes).unwrap();
        let again = parse_obj(&Source::new("b.obj", String::from_utf8(bytes).unwrap())).unwrap();
        assert_eq!((again.mesh, again.libraries), (model.mesh, model.libraries));
    }

    #[test]
    fn a_ply_keeps_every_bit() {
        let vertices = vec![[0.1, -0.0, 1e-300].into(), [1e300, 1.0 / 3.0, 2.0].into(), [0.0, 1.0, 0.0].into()];
        let mesh = TriangleMesh { vertices, faces: vec![[0, 1, 2], [2, 1, 0], [0, 0, 1]], ..TriangleMesh::default() };
        let mut bytes = Vec::new();
        write_ply(&mesh, &mut bytes).unwrap();
        let again = parse_ply("m.ply", &bytes).unwrap();
        assert_eq!((&again.mesh.vertices, &again.mesh.faces), (&mesh.vertices, &mesh.faces));
        assert!(again.warnings.is_empty() && again.mesh.vertices[0].y.is_sign_negative());
    }
}
