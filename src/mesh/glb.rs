//! glTF 2.0, binary: one mesh whose vertices have position, normal, texture coordinates and the number of their
//! patch.

use std::borrow::Cow;
use std::io::{Error, Result, Write};

use gltf_json::accessor::{ComponentType, GenericComponentType, Type};
use gltf_json::buffer::{Target, View};
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::{Checked, USize64};
use gltf_json::{Accessor, Buffer, Index, Node, Root, Scene};

use super::Mesh;

/// What a file begins with, and its parts.
const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const JSON: &[u8; 4] = b"JSON";
const BINARY: &[u8; 4] = b"BIN\0";

pub(super) fn write(mesh: &Mesh, file: &mut impl Write) -> Result<()> {
    let (root, binary) = described(mesh);
    let mut json = root.to_vec().map_err(Error::other)?;
    while !json.len().is_multiple_of(4) {
        json.push(b' ');
    }
    let length = 12 + 8 + json.len() + 8 + binary.len();
    let length =
        u32::try_from(length).map_err(|_| Error::other("a .glb file ends at 4 GiB: choose .ply or .obj"))?;
    file.write_all(MAGIC)?;
    file.write_all(&VERSION.to_le_bytes())?;
    file.write_all(&length.to_le_bytes())?;
    for (kind, bytes) in [(JSON, &json), (BINARY, &binary)] {
        file.write_all(&(bytes.len() as u32).to_le_bytes())?;
        file.write_all(kind)?;
        file.write_all(bytes)?;
    }
    Ok(())
}

/// The description of a file, and the numbers it describes; each is four bytes long, so all lists are aligned.
fn described(mesh: &Mesh) -> (Root, Vec<u8>) {
    let mut parts = Parts { root: Root::default(), binary: Vec::new() };
    let patches: Vec<f32> = mesh.patches.iter().map(|patch| *patch as f32).collect();
    let attributes = [
        (
            Semantic::Positions,
            parts.list(bytemuck::cast_slice(&mesh.positions), Type::Vec3, ComponentType::F32, 12),
        ),
        (
            Semantic::Normals,
            parts.list(bytemuck::cast_slice(&mesh.normals), Type::Vec3, ComponentType::F32, 12),
        ),
        (
            Semantic::TexCoords(0),
            parts.list(bytemuck::cast_slice(&texture(mesh)), Type::Vec2, ComponentType::F32, 8),
        ),
        (
            Semantic::Extras("PATCH".into()),
            parts.list(bytemuck::cast_slice(&patches), Type::Scalar, ComponentType::F32, 4),
        ),
    ];
    let (low, high) = extent(&mesh.positions);
    let positions = &mut parts.root.accessors[0];
    (positions.min, positions.max) = (Some(low.to_vec().into()), Some(high.to_vec().into()));
    let indices = parts.list(bytemuck::cast_slice(&mesh.triangles), Type::Scalar, ComponentType::U32, 4);
    parts.root.buffer_views[indices.value()].target = Some(Checked::Valid(Target::ElementArrayBuffer));
    let primitive = Primitive {
        attributes: attributes.into_iter().map(|(name, list)| (Checked::Valid(name), list)).collect(),
        extensions: None,
        extras: Default::default(),
        indices: Some(indices),
        material: None,
        mode: Checked::Valid(Mode::Triangles),
        targets: None,
    };
    let Parts { mut root, binary } = parts;
    let drawn = root.push(gltf_json::Mesh {
        extensions: None,
        extras: Default::default(),
        name: None,
        primitives: vec![primitive],
        weights: None,
    });
    let node = root.push(Node { mesh: Some(drawn), ..Default::default() });
    root.push(Scene { extensions: None, extras: Default::default(), name: None, nodes: vec![node] });
    root.push(Buffer {
        byte_length: USize64::from(binary.len()),
        name: None,
        uri: None,
        extensions: None,
        extras: Default::default(),
    });
    root.scene = Some(Index::new(0));
    root.asset.generator = Some("micropoly".into());
    (root, binary)
}

/// Texture coordinates: here pictures begin at the top.
fn texture(mesh: &Mesh) -> Cow<'_, [[f32; 2]]> {
    if !mesh.is_textured {
        return Cow::Borrowed(&mesh.uvs);
    }
    mesh.uvs.iter().map(|[u, v]| [*u, 1.0 - v]).collect()
}

struct Parts {
    root: Root,
    binary: Vec<u8>,
}

impl Parts {
    /// Adds a list of elements that are `size` bytes long each.
    fn list(&mut self, bytes: &[u8], kind: Type, component: ComponentType, size: usize) -> Index<Accessor> {
        let view = self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(self.binary.len())),
            byte_stride: None,
            name: None,
            target: Some(Checked::Valid(Target::ArrayBuffer)),
            extensions: None,
            extras: Default::default(),
        });
        self.binary.extend_from_slice(bytes);
        self.root.push(Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            count: USize64::from(bytes.len() / size),
            component_type: Checked::Valid(GenericComponentType(component)),
            extensions: None,
            extras: Default::default(),
            type_: Checked::Valid(kind),
            min: None,
            max: None,
            name: None,
            normalized: false,
            sparse: None,
        })
    }
}

fn extent(positions: &[[f32; 3]]) -> ([f32; 3], [f32; 3]) {
    let all =
        (positions.first().copied().unwrap_or_default(), positions.first().copied().unwrap_or_default());
    positions.iter().fold(all, |(low, high), position| {
        ([0, 1, 2].map(|k| low[k].min(position[k])), [0, 1, 2].map(|k| high[k].max(position[k])))
    })
}
