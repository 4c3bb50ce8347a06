//! All structs and constants shared with devices, declared once.
//!
//! Only `u32`, `i32`, `f32` and fixed arrays of them, so that Rust `repr(C)`, WGSL and OpenCL C agree on
//! every offset without padding rules. Each struct carries a [`Layout`] from which device headers are made.

use bytemuck::{Pod, Zeroable};

/// Bits after the binary point of a patch parameter: `u` and `v` run from 0 to [`PARAM_ONE`].
pub const PARAM_BITS: u32 = 24;
/// The parameter value 1. Every multiple of 2⁻²⁴ in \[0, 1\], and one minus it, is exact in `f32`.
pub const PARAM_ONE: u32 = 1 << PARAM_BITS;
/// A range is never halved more often than this along one parameter.
pub const MAX_SPLITS: u32 = 20;
/// Largest dice rate (micropolygons a side): a fully split range still has this many parameter steps.
pub const MAX_RATE: u32 = 1 << (PARAM_BITS - MAX_SPLITS);
/// Largest number of levels `k`: level 0 is a whole patch, level `k - 1` is never split.
pub const MAX_LEVELS: u32 = 2 * MAX_SPLITS + 1;
/// Sub-pixel bits of a snapped vertex.
pub const SUBPIXEL_BITS: u32 = 8;
/// Snapped units a pixel.
pub const SUBPIXELS: i32 = 1 << SUBPIXEL_BITS;
/// Largest width and height of an image in pixels.
pub const MAX_RESOLUTION: u32 = 16384;
/// Vertices farther than this from the optical axis (pixels) are clipped before they are snapped; beyond
/// half of [`MAX_RESOLUTION`], and small enough for [`crate::num::round`].
pub const GUARD_BAND: f32 = 16000.0;
/// Largest number of lights in a frame.
pub const MAX_LIGHTS: usize = 8;
/// Largest magnitude of an eye-space coordinate; scenes beyond it are refused on the host.
pub const MAX_COORDINATE: f32 = 1.0e12;
/// Smallest distance of the near plane.
pub const MIN_NEAR: f32 = 1.0e-6;
/// Largest focal length in pixels.
pub const MAX_FOCAL: f32 = 1.0e9;

/// Verdict of `bound`: not visible.
pub const CULL: u32 = 0;
/// Verdict of `bound`: small enough, to be diced.
pub const DRAW: u32 = 1;
/// Verdict of `bound`: halve the range of `u`.
pub const SPLIT_U: u32 = 2;
/// Verdict of `bound`: halve the range of `v`.
pub const SPLIT_V: u32 = 3;
/// Verdict of `bound`: would be split, but may not: drawn with what its dice rate can give.
pub const DRAW_LIMITED: u32 = 4;

/// Bit of [`Frame::flags`]: skip grids none of whose micropolygons face the eye.
pub const FLAG_CULL_BACKFACES: u32 = 1;

/// Scalar type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scalar {
    /// 32-bit unsigned integer.
    U32,
    /// 32-bit signed integer.
    I32,
    /// IEEE 754 binary32.
    F32,
}

/// Name, type, length and byte offset of one field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The field's name, the same on every device.
    pub name: &'static str,
    /// Type of one element.
    pub scalar: Scalar,
    /// Number of elements; 1 for a plain scalar.
    pub count: usize,
    /// Offset from the start of the struct in bytes.
    pub offset: usize,
}

/// Memory layout of a struct or scalar as every device sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Type name, the same on every device.
    pub name: &'static str,
    /// Bytes from one array element to the next.
    pub size: usize,
    /// Fields in order; empty for a plain scalar.
    pub fields: &'static [Field],
}

/// A type that may lie in a device buffer.
pub trait Shared: Pod {
    /// How it lies there.
    const LAYOUT: Layout;
}

impl Shared for u32 {
    const LAYOUT: Layout = Layout { name: "u32", size: 4, fields: &[] };
}

/// What a field of a shared struct may be.
trait FieldType {
    const SCALAR: Scalar;
    const COUNT: usize;
}

impl FieldType for u32 {
    const SCALAR: Scalar = Scalar::U32;
    const COUNT: usize = 1;
}

impl FieldType for i32 {
    const SCALAR: Scalar = Scalar::I32;
    const COUNT: usize = 1;
}

impl FieldType for f32 {
    const SCALAR: Scalar = Scalar::F32;
    const COUNT: usize = 1;
}

impl<T: FieldType, const N: usize> FieldType for [T; N] {
    const SCALAR: Scalar = T::SCALAR;
    const COUNT: usize = N * T::COUNT;
}

/// Declares `repr(C)` structs together with their [`Layout`].
macro_rules! shared_structs {
    ($($(#[$about:meta])* struct $name:ident { $($(#[$note:meta])* $field:ident: $type:ty,)* })*) => {
        $(
            $(#[$about])*
            #[repr(C)]
            #[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
            pub struct $name { $($(#[$note])* pub $field: $type,)* }

            impl Default for $name {
                fn default() -> Self {
                    Zeroable::zeroed()
                }
            }

            impl Shared for $name {
                const LAYOUT: Layout = Layout {
                    name: stringify!($name),
                    size: size_of::<$name>(),
                    fields: &[$(Field {
                        name: stringify!($field),
                        scalar: <$type as FieldType>::SCALAR,
                        count: <$type as FieldType>::COUNT,
                        offset: core::mem::offset_of!($name, $field),
                    },)*],
                };
            }
        )*

        /// Every struct shared with devices, in order of declaration.
        pub const LAYOUTS: &[Layout] = &[$(<$name as Shared>::LAYOUT,)*];
    };
}

shared_structs! {
    /// A bicubic Bézier patch: 16 control points in object space, index `4·i + j` with `i` along `u`.
    struct Patch {
        /// x of the control points, in object units.
        x: [f32; 16],
        /// y of the control points, in object units.
        y: [f32; 16],
        /// z of the control points, in object units.
        z: [f32; 16],
        /// Index of the [`Object`] that the patch belongs to.
        object: u32,
    }

    /// Where an object stands and what it is made of.
    struct Object {
        /// Object space to eye space, 3 rows of 4 (rotation, scale | translation); the eye looks along -z.
        to_eye: [f32; 12],
        /// Diffuse colour, linear RGB.
        colour: [f32; 3],
        /// Strength of the highlight, 0 = none.
        specular: f32,
        /// The highlight is `cosine^(2^gloss)`.
        gloss: u32,
    }

    /// Everything a stage needs to know about camera, image, lights and limits.
    struct Frame {
        /// Image width in pixels.
        width: u32,
        /// Image height in pixels.
        height: u32,
        /// Focal length in pixels: half the height over the tangent of half the vertical field of view.
        focal: f32,
        /// Half the width in pixels: the x of the optical axis.
        centre_x: f32,
        /// Half the height in pixels: the y of the optical axis.
        centre_y: f32,
        /// Distance of the near plane; nothing nearer is drawn.
        near: f32,
        /// Largest extent of a drawn surface on screen, pixels.
        bound: f32,
        /// Number of levels `k`; a surface of level `k - 1` is never split.
        levels: u32,
        /// Dice rate: a drawn surface becomes `rate` × `rate` micropolygons. A power of two.
        rate: u32,
        /// `FLAG_…` bits.
        flags: u32,
        /// Number of lights in use.
        light_count: u32,
        /// Light from everywhere, linear RGB.
        ambient: [f32; 3],
        /// A light each: unit direction to it (w = 0) or its position (w = 1), eye space.
        light_vector: [[f32; 4]; MAX_LIGHTS],
        /// A light each: intensity, linear RGB.
        light_colour: [[f32; 3]; MAX_LIGHTS],
    }

    /// A sub-surface: patch and dyadic parameter range (see [`crate::surface`]).
    struct Surface {
        /// Index of the patch.
        patch: u32,
        /// Low end of the range of `u` in units of 2⁻²⁴.
        u: u32,
        /// Low end of the range of `v` in units of 2⁻²⁴.
        v: u32,
        /// Bits 0-4: times `u` was halved; 5-9: times `v` was; the rest is zero, kept for edge states.
        shape: u32,
    }

    /// A surface to be diced, and the pixels it can touch.
    struct Draw {
        /// Index of the patch.
        patch: u32,
        /// Low end of the range of `u` in units of 2⁻²⁴.
        u: u32,
        /// Low end of the range of `v` in units of 2⁻²⁴.
        v: u32,
        /// As in [`Surface`].
        shape: u32,
        /// Columns of pixels it can touch: first (low half) and one past the last (high half).
        columns: u32,
        /// Rows of pixels it can touch: first (low half) and one past the last (high half).
        rows: u32,
    }

    /// What `bound` says of a surface.
    struct Verdict {
        /// `CULL`, `DRAW`, `SPLIT_U`, `SPLIT_V` or `DRAW_LIMITED`.
        code: u32,
        /// As [`Draw::columns`]; only for drawn surfaces.
        columns: u32,
        /// As [`Draw::rows`]; only for drawn surfaces.
        rows: u32,
    }

    /// Where the output of one surface of the batch goes.
    struct Slot {
        /// Surfaces split before this one in the batch.
        splits: u32,
        /// Surfaces drawn before this one in the batch.
        draws: u32,
    }

    /// The scheduler's counts; they live on the device.
    struct Control {
        /// Surfaces on the stack.
        stack: u32,
        /// Size of the batch in flight.
        taken: u32,
        /// Position on the stack of the batch's first surface.
        base: u32,
        /// Draws waiting in the draw buffer before the batch in flight.
        waiting: u32,
        /// Surfaces drawn by the batch in flight.
        fresh: u32,
        /// Largest number of surfaces that lay on the stack.
        peak: u32,
        /// Smallest number of surfaces that lay below a batch: so many roots are untouched at most.
        low: u32,
        /// Surfaces bounded since the host last asked.
        processed: u32,
        /// Surfaces culled since the host last asked.
        culled: u32,
        /// Surfaces drawn since the host last asked.
        drawn: u32,
        /// Drawn surfaces that would have been split at a deeper level, since the host last asked.
        limited: u32,
        /// Entries that a buffer would have needed beyond its size; 0 = everything fitted.
        overflow: u32,
    }

    /// Sizes that the scheduler must know on the device.
    struct Limits {
        /// Patches of the scene.
        patches: u32,
        /// Surfaces a batch.
        batch: u32,
        /// Entries of the stack.
        stack_room: u32,
        /// Entries of the draw buffer.
        draw_room: u32,
    }

    /// The nearest micropolygon at one sample of the image. All zero: nothing there.
    struct Sample {
        /// Bits of 1 / distance along the view axis: larger is nearer, 0 is infinitely far.
        depth: u32,
        /// Patch of the micropolygon.
        patch: u32,
        /// Low corner of the micropolygon, `u` in units of 2⁻²⁴.
        u: u32,
        /// Low corner of the micropolygon, `v` in units of 2⁻²⁴.
        v: u32,
    }

    /// Colour of one sample. All zero: nothing there.
    struct Colour {
        /// Linear RGB and coverage.
        rgba: [f32; 4],
    }
}
