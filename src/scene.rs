//! A scene in memory, and how it becomes the plain structs that devices read.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use micropoly_core::abi::{FLAG_INSTANCES, FLAG_LAYERS, Frame, MAX_COORDINATE, Object, Patch};
use micropoly_core::camera::{Camera, FrameOptions, Light, Material, Oracle, Profile};
use micropoly_core::displacement::{Displacement, Unfit};

use crate::error::{Error, Result};
use crate::geometry::{self, ReadProgress, Reading};
use crate::path::CameraPath;
use crate::records::Shapes;
use crate::shape::Shape;
use crate::shot::Blur;
use crate::{mscene, rib, scene_file};

/// Patches that share a transform and a material.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObject {
    /// Its patches, in object space; others may have the same.
    pub shape: Arc<Shape>,
    /// Object space to world space.
    pub to_world: DAffine3,
    /// Its looks.
    pub material: Material,
    /// Bumps by which its vertices are moved.
    pub displacement: Option<Displacement>,
    /// How it moves.
    pub motion: Motion,
}

/// How an object moves: evenly, from where it stands at frame 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// How far from one frame to the next, in world space.
    pub translate: DVec3,
    /// Degrees from one frame to the next about axes through its origin, parallel to the world's: about x, then y, then z.
    pub rotate: DVec3,
}

impl Motion {
    /// Does it move at all?
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Where an object that stands so at frame 0 is at another.
    #[must_use]
    pub fn at(&self, to_world: DAffine3, frame: f64) -> DAffine3 {
        if self.is_none() {
            return to_world;
        }
        let turned = rotation(self.rotate * frame) * to_world.matrix3;
        DAffine3::from_mat3_translation(turned, to_world.translation + self.translate * frame)
    }
}

/// Turns by the given degrees about x, then y, then z.
pub(crate) fn rotation(degrees: DVec3) -> DMat3 {
    let turn = |axis: DVec3, degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        let column = |v: DVec3| v * cosine + axis.cross(v) * sine + axis * axis.dot(v) * (1.0 - cosine);
        DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
    };
    turn(DVec3::Z, degrees.z) * turn(DVec3::Y, degrees.y) * turn(DVec3::X, degrees.x)
}

/// All there is to see, and from where.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Where it was read from, for messages and statistics.
    pub name: String,
    /// The camera.
    pub camera: Camera,
    /// The camera's path, for frames of an animation.
    pub path: Option<CameraPath>,
    /// How long the camera looks, and through what lens.
    pub blur: Blur,
    /// Colour where nothing is, linear RGB.
    pub background: Vec3,
    /// Light from everywhere, linear RGB.
    pub ambient: Vec3,
    /// The lights; at most [`micropoly_core::abi::MAX_LIGHTS`].
    pub lights: Vec<Light>,
    /// The objects.
    pub objects: Vec<SceneObject>,
    /// What of the file is not drawn as it says, for whoever reads it.
    pub notes: Vec<String>,
}

/// A scene as devices read it.
#[derive(Clone, Debug)]
pub struct DeviceScene {
    /// Camera, lights and limits.
    pub frame: Frame,
    /// Transforms and materials.
    pub objects: Vec<Object>,
    /// Records of all patches, shape by shape, and behind them what some kinds of patches need besides.
    pub patches: Vec<Patch>,
    /// Number of patches: more than there are records of them where objects have the same ones.
    pub patch_count: usize,
}

impl SceneObject {
    /// One that stands still where it was made.
    #[must_use]
    pub fn new(shape: impl Into<Arc<Shape>>, material: Material) -> Self {
        let (to_world, displacement, motion) = (DAffine3::IDENTITY, None, Motion::default());
        Self { shape: shape.into(), to_world, material, displacement, motion }
    }

    /// Number of its patches.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.shape.patch_count()
    }

    /// The largest magnitude among the coordinates of its control points.
    fn extent(&self) -> f64 {
        self.shape.points().flatten().fold(0.0, |most: f64, c| most.max(f64::from(c.abs())))
    }

    /// Can it be displaced as it is to be?
    ///
    /// # Errors
    /// The problem, and a remedy.
    pub(crate) fn check_displacement(&self) -> std::result::Result<(), (&'static str, &'static str)> {
        let Some(displacement) = &self.displacement else { return Ok(()) };
        displacement.check(self.extent()).map_err(|unfit| match unfit {
            Unfit::Number => (
                "a displacement with numbers that are out of range",
                "height and frequency must be above 0 (1e-12 to 1e12), octaves 1 to 8",
            ),
            Unfit::Steep => {
                ("a displacement that is steeper than 1000000", "choose a smaller height or frequency")
            }
            Unfit::Fine => (
                "a displacement with more than a million bumps from the object's origin to its end",
                "choose a smaller frequency or fewer octaves",
            ),
        })
    }

    /// As devices read it.
    fn placed(&self, camera: &Camera, frame: f64) -> Object {
        let object = camera.object(self.motion.at(self.to_world, frame), &self.material);
        match &self.displacement {
            Some(displacement) => object.displaced(displacement, self.extent()),
            None => object,
        }
    }
}

/// A camera from which a box can be seen.
pub(crate) fn camera_around(low: DVec3, high: DVec3, up: DVec3) -> Result<Camera> {
    let (middle, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
    let radius = if radius > 0.0 { radius } else { 1.0 };
    let front = up.cross(DVec3::X);
    let eye = middle + (DVec3::X * 0.5 - front * 0.75 + up * 0.45).normalize() * radius * 3.0;
    Camera::look_at(eye, middle, up, 40.0, radius * 0.01)
        .ok_or_else(|| Error::scene("the patches lie too far out", "scale them down"))
}

impl Scene {
    /// Reads a scene file (`.toml`, `.mscene` or `.rib`), or a file of geometry (`.obj` or `.bpt`) with a camera that shows
    /// all of it.
    ///
    /// # Errors
    /// [`Error::Read`], [`Error::Format`] with file and line, [`Error::Content`] with file and what in it, or
    /// [`Error::Scene`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self> {
        Self::load_with(path, &Reading::default(), &|_| {})
    }

    /// As [`Scene::load`], with a say in how cages are read; `progress` is told which share of a cage has been refined.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn load_with(path: impl AsRef<Path>, reading: &Reading, progress: ReadProgress<'_>) -> Result<Self> {
        let path = path.as_ref();
        match path.extension().and_then(|extension| extension.to_str()) {
            Some(kind @ ("bpt" | "obj")) => {
                let mut notes = Vec::new();
                let shape = geometry::read(path, reading, progress, &mut notes)?;
                // What writes OBJ files takes y for up, mostly.
                let up = if kind == "obj" { DVec3::Y } else { DVec3::Z };
                Ok(Self { notes, ..Self::around_upright(path.display().to_string(), shape, up)? })
            }
            Some("toml") => scene_file::load_with(path, reading, progress),
            Some("mscene") => mscene::load(path),
            Some("rib") => rib::load_scene(path, reading.cage.levels),
            _ if !path.exists() => {
                let source = std::io::Error::from(std::io::ErrorKind::NotFound);
                Err(Error::Read { path: path.to_owned(), source })
            }
            _ => Err(Error::scene(
                format!(
                    "{}: a scene file ends in .toml, .mscene or .rib, a file of geometry in .obj or .bpt",
                    path.display()
                ),
                "rename the file, or convert it",
            )),
        }
    }

    /// A scene of one grey object, seen from the front, the right and above; z is up.
    ///
    /// # Errors
    /// [`Error::Scene`] if the patches lie too far out to be seen at all.
    pub fn around(name: String, shape: Shape) -> Result<Self> {
        Self::around_upright(name, shape, DVec3::Z)
    }

    /// The same, where another axis is up.
    fn around_upright(name: String, shape: Shape, up: DVec3) -> Result<Self> {
        let material = Material { colour: Vec3::splat(0.6), specular: 0.2, gloss: 5, opacity: 1.0 };
        let objects = vec![SceneObject::new(shape, material)];
        let (low, high) = bounds_of(&objects);
        let camera = camera_around(low, high, up)?;
        let to_light = camera.view.inverse().transform_vector3(DVec3::new(-0.5, 0.8, 0.9));
        Ok(Self {
            name,
            camera,
            path: None,
            blur: Blur::default(),
            background: Vec3::splat(0.8),
            ambient: Vec3::splat(0.15),
            lights: vec![Light::Directional { to_light, colour: Vec3::splat(0.9) }],
            objects,
            notes: Vec::new(),
        })
    }

    /// The camera at a frame of its path, which need not be whole.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is no path, or it has no such frame, or the camera looks nowhere there.
    pub fn camera_at(&self, frame: f64) -> Result<Camera> {
        self.path()?.at(frame, self.camera.near)
    }

    /// The camera's path.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is none.
    pub fn path(&self) -> Result<&CameraPath> {
        self.path.as_ref().ok_or_else(|| {
            Error::scene(
                format!("{}: the camera has no path", self.name),
                "give a scene file (.toml) two [[camera.key]] or more: see \"Scene files\" in the README",
            )
        })
    }

    /// Number of patches of all objects.
    #[must_use]
    pub fn patch_count(&self) -> usize {
        self.objects.iter().map(SceneObject::patch_count).sum()
    }

    /// Number of Gregory patches among them.
    #[must_use]
    pub fn gregory_count(&self) -> usize {
        self.objects.iter().map(|object| object.shape.gregory.len()).sum()
    }

    /// Number of rational patches among them.
    #[must_use]
    pub fn rational_count(&self) -> usize {
        self.objects.iter().map(|object| object.shape.rational.len()).sum()
    }

    /// Corners of the box around all control points, in world space.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        bounds_of(&self.objects)
    }

    /// Colours are finite and not negative; files are checked when they are read, scenes made in memory here.
    fn check_colours(&self) -> Result<()> {
        let lights = self.lights.iter().map(|light| match *light {
            Light::Directional { colour, .. } | Light::Point { colour, .. } => colour,
        });
        let materials = self.objects.iter().map(|object| object.material.colour);
        let sound = |colour: Vec3| colour.is_finite() && colour.min_element() >= 0.0;
        if lights.chain(materials).chain([self.background, self.ambient]).all(sound) {
            return Ok(());
        }
        Err(Error::scene("a colour is negative or not finite", "use values from 0"))
    }

    /// Can anything be seen through?
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.objects.iter().any(|object| object.material.opacity < 1.0)
    }

    /// Does anything move, be it the camera?
    #[must_use]
    pub fn moves(&self) -> bool {
        self.path.is_some() || self.objects_move()
    }

    /// Does any object move?
    #[must_use]
    pub fn objects_move(&self) -> bool {
        self.objects.iter().any(|object| !object.motion.is_none())
    }

    /// Is any object displaced?
    #[must_use]
    pub fn is_displaced(&self) -> bool {
        self.objects.iter().any(|object| object.displacement.is_some())
    }

    fn check_looks(&self) -> Result<()> {
        let mut opacities = self.objects.iter().map(|object| object.material.opacity);
        if opacities.all(|opacity| opacity > 0.0 && opacity <= 1.0) {
            return Ok(());
        }
        Err(Error::scene("an opacity is not above 0 and up to 1", "use 1 for what cannot be seen through"))
    }

    fn check_shapes(&self) -> Result<()> {
        if self.objects.iter().all(|object| object.shape.is_sound()) {
            return Ok(());
        }
        Err(Error::scene(
            "a shape has a weight that is not above 0, or joins sides that it does not have",
            "give every weight a number above 0",
        ))
    }

    fn check_displacements(&self, options: &FrameOptions) -> Result<()> {
        for object in &self.objects {
            object.check_displacement().map_err(|(problem, remedy)| Error::scene(problem, remedy))?;
        }
        if options.oracle == Oracle::Flatness {
            return self.check_flatness(options);
        }
        if options.profile == Profile::Weber2014 {
            return self.check_weber();
        }
        Ok(())
    }

    /// The rules of Weber's program know what its scenes have.
    fn check_weber(&self) -> Result<()> {
        let problem = if self.is_displaced() {
            "an object is displaced, which the rules of Weber's program do not know"
        } else if self.rational_count() > 0 {
            "a patch is rational, which the rules of Weber's program do not know"
        } else {
            return Ok(());
        };
        Err(Error::scene(problem, "leave out --profile weber2014, or the object"))
    }

    fn check_flatness(&self, options: &FrameOptions) -> Result<()> {
        let problem = if self.is_displaced() {
            "an object is displaced, and bumps are not looked at where surfaces are to be flat"
        } else if options.profile == Profile::Weber2014 {
            "the rules of Weber's program do not ask whether surfaces are flat"
        } else if !(options.tolerance > 0.0 && options.tolerance <= 1.0e6) {
            return Err(Error::scene(
                format!("a tolerance of {} pixels is not possible", options.tolerance),
                "choose one above 0, up to 1000000",
            ));
        } else {
            return Ok(());
        };
        Err(Error::scene(problem, "use --oracle size"))
    }

    /// The scene as devices read it.
    ///
    /// # Errors
    /// [`Error::Scene`] if there is nothing to draw, or numbers are beyond what kernels can work with.
    pub fn for_device(&self, options: &FrameOptions) -> Result<DeviceScene> {
        self.seen_from(&self.camera, options)
    }

    /// As [`Scene::for_device`], with another camera.
    pub(crate) fn seen_from(&self, camera: &Camera, options: &FrameOptions) -> Result<DeviceScene> {
        let (frame, objects) = self.view(camera, 0.0, options)?;
        let (patches, patch_count) = (self.device_patches(), self.patch_count());
        Ok(DeviceScene { frame, objects, patches, patch_count })
    }

    /// What of a scene depends on the camera and on time, in frames, as devices read it.
    ///
    /// # Errors
    /// As [`Scene::for_device`].
    pub(crate) fn view(
        &self,
        camera: &Camera,
        time: f64,
        options: &FrameOptions,
    ) -> Result<(Frame, Vec<Object>)> {
        if self.patch_count() == 0 {
            return Err(Error::scene("the scene has no patches", "add an [[object]] with geometry"));
        }
        check_options(options)?;
        self.check_colours()?;
        self.check_looks()?;
        self.check_shapes()?;
        self.check_displacements(options)?;
        if !camera.is_usable(options.height) {
            return Err(Error::scene(
                "the camera's near plane or field of view is out of range",
                "near must be 1e-6 or more, fov between 0 and 180 degrees",
            ));
        }
        let mut objects = Vec::with_capacity(self.objects.len());
        for object in &self.objects {
            let placed = object.placed(camera, time);
            check_extent(&placed, object)?;
            objects.push(placed);
        }
        let mut frame = camera.frame(options, self.ambient, &self.lights);
        if self.is_transparent() {
            frame.flags |= FLAG_LAYERS;
        }
        let shapes = Shapes::of(&self.objects);
        shapes.number(&mut objects);
        frame.object_count = objects.len() as u32;
        if shapes.are_shared() {
            frame.flags |= FLAG_INSTANCES;
        }
        Ok((frame, objects))
    }

    /// What of a scene does not.
    pub(crate) fn device_patches(&self) -> Vec<Patch> {
        Shapes::of(&self.objects).records(self.is_displaced())
    }

    /// Number of records that its patches need.
    pub(crate) fn record_count(&self) -> usize {
        Shapes::of(&self.objects).record_count()
    }
}

fn bounds_of(objects: &[SceneObject]) -> (DVec3, DVec3) {
    let mut corners = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for object in objects {
        for point in object.shape.points() {
            let point = object.to_world.transform_point3(Vec3::from(point).as_dvec3());
            corners = (corners.0.min(point), corners.1.max(point));
        }
    }
    corners
}

fn check_options(options: &FrameOptions) -> Result<()> {
    if !(1..=micropoly_core::abi::MAX_RATE).contains(&options.rate) {
        let problem = format!("a dice rate of {} is not possible", options.rate);
        return Err(Error::scene(problem, "choose 1 to 16"));
    }
    if !(options.size >= 0.01 && options.size <= 1.0e6) {
        let problem = format!("a micropolygon size of {} pixels is not possible", options.size);
        return Err(Error::scene(problem, "choose a number of pixels from 0.01 to 1000000, for example 1"));
    }
    if !(options.bound > 0.0 && options.bound <= 1.0e6) {
        let problem = format!("a bound of {} pixels is not possible", options.bound);
        return Err(Error::scene(problem, "choose a number of pixels above 0, for example 8"));
    }
    Ok(())
}

/// Refuses what would overflow in the kernels: NaN, infinities, coordinates beyond 10¹².
fn check_extent(placed: &Object, object: &SceneObject) -> Result<()> {
    let m = &placed.to_eye;
    let reach = |row: usize, [x, y, z]: [f32; 3]| {
        let parts = [m[row] * x, m[row + 1] * y, m[row + 2] * z, m[row + 3]];
        parts.iter().map(|part| f64::from(part.abs())).sum::<f64>()
    };
    for point in object.shape.points() {
        for furthest in [reach(0, point), reach(4, point), reach(8, point)] {
            let furthest = furthest + f64::from(placed.reach);
            if furthest.is_nan() || furthest > f64::from(MAX_COORDINATE) {
                let problem = format!("an object reaches {furthest:e} units from the eye; 1e12 is the limit");
                return Err(Error::scene(problem, "scale the scene down, or remove the outlying points"));
            }
        }
    }
    Ok(())
}
