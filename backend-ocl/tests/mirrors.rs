//! The kernels as a device's compiler understands them: their arguments are the stages' bindings, their structs
//! lie as core's. Their texts call nothing whose bits a device may choose.

use micropoly_backend_ocl::{Argument, OclDevice, OpenOptions, Part, Which, devices};
use micropoly_conformance::mirrors::{assert_mirrors, first_word};
use micropoly_core::abi::{Frame, LAYOUTS, Question, Sample, Shared};
use micropoly_core::backend::Device;
use micropoly_core::stage::{Access, Items, Stage};
use opencl3::context::Context;
use opencl3::device::{CL_DEVICE_TYPE_ALL, Device as ClDevice, get_all_devices};
use opencl3::kernel::{
    CL_KERNEL_ARG_ADDRESS_CONSTANT, CL_KERNEL_ARG_ADDRESS_GLOBAL, CL_KERNEL_ARG_ADDRESS_PRIVATE,
    CL_KERNEL_ARG_TYPE_CONST, Kernel,
};
use opencl3::program::Program;

/// What differs between devices: rounding, accuracy or the order of sums is theirs to choose.
const FORBIDDEN: [&str; 32] = [
    "fma",
    "mad",
    "mix",
    "dot",
    "cross",
    "length",
    "distance",
    "normalize",
    "fast_length",
    "fast_normalize",
    "fabs",
    "fmin",
    "fmax",
    "rint",
    "trunc",
    "ceil",
    "fmod",
    "pow",
    "powr",
    "exp",
    "exp2",
    "log",
    "log2",
    "sin",
    "cos",
    "tan",
    "cbrt",
    "hypot",
    "step",
    "smoothstep",
    "degrees",
    "radians",
];

/// Name and source of every kernel file, once.
fn files() -> Vec<(&'static str, &'static str)> {
    let mut files = Part::ALL.map(Part::files).concat();
    files.sort_unstable();
    files.dedup();
    files
}

/// Words that a call starts with, `name(`.
fn calls(source: &str) -> impl Iterator<Item = &str> {
    source.lines().flat_map(|line| {
        let code = line.split("//").next().unwrap_or("");
        code.match_indices('(').map(|(at, _)| {
            let before = &code[..at];
            before.rsplit(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("")
        })
    })
}

#[test]
fn no_inexact_function_is_called() {
    for (name, source) in files() {
        for call in calls(source) {
            let loose = ["native_", "half_", "convert_", "vstore_half"].iter().any(|p| call.starts_with(p));
            assert!(!loose && !FORBIDDEN.contains(&call), "{name} calls {call}");
        }
    }
}

/// Name, type, address space and whether it is constant.
type Compiled = (String, String, u32, bool);

fn argument(kernel: &Kernel, index: u32) -> Compiled {
    let constant = kernel.get_arg_type_qualifier(index).expect("known") & u64::from(CL_KERNEL_ARG_TYPE_CONST);
    (
        kernel.get_arg_name(index).expect("known"),
        kernel.get_arg_type_name(index).expect("known"),
        kernel.get_arg_address_qualifier(index).expect("known"),
        constant != 0,
    )
}

fn expected(argument: Argument) -> Compiled {
    let (name, layout, access) = match argument {
        Argument::Buffer(name, layout, access) => (name, layout, access),
        Argument::Number(name) => {
            return (name.to_owned(), "uint".to_owned(), CL_KERNEL_ARG_ADDRESS_PRIVATE, false);
        }
    };
    let kind = format!("{}*", layout.name.replace("u32", "uint").replace("f32", "float"));
    let (space, constant) = match (access, name) {
        (Access::Read, "frame" | "tess_frame") => (CL_KERNEL_ARG_ADDRESS_CONSTANT, true),
        (Access::Read, _) => (CL_KERNEL_ARG_ADDRESS_GLOBAL, true),
        (Access::Write, _) => (CL_KERNEL_ARG_ADDRESS_GLOBAL, false),
    };
    (name.to_owned(), kind, space, constant)
}

#[test]
fn arguments_are_the_bindings() {
    // Drivers are started by the backend, which lets one thread at a time do so.
    devices().expect("this test needs an OpenCL device");
    for id in get_all_devices(CL_DEVICE_TYPE_ALL).expect("devices") {
        let context = Context::from_device(&ClDevice::new(id)).expect("a context");
        let options = "-cl-std=CL1.2 -D GROUP=64u -cl-kernel-arg-info";
        for part in Part::ALL {
            let source: String = part.files().iter().map(|(_, source)| *source).collect();
            let program = Program::create_and_build_from_source(&context, &source, options).expect("builds");
            for which in Which::ALL.into_iter().filter(|which| part.has(*which)) {
                let kernel = Kernel::create(&program, which.name()).expect("a kernel of that name");
                let found: Vec<_> =
                    (0..kernel.num_args().expect("known")).map(|index| argument(&kernel, index)).collect();
                let wanted: Vec<_> = which.arguments().into_iter().map(expected).collect();
                assert_eq!(found, wanted, "{}", which.name());
            }
        }
    }
}

/// The kernels into which the stages that draw are cut take their bindings, all of them, and write none but those that
/// they write; all that they have besides is their own buffers and the number of a chunk or a turn.
#[test]
fn stages_that_draw_are_cut_along_their_bindings() {
    assert_eq!(Stage::Draw.bindings(), Stage::SortLast.bindings());
    let bindings: Vec<_> =
        Stage::Draw.bindings().iter().map(|b| Argument::Buffer(b.name, b.layout, b.access)).collect();
    let parts = Which::ALL.iter().filter(|which| !matches!(which, Which::Stage(_)));
    let mut arguments: Vec<_> = parts.flat_map(|which| which.arguments()).collect();
    for binding in &bindings {
        assert!(arguments.contains(binding), "{binding:?}");
    }
    arguments.retain(|argument| !bindings.contains(argument));
    for argument in arguments {
        let own = match argument {
            Argument::Buffer("grids" | "lists", layout, _) => layout == u32::LAYOUT,
            Argument::Buffer("keys", layout, _) => layout == Sample::LAYOUT,
            // What is written may also be read.
            Argument::Buffer(name, layout, Access::Read) => {
                bindings.contains(&Argument::Buffer(name, layout, Access::Write))
            }
            Argument::Buffer(..) => false,
            Argument::Number(name) => name == "chunk" || name == "turn",
        };
        assert!(own, "{argument:?}");
    }
}

/// A kernel that says how large every struct is, and where its fields lie and how large they are.
fn probe() -> String {
    let mut text =
        "__kernel void stage_known_answers(__constant Frame *frame, __global const Question *unused, \
                    __global uint *out, uint count) {\n"
            .to_owned();
    for layout in LAYOUTS {
        let name = layout.name;
        text += &format!(
            "{{ __global const {name} *it = (__global const {name} *)out; *out++ = sizeof({name});\n"
        );
        for field in layout.fields {
            let field = format!("it->{}", field.name);
            text +=
                &format!("*out++ = (uint)((__global const char *)&{field} - (__global const char *)it);\n");
            text += &format!("*out++ = sizeof({field});\n");
        }
        text += "}\n";
    }
    text + "}\n"
}

/// What it must say.
fn probed() -> Vec<u32> {
    let fields = |layout: &micropoly_core::abi::Layout| -> Vec<usize> {
        layout.fields.iter().flat_map(|field| [field.offset, 4 * field.count]).collect()
    };
    let all = LAYOUTS.iter().flat_map(|layout| [vec![layout.size], fields(layout)].concat());
    all.map(|size| size as u32).collect()
}

#[test]
fn structs_lie_as_core_lays_them() {
    let edit = |name: &str, source: &str| match name {
        "known_answers.cl" => probe(),
        _ => source.to_owned(),
    };
    let first = [Stage::TessControl]; // known answers are in every part
    let options =
        OpenOptions { edit: Some(&edit), skip_check: true, first: &first, ..OpenOptions::default() };
    for index in 0..devices().expect("this test needs an OpenCL device").len() {
        let mut device = OclDevice::open(index, &options).unwrap_or_else(|error| panic!("{error}"));
        let wanted = probed();
        let frame = device.allocate("frame", Frame::LAYOUT, 1).expect("memory");
        let questions = device.allocate("questions", Question::LAYOUT, 1).expect("memory");
        let answers = device.allocate("answers", u32::LAYOUT, wanted.len() as u64).expect("memory");
        device.dispatch(Stage::KnownAnswers, Items::Count(1), &[&frame, &questions, &answers]).expect("runs");
        let mut found = vec![0; wanted.len()];
        device.read(&answers, 0, &mut found).expect("reads");
        assert_eq!(found, wanted, "{}", device.name());
    }
}

#[test]
fn files_mirror_core() {
    let name_of = |line: &str| {
        let head = line.strip_prefix("static ")?.split_once('(')?.0;
        Some(first_word(head.rsplit_once(' ')?.1.trim_start_matches('*').trim_start_matches("num_")))
    };
    assert_mirrors(&files(), "cl", name_of);
}
