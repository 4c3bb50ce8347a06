//! Each stage alone: the same input on two devices, every output compared word by word.

use std::fmt;

use micropoly_core::abi::{
    AccelFrame, Bounds, BspFrame, BspNode, BspPlane, Colour, Control, Draw, Finding, Frame, Frustum, Group,
    Layout, Limits, MeshPlace, MeshTotals, MeshVertex, Node, Object, Patch, Pixel, Probe, Question, Sample,
    Scalar, Shared, Slot, SortKey, Surface, Tap, TessFrame, TessLevels, TessPatch, TessRecord, TessTotals,
    TessVertex, Triangle, Verdict,
};
use micropoly_core::backend::Device;
use micropoly_core::stage::{Access, Items, Stage};
use serde::Serialize;

/// Input of one run of a stage: the contents of all its buffers, in the order of its bindings, as words.
#[derive(Clone, Debug)]
pub struct Input {
    /// Which stage.
    pub stage: Stage,
    /// How many items.
    pub items: Items,
    /// What the buffers hold before.
    pub buffers: Vec<Vec<u32>>,
}

/// The first word in which two devices differ.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// Name of the stage.
    pub stage: &'static str,
    /// Name of the buffer.
    pub buffer: &'static str,
    /// Index of the entry.
    pub item: usize,
    /// Name of the field, and which element of it.
    pub field: String,
    /// What the reference wrote.
    pub expected: String,
    /// What the device wrote.
    pub found: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stage, buffer, item, field, expected, found } = self;
        write!(f, "{stage}: {buffer}[{item}].{field} is {found}, should be {expected}")
    }
}

/// Contents of the buffers that a stage writes, after it ran; `None` for those it only reads.
type Outputs = Vec<Option<Vec<u32>>>;

/// Runs a stage on a device.
///
/// # Errors
/// What the device reports.
pub fn run_stage<D: Device>(device: &mut D, input: &Input) -> Result<Outputs, D::Error> {
    let bindings = input.stage.bindings();
    let mut buffers = Vec::with_capacity(bindings.len());
    for (binding, words) in bindings.iter().zip(&input.buffers) {
        let entries = (words.len() * 4 / binding.layout.size) as u64;
        let buffer = device.allocate(binding.name, binding.layout, entries)?;
        transfer::<D>(device, &buffer, binding.layout, Direction::Write(words))?;
        buffers.push(buffer);
    }
    device.dispatch(input.stage, input.items, &buffers.iter().collect::<Vec<_>>())?;
    let mut outputs = Vec::with_capacity(bindings.len());
    for ((binding, buffer), words) in bindings.iter().zip(&buffers).zip(&input.buffers) {
        outputs.push(match binding.access {
            Access::Read => None,
            Access::Write => {
                let mut after = vec![0; words.len()];
                transfer::<D>(device, buffer, binding.layout, Direction::Read(&mut after))?;
                Some(after)
            }
        });
    }
    Ok(outputs)
}

enum Direction<'a> {
    Write(&'a [u32]),
    Read(&'a mut [u32]),
}

/// Moves words between host and device as entries of the type that a layout describes.
fn transfer<D: Device>(
    device: &mut D,
    buffer: &D::Buffer,
    layout: Layout,
    direction: Direction<'_>,
) -> Result<(), D::Error> {
    macro_rules! by_name {
        ($($type:ty),*) => {
            match layout.name {
                $(name if name == <$type as Shared>::LAYOUT.name => typed::<D, $type>(device, buffer, direction),)*
                name => unreachable!("layout {name} is not in the list"),
            }
        };
    }
    by_name!(
        u32, f32, TessFrame, TessPatch, TessLevels, TessRecord, TessTotals, TessVertex, Patch, Object, Frame,
        Surface, Draw, Verdict, Slot, Control, Group, Question, Limits, Sample, Colour, MeshVertex,
        MeshPlace, MeshTotals, Tap, Pixel, AccelFrame, Bounds, Node, SortKey, Frustum, Triangle, Probe,
        Finding, BspFrame, BspNode, BspPlane
    )
}

fn typed<D: Device, T: Shared>(
    device: &mut D,
    buffer: &D::Buffer,
    direction: Direction<'_>,
) -> Result<(), D::Error> {
    match direction {
        Direction::Write(words) => device.write::<T>(buffer, bytemuck::cast_slice(words)),
        Direction::Read(words) => device.read::<T>(buffer, 0, bytemuck::cast_slice_mut(words)),
    }
}

/// The first difference between the outputs of two runs of the same input.
#[must_use]
pub fn first_difference(stage: Stage, expected: &Outputs, found: &Outputs) -> Option<Difference> {
    for ((binding, expected), found) in stage.bindings().iter().zip(expected).zip(found) {
        let (Some(expected), Some(found)) = (expected, found) else { continue };
        if let Some(at) = (0..expected.len()).find(|&at| expected[at] != found[at]) {
            let (item, field, scalar) = place(binding.layout, at);
            return Some(Difference {
                stage: stage.name(),
                buffer: binding.name,
                item,
                field,
                expected: shown(expected[at], scalar),
                found: shown(found[at], scalar),
            });
        }
    }
    None
}

/// Entry, field and type of a word of a buffer.
fn place(layout: Layout, word: usize) -> (usize, String, Scalar) {
    let (item, offset) = (word * 4 / layout.size, word * 4 % layout.size);
    let field = layout.fields.iter().rev().find(|field| field.offset <= offset);
    match field {
        Some(field) if field.count > 1 => {
            (item, format!("{}[{}]", field.name, (offset - field.offset) / 4), field.scalar)
        }
        Some(field) => (item, field.name.to_owned(), field.scalar),
        None => (item, "value".to_owned(), Scalar::U32),
    }
}

fn shown(word: u32, scalar: Scalar) -> String {
    match scalar {
        Scalar::U32 => format!("{word} ({word:#010x})"),
        Scalar::I32 => format!("{} ({word:#010x})", word as i32),
        Scalar::F32 => format!("{:e} ({word:#010x})", f32::from_bits(word)),
    }
}
