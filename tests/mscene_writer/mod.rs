//! Writes `.mscene` files for tests, good ones and bad.
#![allow(dead_code, reason = "each test program uses a part of it")]

use capnp::message::{Builder, HeapAllocator};

use crate::mscene::mscene_capnp::{light_source, mesh, quaternion, scene, transform, vec3};

/// Translation, then r, i, j, k.
pub(crate) type Transform = ([f32; 3], [f32; 4]);

#[derive(Clone)]
pub(crate) struct MeshSample {
    pub(crate) name: &'static str,
    pub(crate) kind: mesh::Type,
    pub(crate) positions: Vec<f32>,
}

#[derive(Clone)]
pub(crate) struct LightSample {
    pub(crate) kind: light_source::Type,
    pub(crate) transform: Transform,
    pub(crate) colour: [f32; 3],
    pub(crate) intensity: f32,
}

#[derive(Clone)]
pub(crate) struct ObjectSample {
    pub(crate) mesh: &'static str,
    pub(crate) transform: Transform,
    pub(crate) colour: [f32; 3],
}

#[derive(Clone)]
pub(crate) struct CameraSample {
    pub(crate) transform: Transform,
    pub(crate) near: f32,
    pub(crate) fovy: f32,
}

/// A scene to be written.
#[derive(Clone)]
pub(crate) struct Sample {
    pub(crate) meshes: Vec<MeshSample>,
    pub(crate) lights: Vec<LightSample>,
    pub(crate) objects: Vec<ObjectSample>,
    pub(crate) cameras: Vec<CameraSample>,
}

pub(crate) const UNTURNED: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

impl Sample {
    /// A flat patch in x and y from 0 to 3, lit and seen from above.
    pub(crate) fn good() -> Self {
        let points = (0..16).flat_map(|index| [(index / 4) as f32, (index % 4) as f32, 0.0]);
        Self {
            meshes: vec![MeshSample { name: "flat", kind: mesh::Type::Bezier, positions: points.collect() }],
            lights: vec![LightSample {
                kind: light_source::Type::Directional,
                transform: ([0.0; 3], UNTURNED),
                colour: [1.0, 0.5, 0.25],
                intensity: 2.0,
            }],
            objects: vec![ObjectSample {
                mesh: "flat",
                transform: ([0.0; 3], UNTURNED),
                colour: [0.5, 0.6, 0.7],
            }],
            cameras: vec![CameraSample { transform: ([1.5, 1.5, 5.0], UNTURNED), near: 0.125, fovy: 45.0 }],
        }
    }

    /// The good one, changed.
    pub(crate) fn with(change: impl FnOnce(&mut Self)) -> Self {
        let mut sample = Self::good();
        change(&mut sample);
        sample
    }

    pub(crate) fn packed(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        capnp::serialize_packed::write_message(&mut bytes, &self.message()).expect("written");
        bytes
    }

    pub(crate) fn unpacked(&self) -> Vec<u8> {
        capnp::serialize::write_message_to_words(&self.message())
    }

    fn message(&self) -> Builder<HeapAllocator> {
        let mut message = Builder::new_default();
        self.write(message.init_root());
        message
    }

    fn write(&self, mut scene: scene::Builder<'_>) {
        let mut meshes = scene.reborrow().init_meshes(self.meshes.len() as u32);
        for (index, sample) in self.meshes.iter().enumerate() {
            let mut mesh = meshes.reborrow().get(index as u32);
            mesh.set_name(sample.name);
            mesh.set_type(sample.kind);
            mesh.set_positions(&sample.positions[..]).expect("written");
        }
        let mut lights = scene.reborrow().init_lights(self.lights.len() as u32);
        for (index, sample) in self.lights.iter().enumerate() {
            let mut light = lights.reborrow().get(index as u32);
            light.set_name("a light");
            light.set_type(sample.kind);
            light.set_intensity(sample.intensity);
            write_vector(light.reborrow().init_color(), sample.colour);
            write_transform(light.init_transform(), sample.transform);
        }
        let mut objects = scene.reborrow().init_objects(self.objects.len() as u32);
        for (index, sample) in self.objects.iter().enumerate() {
            let mut object = objects.reborrow().get(index as u32);
            object.set_name("an object");
            object.set_meshname(sample.mesh);
            write_vector(object.reborrow().init_color(), sample.colour);
            write_transform(object.init_transform(), sample.transform);
        }
        let mut cameras = scene.init_cameras(self.cameras.len() as u32);
        for (index, sample) in self.cameras.iter().enumerate() {
            let mut camera = cameras.reborrow().get(index as u32);
            camera.set_name("a camera");
            camera.set_near(sample.near);
            camera.set_far(1000.0);
            camera.set_fovy(sample.fovy);
            write_transform(camera.init_transform(), sample.transform);
        }
    }
}

fn write_vector(mut vector: vec3::Builder<'_>, [x, y, z]: [f32; 3]) {
    vector.set_x(x);
    vector.set_y(y);
    vector.set_z(z);
}

fn write_transform(mut transform: transform::Builder<'_>, (translation, [r, i, j, k]): Transform) {
    write_vector(transform.reborrow().init_translation(), translation);
    let mut rotation: quaternion::Builder<'_> = transform.init_rotation();
    rotation.set_r(r);
    rotation.set_i(i);
    rotation.set_j(j);
    rotation.set_k(k);
}

/// Packs bytes, whatever they are, a word at a time.
pub(crate) fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut packed = Vec::new();
    for word in bytes.chunks_exact(8) {
        let tag = (0..8).fold(0_u8, |tag, bit| tag | u8::from(word[bit] != 0) << bit);
        packed.push(tag);
        packed.extend(word.iter().filter(|&&byte| byte != 0));
        if tag == 0x00 || tag == 0xff {
            packed.push(0);
        }
    }
    packed
}
