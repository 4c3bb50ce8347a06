//! PLY, binary, little-endian: a vertex a place, with the mean of the normals there; patch and texture coordinates
//! belong to faces, since places at the edges of patches have several.

use std::io::{Result, Write};

use glam::Vec3;

use super::{Mesh, weld};

pub(super) fn write(mesh: &Mesh, file: &mut impl Write) -> Result<()> {
    let (places, place_of) = weld::places(&mesh.positions);
    let mut normals = vec![Vec3::ZERO; places.len()];
    for (normal, place) in mesh.normals.iter().zip(&place_of) {
        normals[*place as usize] += Vec3::from(*normal);
    }
    write!(
        file,
        "ply\nformat binary_little_endian 1.0\ncomment micropoly\n\
         element vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         property float nx\nproperty float ny\nproperty float nz\n\
         element face {}\nproperty list uchar uint vertex_indices\nproperty list uchar float texcoord\n\
         property uint patch\nend_header\n",
        places.len(),
        mesh.triangles.len()
    )?;
    for (place, normal) in places.iter().zip(normals) {
        for number in place.iter().chain(&normal.normalize_or_zero().to_array()) {
            file.write_all(&number.to_le_bytes())?;
        }
    }
    for triangle in &mesh.triangles {
        file.write_all(&[3])?;
        for corner in triangle {
            file.write_all(&place_of[*corner as usize].to_le_bytes())?;
        }
        file.write_all(&[6])?;
        for t in triangle.iter().flat_map(|corner| mesh.uvs[*corner as usize]) {
            file.write_all(&t.to_le_bytes())?;
        }
        file.write_all(&mesh.patches[triangle[0] as usize].to_le_bytes())?;
    }
    Ok(())
}
