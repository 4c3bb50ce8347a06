//! All structs and constants shared with devices, declared once.
//!
//! Only `u32`, `i32`, `f32` and fixed arrays of them, so that Rust `repr(C)`, WGSL and OpenCL C agree on
//! every offset without padding rules. Each struct carries a [`Layout`] from which device headers are made.

use bytemuck::{Pod, Zeroable};

/// Value of a shared constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// An unsigned integer.
    U32(u32),
    /// A signed integer.
    I32(i32),
    /// A float.
    F32(f32),
}

/// A type that shared constants may have.
trait ConstantType {
    fn value(self) -> Value;
}

impl ConstantType for u32 {
    fn value(self) -> Value {
        Value::U32(self)
    }
}

impl ConstantType for i32 {
    fn value(self) -> Value {
        Value::I32(self)
    }
}

impl ConstantType for f32 {
    fn value(self) -> Value {
        Value::F32(self)
    }
}

/// Declares constants together with the list from which device headers are made.
macro_rules! shared_constants {
    ($($(#[$about:meta])* const $name:ident: $type:ty = $value:expr;)*) => {
        $($(#[$about])* pub const $name: $type = $value;)*

        /// Name and value of every constant shared with devices.
        pub fn constants() -> impl Iterator<Item = (&'static str, Value)> {
            [$((stringify!($name), $name.value()),)*].into_iter()
        }
    };
}

shared_constants! {
    /// Bits after the binary point of a patch parameter: `u` and `v` run from 0 to [`PARAM_ONE`].
    const PARAM_BITS: u32 = 24;
    /// The parameter value 1. Every multiple of 2⁻²⁴ in \[0, 1\], and one minus it, is exact in `f32`.
    const PARAM_ONE: u32 = 1 << PARAM_BITS;
    /// The parameter step 2⁻²⁴ as a float.
    const PARAM_STEP: f32 = 1.0 / PARAM_ONE as f32;
    /// A range is never halved more often than this along one parameter.
    const MAX_SPLITS: u32 = 20;
    /// Log2 of [`MAX_RATE`].
    const MAX_RATE_BITS: u32 = PARAM_BITS - MAX_SPLITS;
    /// Largest dice rate (micropolygons a side): a fully split range still has this many parameter steps.
    const MAX_RATE: u32 = 1 << MAX_RATE_BITS;
    /// A number of five bits, of which several are packed into a word.
    const FIVE_BITS: u32 = 31;
    /// Bits of a border word that tell how its side is divided (see [`crate::border`]).
    const SIDE_MASK: u32 = (1 << CORNER_SHIFT) - 1;
    /// Above them a border word has a corner.
    const CORNER_SHIFT: u32 = 10;
    /// Where [`Draw::shape`] has the number of micropolygons along `u`.
    const RATE_U_SHIFT: u32 = 10;
    /// Where [`Draw::shape`] has the number of micropolygons along `v`.
    const RATE_V_SHIFT: u32 = 15;
    /// Sub-pixel bits of a snapped vertex.
    const SUBPIXEL_BITS: u32 = 8;
    /// Snapped units a pixel.
    const SUBPIXELS: i32 = 1 << SUBPIXEL_BITS;
    /// Vertices farther than this from the optical axis (pixels) are clipped before they are snapped; beyond
    /// half of [`MAX_RESOLUTION`], and small enough for [`crate::num::round`].
    const GUARD_BAND: f32 = 16000.0;
    /// Rounding errors of an evaluated point stay below this share of the patch's extent in eye space
    /// (about 12 roundings of 2⁻²⁴ each, in `bound` and in `dice`).
    const ROUNDING: f32 = 1.0 / (1 << 20) as f32;
    /// Pixel offsets are limited to this magnitude before lengths are taken.
    const FAR_OFF: f32 = (1 << 20) as f32;
    /// Added to squared lengths in pixels², so that none is denormal.
    const LENGTH_TINY: f32 = 1.0 / (1_u64 << 40) as f32;
    /// A tangent shorter than this share of the patch's size is taken for vanished.
    const FLAT: f32 = 1.0 / (1 << 12) as f32;
    /// Squared sine of the angle between two tangents that are taken for parallel.
    const PARALLEL: f32 = 1.0 / (1 << 24) as f32;
    /// Largest value of an inner Bernstein weight, 3·t·(1 - t)².
    const INNER_MOST: f32 = 4.0 / 9.0;
    /// From one of four control points to the next, as a share of a parameter range.
    const THIRD: f32 = 1.0 / 3.0;
    /// Places on a piece of a line are multiples of this share of it, as a power of two: so they are the same whether it
    /// is measured in its own units or in those of a line twice as long.
    const PLACE_BITS: u32 = 12;
    /// A patch whose sides are halves of others, or halved by others, is never halved more often than this: then places on
    /// pieces of its sides are multiples of two units.
    const JOINED_SPLITS: u32 = PARAM_BITS - PLACE_BITS - 1;
    /// For each halving that a piece of a line has left, it has to be so much flatter than surfaces. Where a line has its
    /// steps already, vertices stray along it, and what they enclose is never flatter than the line: it must be flat enough
    /// all the same; and so must lines that begin there, which are shorter.
    const LINE_SHARE: f32 = 1.0 / 96.0;
    /// Smallest squared length of a vector that is normalised for shading.
    const SHADE_TINY: f32 = 1.0e-30;

    /// Where a word of [`Patch::owners`] has one more than the owner's number, above its side or corner.
    const OWNER_SHIFT: u32 = 6;
    /// Bit of a word of [`Patch::owners`]: the side is one half of the owner's; of a corner, it lies in the middle of the
    /// owner's side.
    const OWNER_IS_HALF: u32 = 16;
    /// Bit of a word of [`Patch::owners`]: the half that begins in the middle.
    const OWNER_IS_SECOND: u32 = 32;
    /// Bit of a word of [`Patch::owners`]: the owner is a corner, bits 1 and 2; else it is a side. With
    /// [`OWNER_IS_REVERSED`] it is a side that is folded: it runs back over its own points from the middle on.
    const OWNER_IS_CORNER: u32 = 8;
    /// Bit of a word of [`Patch::owners`]: the owner's side runs the other way.
    const OWNER_IS_REVERSED: u32 = 1;

    /// Of [`Patch::kind`], a bit a side: two patches lie beside it, so it is halved in any case.
    const KIND_HALVED: u32 = 15;
    /// Of [`Patch::kind`], from here on a bit a side: it is half of the side of another patch.
    const KIND_HALF_SHIFT: u32 = 4;
    /// Bit of [`Patch::kind`]: the patch is rational.
    const KIND_RATIONAL: u32 = 256;

    /// The coordinate 1 of a tessellated patch, and the level 1: both are multiples of 2⁻¹⁶.
    const TESS_UNIT: u32 = 1 << 16;
    /// Half of it.
    const TESS_HALF: u32 = TESS_UNIT / 2;
    /// The largest level.
    const MAX_TESS_LEVEL: f32 = 64.0;
    /// [`TessFrame::domain`]: patches are triangles.
    const TESS_TRIANGLES: u32 = 0;
    /// [`TessFrame::domain`]: patches are quadrilaterals.
    const TESS_QUADS: u32 = 1;
    /// [`TessFrame::domain`]: patches are rows of lines.
    const TESS_ISOLINES: u32 = 2;
    /// [`TessFrame::spacing`]: levels are rounded up, segments are equally long.
    const TESS_EQUAL: u32 = 0;
    /// [`TessFrame::spacing`]: segments are even in number, two of them shorter as the level has it.
    const TESS_EVEN: u32 = 1;
    /// [`TessFrame::spacing`]: segments are odd in number, two of them shorter as the level has it.
    const TESS_ODD: u32 = 2;
    /// Of [`TessFrame::flags`]: points are placed as in Stadlbauer 2019 and not as in Direct3D 11.
    const TESS_STADLBAUER: u32 = 1;
    /// Of [`TessFrame::flags`]: triangles are clockwise in (u, v).
    const TESS_CLOCKWISE: u32 = 2;
    /// Of [`TessFrame::flags`]: vertices are points, and there are no triangles or lines.
    const TESS_POINTS: u32 = 4;
    /// [`TessFrame::control`]: all patches have the levels [`TessFrame::outer`] and [`TessFrame::inner`].
    const TESS_CONSTANT: u32 = 0;
    /// [`TessFrame::control`]: the level of an edge is [`TessFrame::factor`] times its length over its distance from the eye.
    const TESS_LENGTH: u32 = 1;
    /// [`TessFrame::control`]: the level of an edge is [`TessFrame::factor`] over its distance from the eye.
    const TESS_DISTANCE: u32 = 2;
    /// [`TessFrame::control`]: each patch has levels of its own.
    const TESS_GIVEN: u32 = 3;
    /// [`TessFrame::evaluation`]: points of a patch lie on the plane, or the ruled surface, through its corners.
    const TESS_LINEAR: u32 = 0;
    /// [`TessFrame::evaluation`]: on its PN triangle (Vlachos et al. 2001).
    const TESS_PN: u32 = 1;
    /// [`TessFrame::evaluation`]: by Phong tessellation (Boubekeur and Alexa 2008).
    const TESS_PHONG: u32 = 2;
    /// [`TessFrame::evaluation`]: on the bicubic Bézier patch of its 16 points.
    const TESS_BEZIER: u32 = 3;
    /// [`TessFrame::evaluation`]: positions are the coordinates themselves, in units of 1.
    const TESS_COORDINATES: u32 = 4;
    /// Bits of a converted level that are the level, in units of 2⁻¹⁶.
    const LEVEL_FIXED: u32 = 0x00ff_ffff;
    /// Bit of a converted level: its number of segments is odd.
    const LEVEL_ODD: u32 = 1 << 31;
    /// Bit of a converted level: points are placed as in Stadlbauer 2019.
    const LEVEL_STADLBAUER: u32 = 1 << 30;
    /// Vertices that a work-group evaluates of a patch …
    const PIECE_VERTICES: u32 = 128;
    /// … and primitives that it lays.
    const PIECE_PRIMITIVES: u32 = 256;
    /// Most patches that are placed at once: all their vertices and indices are counted in 32 bits.
    const TESS_WINDOW: u32 = 1 << 17;

    /// Bits of a digit by which codes are sorted.
    const SORT_BITS: u32 = 4;
    /// Digits.
    const SORT_DIGITS: u32 = 1 << SORT_BITS;
    /// Keys that one invocation, or work-item, sorts …
    const SORT_RUN: u32 = 16;
    /// … and those of a group.
    const SORT_BLOCK: u32 = 64 * SORT_RUN;
    /// Leaves that a group looks at for a frustum.
    const SEE_BLOCK: u32 = 64;
    /// No node, no parent, no primitive.
    const NOTHING: u32 = u32::MAX;
    /// [`Finding::primitive`] where a device has given up before it had looked at everything.
    const UNFINISHED: u32 = NOTHING - 1;
    /// Inner nodes on the way to a leaf, at most: bits of a code, and of a place among equal ones.
    const DEEPEST: u32 = 64 + 32;

    /// Most times that bumps are added, each twice as fine as the last.
    const MAX_OCTAVES: u32 = 8;
    /// Bumps have no shape farther than so many of them from the origin.
    const LATTICE_END: f32 = (1 << 22) as f32;
    /// Of a bump's width: a point so near the side of its cell is taken to be there, so that no weight is so small that
    /// products of it reach the denormals.
    const LATTICE_NEAR: f32 = 1.0 / (1 << 20) as f32;
    /// Heights of bumps are multiples of this.
    const LATTICE_STEP: f32 = 1.0 / (1 << 23) as f32;
    /// Factors of the hash of a point of the lattice (after Teschner et al. 2003), and of the octave.
    const HASH_X: u32 = 73_856_093;
    /// See [`HASH_X`].
    const HASH_Y: u32 = 19_349_663;
    /// See [`HASH_X`].
    const HASH_Z: u32 = 83_492_791;
    /// See [`HASH_X`].
    const HASH_OCTAVE: u32 = 0x9e37_79b9;
    /// First factor that mixes a hash (Wellons 2018, "lowbias32").
    const HASH_FIRST: u32 = 0x7feb_352d;
    /// Second factor.
    const HASH_SECOND: u32 = 0x846c_a68b;

    /// Surfaces that a group of LOCAL bounds at once.
    const LOCAL_BATCH: u32 = 64;
    /// Batches that a group of LOCAL takes at most before surfaces are dealt out anew.
    const LOCAL_BATCHES: u32 = 8;
    /// Most surfaces that a group of LOCAL can draw meanwhile.
    const LOCAL_DRAWS: u32 = LOCAL_BATCH * LOCAL_BATCHES;
    /// Largest stack of a group of LOCAL: it lies in local memory, 8 KiB of it.
    const LOCAL_STACK: u32 = 256;

    /// Verdict of `bound`: not visible.
    const CULL: u32 = 0;
    /// Verdict of `bound`: small enough, to be diced.
    const DRAW: u32 = 1;
    /// Verdict of `bound`: halve the range of `u`.
    const SPLIT_U: u32 = 2;
    /// Verdict of `bound`: halve the range of `v`.
    const SPLIT_V: u32 = 3;
    /// Verdict of `bound`: would be split, but may not: drawn with what its dice rate can give.
    const DRAW_LIMITED: u32 = 4;

    /// Bit of [`Frame::flags`]: skip grids none of whose micropolygons face the eye.
    const FLAG_CULL_BACKFACES: u32 = 1;
    /// Bit of [`Frame::flags`]: bound and blend as Weber's program does, to compare with his figures.
    const FLAG_WEBER: u32 = 2;
    /// Bit of [`Frame::flags`]: every grid has [`Frame::rate`] × [`Frame::rate`] micropolygons.
    const FLAG_FIXED: u32 = 4;
    /// Bit of [`Frame::flags`]: borders are regular, whatever their neighbours have: to see the cracks.
    const FLAG_NAIVE: u32 = 8;
    /// Bit of [`Frame::flags`]: nothing is culled or cut off, for a mesh that is whole; what is out of view gets as
    /// fine as if the camera had turned to it.
    const FLAG_WHOLE: u32 = 16;
    /// Bit of [`Frame::flags`]: a colour is interpolated between the vertices of its micropolygon (Gouraud 1971), else it is
    /// their mean.
    const FLAG_SMOOTH: u32 = 32;
    /// Bit of [`Frame::flags`]: something can be seen through, so what is visible is found layer by layer.
    const FLAG_LAYERS: u32 = 64;
    /// Bit of [`Frame::flags`]: draws are sampled one by one ([`crate::stage::Stage::SortLast`]), not tile by tile.
    const FLAG_SORT_LAST: u32 = 128;
    /// Bit of [`Frame::flags`]: a surface is drawn when it is flat, as one micropolygon; [`Frame::bound`] is how far it may be
    /// off, in pixels (see [`crate::kernel::flat`]).
    const FLAG_FLAT: u32 = 256;
    /// Bit of [`Frame::flags`]: several objects have the same patches (see [`crate::patch::instance`]).
    const FLAG_INSTANCES: u32 = 512;
    /// Log2 of the sample columns (and rows) of a pixel, at most.
    const MAX_PATTERN_BITS: u32 = 3;
    /// Samples of a pixel, at most.
    const MAX_SAMPLES: u32 = 1 << (2 * MAX_PATTERN_BITS);
    /// [`Sample::depth`] behind which there is nothing: of a sample through which nothing can be seen any more.
    const OPAQUE_DEPTH: u32 = 1;
    /// Weber profile: nothing farther than this is drawn.
    const WEBER_FAR: f32 = 1000.0;
    /// Weber profile: pixels around the image in which surfaces are kept.
    const WEBER_MARGIN: f32 = 32.0;
    /// Weber profile: smallest distance, before or behind the eye, by which a coordinate is divided.
    const WEBER_TINY: f32 = 1.0e-12;
    /// Weber profile: pixel offsets are limited to this magnitude before lengths are taken.
    const WEBER_FAR_OFF: f32 = 1.0e18;
    /// Weber profile: a range is never halved more often than this, so that its middle is a parameter.
    const WEBER_SPLITS: u32 = PARAM_BITS - 1;
}

/// Largest number of levels `k`: level 0 is a whole patch, level `k - 1` is never split.
pub const MAX_LEVELS: u32 = 2 * MAX_SPLITS + 1;
/// Largest width and height of an image in pixels.
pub const MAX_RESOLUTION: u32 = 16384;
/// Largest number of lights in a frame.
pub const MAX_LIGHTS: usize = 8;
/// Largest magnitude of an eye-space coordinate; scenes beyond it are refused on the host.
pub const MAX_COORDINATE: f32 = 1.0e12;
/// Smallest distance of the near plane.
pub const MIN_NEAR: f32 = 1.0e-6;
/// Largest focal length in pixels.
pub const MAX_FOCAL: f32 = 1.0e9;

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

impl Shared for f32 {
    const LAYOUT: Layout = Layout { name: "f32", size: 4, fields: &[] };
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
    /// A bicubic patch: 16 control points in object space, index `4·i + j` with `i` along `u`; or the face
    /// points of a Gregory patch (see [`crate::patch::gregory`]), in the order of [`crate::patch::Faces`].
    struct Patch {
        /// x of the control points, in object units.
        x: [f32; 16],
        /// y of the control points, in object units.
        y: [f32; 16],
        /// z of the control points, in object units.
        z: [f32; 16],
        /// Index of the [`Object`] that the patch belongs to.
        object: u32,
        /// 0 for a Bézier patch; for a Gregory patch the index of the record that holds its face points, behind
        /// all patches: its inner control points are then the means of two face points each; for a rational patch that
        /// of the record that holds its weights, as x.
        faces: u32,
        /// `KIND_…` bits.
        kind: u32,
        /// A word a side, then a word a corner: where their vertices are evaluated, 0 = where they are (see
        /// [`crate::patch::owner`]). Only displacement looks at all of them, everything at sides that are halves of others.
        owners: [u32; 8],
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
        /// How far displacement can move a point along any axis of eye space, rounding included; 0 = there is none.
        reach: f32,
        /// Largest displacement by the coarsest bumps, object units (see [`crate::kernel::displace`]).
        height: f32,
        /// So many of them on a unit of length in object space.
        frequency: f32,
        /// How often bumps are added, twice as fine and half as high as the last.
        octaves: u32,
        /// Share of what is behind it that it hides, above 0; 1 = all.
        opacity: f32,
        /// Number of its first patch, if any objects have the same ones: then patches are numbered object by object.
        first_patch: u32,
        /// Record of its first patch.
        first_record: u32,
        /// Turns normals from object space to eye space, 3 rows of 3: the transform's cofactors, scaled.
        normal_to_eye: [f32; 9],
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
        /// Largest dice rate: a drawn surface becomes up to `rate` × `rate` micropolygons.
        rate: u32,
        /// Micropolygons a pixel, along a line: 1 / their largest length. `rate` of them are at least `bound` long.
        density: f32,
        /// A point in view is at least this share of its largest coordinate before the eye; 1 at most.
        around: f32,
        /// `FLAG_…` bits.
        flags: u32,
        /// Always 0, which only the host knows: device kernels XOR it into every float result, so that their
        /// compilers cannot fuse operations.
        zero: u32,
        /// Number of lights in use.
        light_count: u32,
        /// Light from everywhere, linear RGB.
        ambient: [f32; 3],
        /// A light each: unit direction to it (w = 0) or its position (w = 1), eye space.
        light_vector: [[f32; 4]; MAX_LIGHTS],
        /// A light each: intensity, linear RGB.
        light_colour: [[f32; 3]; MAX_LIGHTS],

        /// First column of pixels that is sampled: surfaces beside these columns and rows are culled.
        left: u32,
        /// One past the last column of pixels that is sampled.
        right: u32,
        /// First row of pixels that is sampled.
        top: u32,
        /// One past the last row of pixels that is sampled.
        bottom: u32,
        /// First column of samples. Samples lie in columns and rows, each somewhere in its own field of a square grid
        /// (see [`crate::pattern`]).
        sample_left: u32,
        /// One past the last column of samples.
        sample_right: u32,
        /// First row of samples.
        sample_top: u32,
        /// One past the last row of samples.
        sample_bottom: u32,
        /// Log2 of the snapped units from a column of samples to the next.
        pitch_bits: u32,
        /// Log2 of the columns (and rows) after which the pattern of samples repeats itself.
        pattern_bits: u32,
        /// Of each sample of the pattern, row after row: snapped units from the start of its field, to the right.
        sample_x: [i32; MAX_SAMPLES as usize],
        /// Of each sample of the pattern: snapped units from the start of its field, downwards.
        sample_y: [i32; MAX_SAMPLES as usize],
        /// The least of all `sample_x` and `sample_y`.
        least_offset: i32,
        /// The largest of them.
        most_offset: i32,
        /// Place of the first sample in the buffers of samples.
        place_first: u32,
        /// Places from a column of samples to the next.
        place_column: u32,
        /// Places from a row of samples to the next.
        place_row: u32,
        /// Log2 of the columns (and rows) of samples of a tile; 0 = as the device likes it.
        tile_bits: u32,
        /// First column of pixels that is filtered (see [`crate::kernel::filter`]).
        shown_left: u32,
        /// One past the last.
        shown_right: u32,
        /// First row of pixels that is filtered.
        shown_top: u32,
        /// One past the last.
        shown_bottom: u32,
        /// Samples that a pixel is made of.
        taps: u32,
        /// Number of objects.
        object_count: u32,
    }

    /// What all patches of a tessellation have in common.
    struct TessFrame {
        /// How many patches there are.
        patch_count: u32,
        /// `TESS_TRIANGLES`, `TESS_QUADS` or `TESS_ISOLINES`.
        domain: u32,
        /// `TESS_EQUAL`, `TESS_EVEN` or `TESS_ODD`.
        spacing: u32,
        /// `TESS_…` bits.
        flags: u32,
        /// `TESS_CONSTANT`, `TESS_LENGTH`, `TESS_DISTANCE` or `TESS_GIVEN`.
        control: u32,
        /// `TESS_LINEAR`, `TESS_PN`, `TESS_PHONG`, `TESS_BEZIER` or `TESS_COORDINATES`.
        evaluation: u32,
        /// Columns of the height map, 0 = there is none.
        columns: u32,
        /// Rows of the height map.
        rows: u32,
        /// Outer levels where they are the same for all patches.
        outer: [f32; 4],
        /// Inner levels where they are.
        inner: [f32; 2],
        /// Where the eye is, in the space of the patches.
        eye: [f32; 3],
        /// Level of an edge as long as it is far away, or at distance 1.
        factor: f32,
        /// Length along the normal of the height 1.
        scale: f32,
        /// Share of Phong tessellation in a point; the rest is linear.
        phong: f32,
        /// Always 0, which compilers cannot know.
        zero: u32,
    }

    /// A patch to be tessellated.
    struct TessPatch {
        /// Three coordinates a point. Of triangles and quadrilaterals the corners, at (u, v, w) = (1, 0, 0), (0, 1, 0) and
        /// (0, 0, 1), or (u, v) = (0, 0), (1, 0), (1, 1) and (0, 1), then from the fifth on the normals there; of Bézier
        /// patches 16 control points, index `4·i + j` with `i` along `u`. Isolines are quadrilaterals.
        points: [f32; 48],
        /// Texture coordinates of the corners.
        uv: [f32; 8],
        /// Where heights are looked up for an outer edge, its first and its last point: those of whichever of the patches
        /// that share it is its owner, so that all of them find the same.
        edges: [f32; 16],
        /// Where heights are looked up for the corners.
        corners: [f32; 8],
    }

    /// Levels of a patch as OpenGL has them: edges u = 0, v = 0, w = 0 of a triangle, u = 0, v = 0, u = 1, v = 1 of a
    /// quadrilateral; of isolines how many there are, then their segments.
    struct TessLevels {
        /// Outer levels.
        outer: [f32; 4],
        /// Inner levels: of a triangle one; of a quadrilateral along u and along v.
        inner: [f32; 2],
    }

    /// What control says of a patch, and where its mesh goes.
    struct TessRecord {
        /// Converted levels, the outer ones first (see [`crate::tess::level`]).
        levels: [u32; 6],
        /// How many vertices it has.
        vertices: u32,
        /// How many triangles or lines.
        primitives: u32,
        /// Index of the first vertex in the chunk.
        first_vertex: u32,
        /// Index of the first primitive in the chunk.
        first_primitive: u32,
        /// Number of its first piece in the chunk.
        first_piece: u32,
    }

    /// What a chunk of a tessellation comes to.
    struct TessTotals {
        /// Its first patch.
        first: u32,
        /// One past its last patch.
        end: u32,
        /// Room for vertices.
        vertex_room: u32,
        /// Room for primitives.
        primitive_room: u32,
        /// Vertices.
        vertices: u32,
        /// Triangles or lines.
        primitives: u32,
        /// Pieces.
        pieces: u32,
    }

    /// A vertex of a tessellated patch.
    struct TessVertex {
        /// Position in the space of the patches.
        position: [f32; 3],
        /// Unit normal, or zero where there is none. Heights do not turn it.
        normal: [f32; 3],
        /// Texture coordinates.
        uv: [f32; 2],
    }

    /// An axis-aligned box; `low` is above `high` where there is nothing in it.
    struct Bounds {
        /// Smallest coordinates.
        low: [f32; 3],
        /// Largest coordinates.
        high: [f32; 3],
    }

    /// A node of a tree (see [`crate::accel`]): the box about all that is below, and its children; or a leaf's primitive.
    struct Node {
        /// Smallest coordinates.
        low: [f32; 3],
        /// Largest coordinates.
        high: [f32; 3],
        /// First child; of a leaf the number of its primitive.
        first: u32,
        /// Second child; of a leaf [`NOTHING`].
        second: u32,
    }

    /// What building a tree, and asking it, goes by.
    struct AccelFrame {
        /// Primitives.
        count: u32,
        /// Bits of a coordinate in codes.
        bits: u32,
        /// Bits of a code below the digit by which it is sorted now.
        shift: u32,
        /// How many counts there are to be summed up.
        counts: u32,
        /// How many frusta, rays or points there are.
        questions: u32,
        /// Always 0, which compilers cannot know.
        zero: u32,
    }

    /// Where a primitive is on the curve through all of space.
    struct SortKey {
        /// Lower bits of the code.
        low: u32,
        /// Upper bits.
        high: u32,
        /// Whose code it is.
        primitive: u32,
    }

    /// What is within six planes.
    struct Frustum {
        /// Four numbers each (see [`crate::accel::query::Plane`]).
        planes: [f32; 24],
    }

    /// A triangle.
    struct Triangle {
        /// Its corners, three coordinates each.
        corners: [f32; 9],
    }

    /// A ray, or a point.
    struct Probe {
        /// Where it starts, or is.
        origin: [f32; 3],
        /// Where the ray goes, about 1 long.
        direction: [f32; 3],
        /// How far the ray goes, in lengths of its direction; or the square of how far to look around the point.
        far: f32,
    }

    /// What a ray hits first, or what is nearest to a point.
    struct Finding {
        /// Which primitive, [`NOTHING`] or [`UNFINISHED`]; of several at the same distance the lowest.
        primitive: u32,
        /// Where along the ray; or the distance squared. 0 where nothing is found.
        distance: f32,
    }

    /// A node of a BSP tree: a plane, the pieces that lie in it, and those before and behind it. Nodes are in the order root,
    /// front, back, and so are pieces (see [`crate::accel::bsp::rank`]).
    struct BspNode {
        /// The triangle whose plane it is.
        triangle: u32,
        /// Its own pieces: all in one plane, lower triangles first.
        own: u32,
        /// Pieces before the plane.
        front: u32,
        /// Pieces behind it.
        back: u32,
        /// The root of what is behind it, counted from this node; 0 if there is nothing.
        to_back: u32,
    }

    /// A plane of a triangle, each number in two words: `high · 2³² + low` (see [`crate::accel::bsp::plane`]).
    struct BspPlane {
        /// Lower words of its normal; they may be negative.
        low: [i32; 3],
        /// Upper words.
        high: [i32; 3],
        /// Lower word of its distance from the origin, in lengths of its normal.
        offset_low: i32,
        /// Upper word.
        offset_high: i32,
    }

    /// What putting the pieces of a BSP-grid into order goes by.
    struct BspFrame {
        /// Planes of triangles.
        planes: u32,
        /// Cells of the grid.
        cells: u32,
        /// Slabs of cells along each axis.
        slabs: [u32; 3],
        /// The slab that the eye is in, along each axis (see [`crate::accel::bsp::cells::slab_of`]).
        eye_slabs: [u32; 3],
        /// The eye, in units of the lattice: less than 2²⁹ from its origin.
        eye: [i32; 3],
        /// Always 0, which compilers cannot know.
        zero: u32,
    }

    /// A sample that a pixel is made of.
    struct Tap {
        /// Its share of the pixel; all shares together are 1.
        weight: f32,
        /// Columns of samples from the pixel's first.
        column: i32,
        /// Rows of samples from the pixel's first.
        row: i32,
    }

    /// A pixel, filtered.
    struct Pixel {
        /// Linear RGB, times coverage; and coverage.
        rgba: [f32; 4],
        /// The nearest of the pixel's own samples, as in [`Sample`].
        depth: u32,
        /// Its patch.
        patch_id: u32,
        /// Its u.
        u: u32,
        /// Its v.
        v: u32,
        /// So many of the pixel's own samples show something.
        covered: u32,
    }

    /// A sub-surface: patch and dyadic parameter range (see [`crate::surface`]).
    struct Surface {
        /// Index of the patch.
        patch_id: u32,
        /// Low end of the range of `u` in units of 2⁻²⁴.
        u: u32,
        /// Low end of the range of `v` in units of 2⁻²⁴.
        v: u32,
        /// Bits 0-4: times `u` was halved; 5-9: times `v` was; the rest is zero.
        shape: u32,
        /// A word each for side and corner 0 to 3: how the side is divided, and where the corner has strayed to
        /// (see [`crate::border`]).
        borders: [u32; 4],
    }

    /// A surface to be diced, and the pixels it can touch.
    struct Draw {
        /// Index of the patch.
        patch_id: u32,
        /// Low end of the range of `u` in units of 2⁻²⁴.
        u: u32,
        /// Low end of the range of `v` in units of 2⁻²⁴.
        v: u32,
        /// As in [`Surface`]; bits 10-14: micropolygons along `u`; 15-19: along `v`.
        shape: u32,
        /// As in [`Surface`].
        borders: [u32; 4],
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
        /// How the sides along `u` are divided (two of ten bits), and above them micropolygons along `u`.
        along_u: u32,
        /// How the sides along `v` are divided, and micropolygons along `v`.
        along_v: u32,
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
        /// Surfaces on the stack; roots that have not been taken yet are not among them.
        stack: u32,
        /// Size of the batch in flight.
        taken: u32,
        /// So many surfaces of the batch, its first ones, are roots that never lay on the stack.
        roots: u32,
        /// Position on the stack of the batch's first surface that did lie there.
        base: u32,
        /// Number of the next root: roots are taken in the order of their patches, or of the list.
        next_root: u32,
        /// Draws waiting in the draw buffer before the batch in flight.
        waiting: u32,
        /// Surfaces drawn by the batch in flight.
        fresh: u32,
        /// Largest number of surfaces that lay on the stack.
        peak: u32,
        /// Surfaces bounded since the host last asked.
        processed: u32,
        /// Surfaces culled since the host last asked.
        culled: u32,
        /// Surfaces drawn since the host last asked.
        drawn: u32,
        /// Drawn surfaces that would have been split at a deeper level, since the host last asked.
        limited: u32,
        /// Micropolygons of the drawn surfaces, since the host last asked; modulo 2³², so right for 2²⁴ - 1 draws.
        micropolygons: u32,
        /// Entries that a buffer would have needed beyond its size; 0 = everything fitted.
        overflow: u32,
        /// Which patches are roots: 0 = all of them, else those of a list.
        listed: u32,
    }

    /// A group of LOCAL, which works on a stack of its own.
    struct Group {
        /// Surfaces on its stack when a round begins.
        stack: u32,
        /// So many of them, the lowest, are roots.
        roots: u32,
        /// Number after that of its lowest root; the others follow downwards.
        next_root: u32,
        /// Batches that it may take in the round.
        batches: u32,
        /// Entries of its stack.
        room: u32,
        /// Surfaces left on its stack after the round.
        held: u32,
        /// Surfaces drawn in the round.
        draws: u32,
        /// Draws of the groups before it.
        first_draw: u32,
        /// Surfaces bounded in the round.
        processed: u32,
        /// Surfaces culled in the round.
        culled: u32,
        /// Drawn surfaces that would have been split at a deeper level, in the round.
        limited: u32,
        /// Micropolygons of the drawn surfaces, in the round.
        micropolygons: u32,
        /// Largest number of surfaces that lay on its stack in the round.
        peak: u32,
        /// Surfaces bounded since the frame began.
        load: u32,
    }

    /// One operation of the exact arithmetic and its operands, as bits.
    struct Question {
        /// Index into [`crate::kernel::known_answers::OPERATIONS`].
        operation: u32,
        /// First operand.
        a: u32,
        /// Second operand.
        b: u32,
        /// Third operand.
        c: u32,
    }

    /// Sizes that the scheduler must know on the device.
    struct Limits {
        /// Number of roots: patches of the scene, or of the list.
        patches: u32,
        /// Surfaces a batch.
        batch: u32,
        /// Entries of the stack; of LOCAL, of the stack of one group.
        stack_room: u32,
        /// Entries of the draw buffer.
        draw_room: u32,
        /// Number of levels: [`Frame::levels`].
        levels: u32,
        /// Number of groups; of LOCAL only.
        groups: u32,
    }

    /// A vertex of a mesh. Vertices at the same place of a common border have the same position, bit for bit.
    struct MeshVertex {
        /// Position in the space of the patch's object.
        position: [f32; 3],
        /// Unit normal in that space; outwards is where u runs to the right and v upwards.
        normal: [f32; 3],
        /// u and v within the patch, from 0 to 1.
        uv: [f32; 2],
        /// Index of the patch.
        patch_id: u32,
    }

    /// Where the mesh of one draw goes.
    struct MeshPlace {
        /// Its first vertex.
        vertex: u32,
        /// Its first triangle.
        triangle: u32,
    }

    /// How large a mesh is so far.
    struct MeshTotals {
        /// Its vertices.
        vertices: u32,
        /// Its triangles, those included that have collapsed.
        triangles: u32,
    }

    /// The nearest micropolygon at one sample of the image. All zero: nothing there.
    struct Sample {
        /// Bits of 1 / distance along the view axis: larger is nearer, 0 is infinitely far.
        depth: u32,
        /// Patch of the micropolygon.
        patch_id: u32,
        /// Low `u` of the micropolygon in units of 2⁻²⁴.
        u: u32,
        /// Low `v` of the micropolygon in units of 2⁻²⁴.
        v: u32,
    }

    /// Colour of one sample. All zero: nothing there.
    struct Colour {
        /// Linear RGB, and opacity.
        rgba: [f32; 4],
    }
}
