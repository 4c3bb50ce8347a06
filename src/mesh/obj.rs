//! Wavefront OBJ: places, texture coordinates and normals have numbers of their own, so places are shared.

use std::io::{Result, Write};

use super::{Mesh, weld};

pub(super) fn write(mesh: &Mesh, file: &mut impl Write) -> Result<()> {
    let (places, place_of) = weld::places(&mesh.positions);
    writeln!(file, "# micropoly: {} triangles", mesh.triangles.len())?;
    for [x, y, z] in places {
        writeln!(file, "v {x} {y} {z}")?;
    }
    for [u, v] in &mesh.uvs {
        writeln!(file, "vt {u} {v}")?;
    }
    for [x, y, z] in &mesh.normals {
        writeln!(file, "vn {x} {y} {z}")?;
    }
    let mut patch = u32::MAX;
    for triangle in &mesh.triangles {
        let own = mesh.patches[triangle[0] as usize];
        if own != patch {
            patch = own;
            writeln!(file, "g patch{patch}")?;
        }
        let [a, b, c] = triangle.map(|corner| {
            let (place, own) = (place_of[corner as usize] + 1, corner + 1);
            format!("{place}/{own}/{own}")
        });
        writeln!(file, "f {a} {b} {c}")?;
    }
    Ok(())
}
