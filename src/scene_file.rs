//! Scene files: TOML, written by hand. `README.md` shows every field.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use micropoly_core::abi::{MAX_LIGHTS, MIN_NEAR};
use micropoly_core::camera::{Camera, Light, Material};
use micropoly_core::displacement::Displacement;
use serde::Deserialize;
use toml::Spanned;

use crate::cage::{Boundary, MOST_LEVELS};
use crate::error::{Error, Result, line_at, read_text, utf8};
use crate::generate::{self, Generator};
use crate::geometry::{self, ReadProgress, Reading};
use crate::gregory::GregoryPatch;
use crate::image::linear_from_srgb;
use crate::path::{CameraKey, CameraPath};
use crate::scene::{Motion, Scene, SceneObject, rotation};
use crate::shape::{BezierPatch, Shape};
use crate::shot::{Blur, DEFAULT_SENSOR, Lens};

/// Most copies of an object.
const MAX_COPIES: usize = 1_000_000;

/// Most patches that the generators of a scene may make together.
const MAX_GENERATED: u64 = 10_000_000;

type Vector = Spanned<[f64; 3]>;

/// Patches written into the scene file: a list of points each.
type PatchList = Spanned<Vec<Spanned<Vec<[f64; 3]>>>>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneTable {
    camera: Spanned<CameraTable>,
    background: Option<Spanned<ColourValue>>,
    ambient: Option<Spanned<ColourValue>>,
    #[serde(default)]
    light: Vec<Spanned<LightTable>>,
    #[serde(default)]
    object: Vec<Spanned<ObjectTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraTable {
    eye: Vector,
    target: Vector,
    up: Option<Vector>,
    fov: Spanned<f64>,
    near: Spanned<f64>,
    shutter: Option<Spanned<f64>>,
    fstop: Option<Spanned<f64>>,
    focus: Option<Spanned<f64>>,
    sensor: Option<Spanned<f64>>,
    #[serde(default)]
    key: Vec<Spanned<KeyTable>>,
}

/// Where the camera is at one frame; what is left out is as in the camera's own table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct KeyTable {
    frame: Spanned<u32>,
    eye: Vector,
    target: Vector,
    up: Option<Vector>,
    fov: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LightTable {
    direction: Option<Vector>,
    position: Option<Vector>,
    colour: Option<Spanned<ColourValue>>,
    intensity: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObjectTable {
    geometry: Option<Spanned<String>>,
    patches: Option<PatchList>,
    gregory: Option<PatchList>,
    generate: Option<Spanned<GenerateTable>>,
    cc_levels: Option<Spanned<f64>>,
    boundary: Option<BoundaryValue>,
    polygons: Option<bool>,
    #[serde(default)]
    reverse: bool,
    #[serde(default)]
    copy: Vec<Spanned<PlaceTable>>,
    scale: Option<Spanned<ScaleValue>>,
    rotate: Option<Vector>,
    translate: Option<Vector>,
    colour: Option<Spanned<ColourValue>>,
    specular: Option<Spanned<f64>>,
    shininess: Option<Spanned<u32>>,
    opacity: Option<Spanned<f64>>,
    motion: Option<Spanned<MotionTable>>,
    displacement: Option<Spanned<DisplacementTable>>,
}

/// Where a copy of an object is, as seen from the object's own place.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PlaceTable {
    scale: Option<Spanned<ScaleValue>>,
    rotate: Option<Vector>,
    translate: Option<Vector>,
}

/// OpenSubdiv's names.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum BoundaryValue {
    None,
    EdgeOnly,
    EdgeAndCorner,
}

impl From<BoundaryValue> for Boundary {
    fn from(value: BoundaryValue) -> Self {
        match value {
            BoundaryValue::None => Self::None,
            BoundaryValue::EdgeOnly => Self::EdgeOnly,
            BoundaryValue::EdgeAndCorner => Self::EdgeAndCorner,
        }
    }
}

/// From one frame to the next.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionTable {
    translate: Option<Vector>,
    rotate: Option<Vector>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct DisplacementTable {
    height: f64,
    frequency: f64,
    #[serde(default = "one")]
    octaves: u32,
}

const fn one() -> u32 {
    1
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct GenerateTable {
    kind: Generator,
    count: u32,
    #[serde(default)]
    seed: u64,
}

/// `[r, g, b]`, linear; or `"#rrggbb"`, sRGB.
#[derive(Deserialize)]
#[serde(untagged)]
enum ColourValue {
    Linear([f64; 3]),
    Srgb(String),
}

#[derive(Deserialize)]
#[serde(untagged)]
enum ScaleValue {
    Uniform(f64),
    PerAxis([f64; 3]),
}

/// Reads a scene file and the files of geometry it names.
///
/// # Errors
/// [`Error::Read`] or [`Error::Format`] with file and line.
pub(crate) fn load_with(path: &Path, reading: &Reading, progress: ReadProgress<'_>) -> Result<Scene> {
    parse(path, &read_text(path)?, reading, progress)
}

/// Reads a scene from bytes; files that it names are looked for beside `path`.
///
/// # Errors
/// [`Error::Read`] or [`Error::Format`] with file and line.
pub fn parse_bytes(path: &Path, bytes: Vec<u8>) -> Result<Scene> {
    parse(path, &utf8(path, bytes)?, &Reading::default(), &|_| {})
}

fn parse(path: &Path, text: &str, reading: &Reading, progress: ReadProgress<'_>) -> Result<Scene> {
    let at = Place { path, text };
    let mut files = Files { reading, progress, known: Vec::new(), notes: Vec::new() };
    let table: SceneTable = toml::from_str(text).map_err(|error| at.syntax(&error))?;
    if let Some(extra) = table.light.get(MAX_LIGHTS) {
        return Err(at.wrong(extra, format!("there are more than {MAX_LIGHTS} lights"), "remove some"));
    }
    at.check_generated(&table.object)?;
    let mut objects = Vec::with_capacity(table.object.len());
    for object in &table.object {
        at.objects(object, &mut files, &mut objects)?;
    }
    if objects.is_empty() {
        return Err(Error::format(
            path,
            1,
            "the scene has no [[object]]",
            "add one with geometry = \"file.bpt\"",
        ));
    }
    Ok(Scene {
        name: path.display().to_string(),
        camera: at.camera(&table.camera)?,
        path: at.path(&table.camera)?,
        blur: at.blur(&table.camera)?,
        background: at.colour(table.background.as_ref(), Vec3::ZERO)?,
        ambient: at.colour(table.ambient.as_ref(), Vec3::splat(0.1))?,
        lights: table.light.iter().map(|light| at.light(light)).collect::<Result<_>>()?,
        objects,
        notes: files.notes,
    })
}

/// A file, how it is read, and whether its back becomes the front.
type FileKey = (PathBuf, Reading, bool);

/// Files of geometry that have been read so far.
struct Files<'a> {
    reading: &'a Reading,
    progress: ReadProgress<'a>,
    known: Vec<(FileKey, Arc<Shape>)>,
    notes: Vec<String>,
}

impl Files<'_> {
    fn shape(&mut self, key: FileKey) -> Result<Arc<Shape>> {
        if let Some((_, shape)) = self.known.iter().find(|(known, _)| *known == key) {
            return Ok(Arc::clone(shape));
        }
        let (path, reading, is_reversed) = &key;
        let mut shape = geometry::read(path, reading, self.progress, &mut self.notes)?;
        if *is_reversed {
            shape.reverse();
        }
        let shape = Arc::new(shape);
        self.known.push((key, Arc::clone(&shape)));
        Ok(shape)
    }
}

/// The text that is read, for messages with a line.
struct Place<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Place<'_> {
    fn wrong<T>(&self, value: &Spanned<T>, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        Error::format(self.path, line_at(self.text.as_bytes(), value.span().start), problem, remedy)
    }

    fn syntax(&self, error: &toml::de::Error) -> Error {
        let start = error.span().map_or(0, |span| span.start);
        let line = line_at(self.text.as_bytes(), start);
        let problem = error.message().replace('\n', " ");
        Error::format(self.path, line, problem, "see \"Scene files\" in the README for all fields")
    }

    fn vector(&self, value: &Vector) -> Result<DVec3> {
        let vector = DVec3::from(*value.get_ref());
        if vector.is_finite() && vector.abs().max_element() <= 1.0e12 {
            return Ok(vector);
        }
        Err(self.wrong(value, "a number here is not finite or beyond 1e12", "use smaller numbers"))
    }

    fn number(&self, value: &Spanned<f64>, what: &str, least: f64, most: f64) -> Result<f64> {
        let number = *value.get_ref();
        if number >= least && number <= most {
            return Ok(number);
        }
        let problem = format!("{what} is {number}");
        Err(self.wrong(value, problem, format!("choose a {what} from {least:?} to {most:?}")))
    }

    fn colour(&self, value: Option<&Spanned<ColourValue>>, otherwise: Vec3) -> Result<Vec3> {
        let Some(value) = value else { return Ok(otherwise) };
        let linear = match value.get_ref() {
            ColourValue::Linear(rgb) => Some(DVec3::from(*rgb)),
            ColourValue::Srgb(text) => srgb(text),
        };
        match linear {
            Some(rgb) if rgb.is_finite() && rgb.min_element() >= 0.0 && rgb.max_element() <= 1.0e6 => {
                Ok(rgb.as_vec3())
            }
            _ => Err(self.wrong(
                value,
                "this is not a colour",
                "write [r, g, b] with linear values from 0, or \"#rrggbb\" in sRGB",
            )),
        }
    }

    fn camera(&self, table: &Spanned<CameraTable>) -> Result<Camera> {
        let CameraTable { eye, target, up, fov, near, .. } = table.get_ref();
        let (up, fov) = (self.up(up.as_ref())?, self.fov(fov)?);
        let near = self.number(near, "near", f64::from(MIN_NEAR), 1.0e12)?;
        let (eye_at, target) = (self.vector(eye)?, self.vector(target)?);
        Camera::look_at(eye_at, target, up, fov, near).ok_or_else(|| self.looks_nowhere(eye))
    }

    fn up(&self, value: Option<&Vector>) -> Result<DVec3> {
        value.map_or(Ok(DVec3::Z), |up| self.vector(up))
    }

    fn fov(&self, value: &Spanned<f64>) -> Result<f64> {
        self.number(value, "fov", 0.001, 179.0)
    }

    fn looks_nowhere(&self, eye: &Vector) -> Error {
        self.wrong(eye, "the camera looks nowhere, or straight along `up`", "move eye, target or up")
    }

    /// Shutter and lens.
    fn blur(&self, table: &Spanned<CameraTable>) -> Result<Blur> {
        let CameraTable { shutter, fstop, focus, sensor, .. } = table.get_ref();
        let shutter = shutter.as_ref().map_or(Ok(0.0), |s| self.number(s, "shutter", 0.0, 1.0e6))?;
        let sensor =
            sensor.as_ref().map_or(Ok(DEFAULT_SENSOR), |s| self.number(s, "sensor", 1.0e-9, 1.0e9))?;
        let lens = match (fstop, focus) {
            (None, None) => None,
            (Some(fstop), Some(focus)) => {
                let fstop = self.number(fstop, "fstop", 1.0e-6, 1.0e9)?;
                Some(Lens { fstop, focus: self.number(focus, "focus", 1.0e-6, 1.0e12)? })
            }
            (Some(one), None) | (None, Some(one)) => {
                let problem = "a lens needs both fstop and focus (the distance that is sharp)";
                return Err(self.wrong(one, problem, "give both, or neither"));
            }
        };
        Ok(Blur { shutter, lens, sensor })
    }

    /// How an object moves.
    fn motion(&self, object: &ObjectTable) -> Result<Motion> {
        let Some(table) = &object.motion else { return Ok(Motion::default()) };
        let MotionTable { translate, rotate } = table.get_ref();
        let vector = |value: &Option<Vector>| value.as_ref().map_or(Ok(DVec3::ZERO), |v| self.vector(v));
        Ok(Motion { translate: vector(translate)?, rotate: vector(rotate)? })
    }

    /// The camera's path, if it has keys.
    fn path(&self, table: &Spanned<CameraTable>) -> Result<Option<CameraPath>> {
        let camera = table.get_ref();
        if let [only] = camera.key.as_slice() {
            let problem = "a path needs two [[camera.key]] at least";
            return Err(self.wrong(only, problem, "add another one, or remove this one"));
        }
        let mut keys: Vec<CameraKey> = Vec::with_capacity(camera.key.len());
        for key in &camera.key {
            let frame = &key.get_ref().frame;
            if let Some(last) = keys.last().map(|key| key.frame).filter(|last| last >= frame.get_ref()) {
                let problem = format!("a key at frame {} follows one at frame {last}", frame.get_ref());
                return Err(self.wrong(frame, problem, "let frames ascend from key to key"));
            }
            keys.push(self.key(key.get_ref(), camera)?);
        }
        if keys.is_empty() { Ok(None) } else { CameraPath::new(keys).map(Some) }
    }

    fn key(&self, table: &KeyTable, camera: &CameraTable) -> Result<CameraKey> {
        let KeyTable { frame, eye, target, up, fov } = table;
        let key = CameraKey {
            frame: *frame.get_ref(),
            eye: self.vector(eye)?,
            target: self.vector(target)?,
            up: self.up(up.as_ref().or(camera.up.as_ref()))?,
            fov: self.fov(fov.as_ref().unwrap_or(&camera.fov))?,
        };
        match key.camera(*camera.near.get_ref()) {
            Some(_) => Ok(key),
            None => Err(self.looks_nowhere(eye)),
        }
    }

    fn light(&self, table: &Spanned<LightTable>) -> Result<Light> {
        let LightTable { direction, position, colour, intensity } = table.get_ref();
        let colour = self.colour(colour.as_ref(), Vec3::ONE)?;
        let intensity = intensity.as_ref().map_or(Ok(1.0), |i| self.number(i, "intensity", 0.0, 1.0e6))?;
        let colour = colour * intensity as f32;
        match (direction, position) {
            (Some(direction), None) => {
                let to_light = -self.vector(direction)?;
                if to_light.try_normalize().is_none() {
                    return Err(self.wrong(direction, "the direction is zero", "say where the light goes"));
                }
                Ok(Light::Directional { to_light, colour })
            }
            (None, Some(position)) => Ok(Light::Point { position: self.vector(position)?, colour }),
            _ => Err(self.wrong(
                table,
                "a light has either a direction (in which it shines) or a position",
                "give one of the two",
            )),
        }
    }

    /// An object, and its copies.
    fn objects(
        &self,
        table: &Spanned<ObjectTable>,
        files: &mut Files<'_>,
        objects: &mut Vec<SceneObject>,
    ) -> Result<()> {
        let first = self.object(table, files)?;
        let copies = &table.get_ref().copy;
        if let Some(extra) = copies.get(MAX_COPIES) {
            return Err(self.wrong(extra, format!("there are more than {MAX_COPIES} copies"), "remove some"));
        }
        objects.reserve(1 + copies.len());
        objects.push(first.clone());
        for copy in copies {
            let PlaceTable { scale, rotate, translate } = copy.get_ref();
            let place = self.transform(scale.as_ref(), rotate.as_ref(), translate.as_ref())?;
            objects.push(SceneObject { to_world: place * first.to_world, ..first.clone() });
        }
        Ok(())
    }

    fn object(&self, table: &Spanned<ObjectTable>, files: &mut Files<'_>) -> Result<SceneObject> {
        let object = table.get_ref();
        let shape = match &object.geometry {
            Some(file) if self.has_one_shape(object) => self.geometry(file, object, files)?,
            _ => self.shape(table)?,
        };
        let ObjectTable { scale, rotate, translate, .. } = object;
        let to_world = self.transform(scale.as_ref(), rotate.as_ref(), translate.as_ref())?;
        let material = self.material(object)?;
        let displacement = object.displacement.as_ref().map(|table| {
            let DisplacementTable { height, frequency, octaves } = *table.get_ref();
            Displacement { height: height as f32, frequency: frequency as f32, octaves }
        });
        let motion = self.motion(object)?;
        let made = SceneObject { shape, to_world, material, displacement, motion };
        match (made.check_displacement(), &object.displacement) {
            (Err((problem, remedy)), Some(table)) => Err(self.wrong(table, problem, remedy)),
            _ => Ok(made),
        }
    }

    /// Is its shape told in one way only?
    fn has_one_shape(&self, object: &ObjectTable) -> bool {
        object.patches.is_none() && object.gregory.is_none() && object.generate.is_none()
    }

    /// The shape of an object that does not name a file.
    fn shape(&self, table: &Spanned<ObjectTable>) -> Result<Arc<Shape>> {
        let ObjectTable { geometry, patches, gregory, generate, reverse, .. } = table.get_ref();
        let mut shape = match (geometry, patches, gregory, generate) {
            (None, Some(list), None, None) => {
                self.inline_patches(list, |points| BezierPatch { points }).map(Shape::of_bezier)?
            }
            (None, None, Some(list), None) => {
                self.inline_patches(list, |points| GregoryPatch { points }).map(Shape::of_gregory)?
            }
            (None, None, None, Some(generator)) => self.generated(generator).map(Shape::of_bezier)?,
            _ => {
                let problem = "an object has exactly one of geometry, patches, gregory and generate";
                return Err(self.wrong(table, problem, "for example geometry = \"teapot.bpt\""));
            }
        };
        if *reverse {
            shape.reverse();
        }
        Ok(Arc::new(shape))
    }

    /// The shape in a file; objects that read the same file in the same way have the same one.
    fn geometry(
        &self,
        file: &Spanned<String>,
        object: &ObjectTable,
        files: &mut Files<'_>,
    ) -> Result<Arc<Shape>> {
        let path = self.path.parent().unwrap_or(Path::new("")).join(file.get_ref());
        if !geometry::is_known(&path) {
            let problem = format!("geometry \"{}\" is neither an .obj nor a .bpt file", file.get_ref());
            return Err(self.wrong(file, problem, "convert it to one of them"));
        }
        if !path.is_file() {
            let problem = format!("geometry \"{}\" does not exist", path.display());
            return Err(self.wrong(file, problem, "paths are relative to the scene file"));
        }
        let key = (path, self.reading(object, files.reading)?, object.reverse);
        files.shape(key)
    }

    /// How an object's file is read.
    fn reading(&self, object: &ObjectTable, otherwise: &Reading) -> Result<Reading> {
        let mut reading = *otherwise;
        if let Some(levels) = &object.cc_levels {
            let most = f64::from(MOST_LEVELS);
            reading.cage.levels = self.number(levels, "cc_levels", 0.0, most)? as u32;
        }
        reading.boundary = object.boundary.map(Boundary::from).or(reading.boundary);
        reading.polygons = object.polygons.unwrap_or(reading.polygons);
        Ok(reading)
    }

    fn inline_patches<const POINTS: usize, P>(
        &self,
        list: &PatchList,
        kind: impl Fn([[f32; 3]; POINTS]) -> P,
    ) -> Result<Vec<P>> {
        let mut patches = Vec::with_capacity(list.get_ref().len());
        for patch in list.get_ref() {
            let points: [[f64; 3]; POINTS] = patch.get_ref().as_slice().try_into().map_err(|_| {
                let problem = format!("a patch of {} points", patch.get_ref().len());
                self.wrong(patch, problem, format!("a patch of this kind has {POINTS} points"))
            })?;
            let points = points.map(|point| point.map(|value| value as f32));
            if !points.iter().flatten().all(|value| value.is_finite()) {
                return Err(self.wrong(patch, "a coordinate is not finite", "replace NaN and infinities"));
            }
            patches.push(kind(points));
        }
        if patches.is_empty() {
            return Err(self.wrong(
                list,
                "the list of patches is empty",
                format!("add a patch of {POINTS} points"),
            ));
        }
        Ok(patches)
    }

    /// Refuses more generated patches than memory is likely to hold, before any is made.
    fn check_generated(&self, objects: &[Spanned<ObjectTable>]) -> Result<()> {
        let mut total = 0;
        for table in objects.iter().filter_map(|object| object.get_ref().generate.as_ref()) {
            let GenerateTable { kind, count, .. } = *table.get_ref();
            total += u64::from(count) * u64::from(kind.patches_each());
            if total > MAX_GENERATED {
                let problem =
                    format!("with count = {count} the scene has more than {MAX_GENERATED} generated patches");
                return Err(self.wrong(table, problem, "choose a smaller count"));
            }
        }
        Ok(())
    }

    fn generated(&self, table: &Spanned<GenerateTable>) -> Result<Vec<BezierPatch>> {
        let GenerateTable { kind, count, seed } = *table.get_ref();
        if count == 0 {
            return Err(self.wrong(table, "count = 0 makes no patches", "choose another count"));
        }
        Ok(generate::generate(kind, count, seed))
    }

    fn transform(
        &self,
        scale: Option<&Spanned<ScaleValue>>,
        rotate: Option<&Vector>,
        translate: Option<&Vector>,
    ) -> Result<DAffine3> {
        let factors = match scale.map(Spanned::get_ref) {
            None => DVec3::ONE,
            Some(&ScaleValue::Uniform(factor)) => DVec3::splat(factor),
            Some(&ScaleValue::PerAxis(factors)) => DVec3::from(factors),
        };
        if let Some(value) = scale
            && !(factors.is_finite() && factors.abs().max_element() <= 1.0e12)
        {
            return Err(self.wrong(value, "the scale is not finite or beyond 1e12", "use a smaller number"));
        }
        let angles = rotate.map_or(Ok(DVec3::ZERO), |rotate| self.vector(rotate))?;
        let translation = translate.map_or(Ok(DVec3::ZERO), |translate| self.vector(translate))?;
        Ok(DAffine3::from_mat3_translation(rotation(angles) * DMat3::from_diagonal(factors), translation))
    }

    fn material(&self, object: &ObjectTable) -> Result<Material> {
        let specular =
            object.specular.as_ref().map_or(Ok(0.0), |s| self.number(s, "specular", 0.0, 1.0e3))?;
        let shininess = object.shininess.as_ref().map_or(32, |shininess| *shininess.get_ref());
        if let Some(value) = &object.shininess
            && !(shininess.is_power_of_two() && shininess <= 1024)
        {
            let problem = format!("shininess is {shininess}");
            return Err(self.wrong(value, problem, "choose a power of two from 1 to 1024"));
        }
        let colour = self.colour(object.colour.as_ref(), Vec3::splat(0.6))?;
        let opacity = object.opacity.as_ref().map_or(Ok(1.0), |o| self.number(o, "opacity", 0.001, 1.0))?;
        let (specular, opacity) = (specular as f32, opacity as f32);
        Ok(Material { colour, specular, gloss: shininess.trailing_zeros(), opacity })
    }
}

/// Linear RGB of `#rrggbb`.
fn srgb(text: &str) -> Option<DVec3> {
    let is_hex = |digits: &&str| digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let digits = text.strip_prefix('#').filter(is_hex)?;
    let channel = |at: usize| {
        let value = u8::from_str_radix(&digits[at..at + 2], 16).ok()?;
        Some(linear_from_srgb(f64::from(value) / 255.0))
    };
    Some(DVec3::new(channel(0)?, channel(2)?, channel(4)?))
}
