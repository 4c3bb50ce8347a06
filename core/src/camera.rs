//! From camera, lights and transforms to the plain structs that kernels read. Host side, in f64.
//!
//! Trigonometry comes from `libm`, so that a scene gives the same bits on every platform.

use crate::abi::{
    FLAG_CULL_BACKFACES, FLAG_FIXED, FLAG_FLAT, FLAG_NAIVE, FLAG_SMOOTH, FLAG_SORT_LAST, FLAG_WEBER,
    FLAG_WHOLE, Frame, MAX_FOCAL, MAX_LEVELS, MAX_LIGHTS, MIN_NEAR, Object,
};
use crate::pattern::{Region, Samples};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World space to eye space: x right, y up, the eye looks along -z.
    pub view: DAffine3,
    /// Vertical field of view in degrees, between 0 and 180.
    pub fov: f64,
    /// Distance of the near plane.
    pub near: f64,
}

/// A light, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Parallel light, like the sun's.
    Directional {
        /// Direction from the scene to the light; need not be unit.
        to_light: DVec3,
        /// Intensity, linear RGB.
        colour: Vec3,
    },
    /// Light from a point, with no loss over distance.
    Point {
        /// Where it stands.
        position: DVec3,
        /// Intensity, linear RGB.
        colour: Vec3,
    },
}

/// What an object looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Diffuse colour, linear RGB.
    pub colour: Vec3,
    /// Strength of the highlight; 0 = none.
    pub specular: f32,
    /// The highlight is `cosine^(2^gloss)`.
    pub gloss: u32,
    /// Share of what is behind it that it hides: above 0, to 1 = all.
    pub opacity: f32,
}

/// Rules by which surfaces are culled, split and drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Profile {
    /// Conservative: nothing visible is lost ([`crate::kernel::bound`]).
    #[default]
    Conservative,
    /// As Weber's program does it, to compare with his figures: has holes ([`crate::kernel::weber`]).
    Weber2014,
}

impl Profile {
    /// Its name, on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Conservative => "conservative",
            Self::Weber2014 => "weber2014",
        }
    }

    const fn flag(self) -> u32 {
        match self {
            Self::Conservative => 0,
            Self::Weber2014 => FLAG_WEBER | FLAG_FIXED | FLAG_NAIVE,
        }
    }
}

/// When a surface is split no further.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Oracle {
    /// When it is no longer on screen than [`FrameOptions::bound`]; then it is diced into micropolygons.
    #[default]
    Size,
    /// When it is flat, to [`FrameOptions::tolerance`]; then it is one micropolygon. Splits are 1:4 (Eisenacher, Meyer &
    /// Loop 2009; Liu & Shih 2012).
    Flatness,
}

impl Oracle {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Size, Self::Flatness];

    /// Its name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Size => "size",
            Self::Flatness => "flatness",
        }
    }
}

/// How the grids of neighbouring surfaces meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Borders {
    /// They share all vertices on their common side: no cracks ([`crate::border`]).
    #[default]
    Watertight,
    /// Each is regular up to its border: cracks, to compare with.
    Naive,
    /// Naive, and every grid has as many micropolygons: as Weber 2014 dices.
    Fixed,
}

impl Borders {
    /// Its name, on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Watertight => "watertight",
            Self::Naive => "naive",
            Self::Fixed => "fixed",
        }
    }

    const fn flag(self) -> u32 {
        match self {
            Self::Watertight => 0,
            Self::Naive => FLAG_NAIVE,
            Self::Fixed => FLAG_NAIVE | FLAG_FIXED,
        }
    }
}

/// From where a colour comes within a micropolygon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// It is the mean of the vertices' colours.
    #[default]
    Flat,
    /// It is interpolated between them (Gouraud 1971); where a micropolygon is clipped it is their mean.
    Smooth,
}

impl Shading {
    /// Its name, on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Smooth => "smooth",
        }
    }

    const fn flag(self) -> u32 {
        match self {
            Self::Flat => 0,
            Self::Smooth => FLAG_SMOOTH,
        }
    }
}

/// How grids get to their samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rasteriser {
    /// Sorted into tiles, whose samples are found together ([`crate::stage::Stage::Draw`]).
    #[default]
    SortMiddle,
    /// One by one, merged without locks ([`crate::stage::Stage::SortLast`]).
    SortLast,
}

impl Rasteriser {
    /// Both of them.
    pub const ALL: [Self; 2] = [Self::SortMiddle, Self::SortLast];

    /// Its name, on the command line and in statistics.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SortMiddle => "sort-middle",
            Self::SortLast => "sort-last",
        }
    }

    const fn flag(self) -> u32 {
        match self {
            Self::SortMiddle => 0,
            Self::SortLast => FLAG_SORT_LAST,
        }
    }
}

/// How a frame is to be rendered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Largest extent of a drawn surface on screen, in pixels (Weber 2014: 8).
    pub bound: f32,
    /// Most micropolygons a side of a drawn surface: 1 to 16.
    pub rate: u32,
    /// Length of a micropolygon in pixels; they are larger where `rate` of them would not be as long as `bound`.
    pub size: f32,
    /// When a surface is split no further.
    pub oracle: Oracle,
    /// How far what is drawn may be from the surface, in pixels; of [`Oracle::Flatness`] only, which has no use for
    /// `bound`, `rate` and `size`.
    pub tolerance: f32,
    /// How the grids of neighbouring surfaces meet.
    pub borders: Borders,
    /// Levels `k`: a surface is split at most `k - 1` times (Weber 2014: 23).
    pub levels: u32,
    /// Skip grids that show only their back.
    pub cull_backfaces: bool,
    /// Nothing is culled or cut off: for a mesh that is whole ([`FLAG_WHOLE`]).
    pub whole: bool,
    /// Rules by which surfaces are culled, split and drawn.
    pub profile: Profile,
    /// Samples of a pixel.
    pub samples: Samples,
    /// From where a colour comes within a micropolygon.
    pub shading: Shading,
    /// How grids get to their samples. The image does not depend on it.
    pub rasteriser: Rasteriser,
    /// Pixels a side of a tile of the sort-middle rasteriser: a power of two from 4 to 32; 0 = as the device likes it. The
    /// image does not depend on it.
    pub tile: u32,
}

impl Default for FrameOptions {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            bound: 16.0,
            rate: 16,
            size: 1.0,
            oracle: Oracle::Size,
            tolerance: 0.5,
            borders: Borders::Watertight,
            levels: MAX_LEVELS,
            cull_backfaces: false,
            whole: false,
            profile: Profile::Conservative,
            samples: Samples::One,
            shading: Shading::Flat,
            rasteriser: Rasteriser::SortMiddle,
            tile: 0,
        }
    }
}

impl FrameOptions {
    /// Micropolygons a pixel.
    fn density(&self) -> f32 {
        let size = f64::from(self.size).max(f64::from(self.largest()) / f64::from(self.most_rate()));
        (1.0 / size) as f32
    }

    const fn flags(&self) -> u32 {
        let backfaces = if self.cull_backfaces { FLAG_CULL_BACKFACES } else { 0 };
        let whole = if self.whole { FLAG_WHOLE } else { 0 };
        let own = self.shading.flag() | self.rasteriser.flag();
        let flat = if self.is_flat() { FLAG_FLAT } else { 0 };
        self.profile.flag() | self.borders.flag() | backfaces | whole | own | flat
    }

    const fn is_flat(&self) -> bool {
        matches!(self.oracle, Oracle::Flatness)
    }

    /// What [`Frame::bound`] is.
    fn largest(&self) -> f32 {
        if self.is_flat() { self.tolerance } else { self.bound }
    }

    const fn most_rate(&self) -> u32 {
        if self.is_flat() { 1 } else { self.rate }
    }
}

impl Camera {
    /// A camera at `eye` that looks at `target`; `up` points upwards in the image.
    ///
    /// Returns `None` if `eye` and `target` coincide or `up` is along the view.
    #[must_use]
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, fov: f64, near: f64) -> Option<Self> {
        let back = (eye - target).try_normalize()?;
        let right = up.cross(back).try_normalize()?;
        let axes = DMat3::from_cols(right, back.cross(right), back).transpose();
        Some(Self { view: DAffine3::from_mat3_translation(axes, -(axes * eye)), fov, near })
    }

    /// Focal length in pixels for an image of this height.
    #[must_use]
    pub fn focal(&self, height: u32) -> f64 {
        0.5 * f64::from(height) / libm::tan(self.fov.to_radians() * 0.5)
    }

    /// Does the camera give a focal length and a near plane that kernels can work with?
    #[must_use]
    pub fn is_usable(&self, height: u32) -> bool {
        let focal = self.focal(height);
        focal > f64::from(1.0 / MAX_FOCAL)
            && focal <= f64::from(MAX_FOCAL)
            && self.near as f32 >= MIN_NEAR
            && self.near as f32 <= crate::abi::MAX_COORDINATE
    }

    /// Everything the kernels need to know; lights beyond [`MAX_LIGHTS`] are left out.
    #[must_use]
    pub fn frame(&self, options: &FrameOptions, ambient: Vec3, lights: &[Light]) -> Frame {
        let mut frame = Frame {
            width: options.width,
            height: options.height,
            focal: self.focal(options.height) as f32,
            centre_x: options.width as f32 * 0.5,
            centre_y: options.height as f32 * 0.5,
            near: self.near as f32,
            bound: options.largest(),
            levels: options.levels,
            rate: options.most_rate(),
            density: options.density(),
            around: self.around(options),
            flags: options.flags(),
            ambient: ambient.to_array(),
            ..Frame::default()
        };
        for (index, light) in lights.iter().take(MAX_LIGHTS).enumerate() {
            (frame.light_vector[index], frame.light_colour[index]) = self.light(light);
            frame.light_count = index as u32 + 1;
        }
        frame.with_region(Region::whole(options.width, options.height, options.samples), options.tile)
    }

    /// See [`Frame::around`]: the reciprocal of the largest slope in view, or a little less.
    fn around(&self, options: &FrameOptions) -> f32 {
        let half = 0.5 * f64::from(options.width.max(options.height));
        (0.999 / (half / self.focal(options.height)).max(1.0)) as f32
    }

    fn light(&self, light: &Light) -> ([f32; 4], [f32; 3]) {
        let (vector, w, colour) = match *light {
            Light::Directional { to_light, colour } => {
                (self.view.transform_vector3(to_light).normalize_or_zero(), 0.0, colour)
            }
            Light::Point { position, colour } => (self.view.transform_point3(position), 1.0, colour),
        };
        let [x, y, z] = vector.as_vec3().to_array();
        ([x, y, z, w], colour.to_array())
    }

    /// An object with its transform to eye space.
    #[must_use]
    pub fn object(&self, to_world: DAffine3, material: &Material) -> Object {
        let to_eye = self.view * to_world;
        let mut rows = [0.0; 12];
        for row in 0..3 {
            for column in 0..3 {
                rows[4 * row + column] = to_eye.matrix3.col(column)[row] as f32;
            }
            rows[4 * row + 3] = to_eye.translation[row] as f32;
        }
        let Material { colour, specular, gloss, opacity } = *material;
        Object { to_eye: rows, colour: colour.to_array(), specular, gloss, opacity, ..Object::default() }
    }
}
