//! The kernels' texts: their arguments are those of the list, which has the stages' bindings, and they use no
//! arithmetic but `num.cl`'s.

use micropoly_backend_ocl::{Argument, FILES, Which};
use micropoly_core::abi::{Layout, Shared};
use micropoly_core::stage::{Access, Stage};

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

/// Name and arguments of every kernel in the source.
fn kernels() -> Vec<(String, Vec<String>)> {
    let heads = FILES.iter().flat_map(|(_, source)| source.split("__kernel ").skip(1));
    heads
        .map(|head| {
            let (before, after) = head.split_once("void ").expect("kernels return nothing");
            let size = "__attribute__((reqd_work_group_size(GROUP, 1, 1)))";
            assert!(before.trim().is_empty() || before.trim() == size, "{before}");
            let (name, after) = after.split_once('(').expect("an opening bracket");
            let list = after.split_once(')').expect("a closing bracket").0;
            let tidy = |argument: &str| argument.split_whitespace().collect::<Vec<_>>().join(" ");
            (name.to_owned(), list.split(',').map(tidy).collect())
        })
        .collect()
}

/// How an argument is written in a kernel.
fn written(argument: Argument) -> String {
    let kind = |layout: Layout| layout.name.replace("u32", "uint");
    match argument {
        Argument::Buffer("frame", _, Access::Read) => "__constant Frame *frame".to_owned(),
        Argument::Buffer(name, layout, Access::Read) => format!("__global const {} *{name}", kind(layout)),
        Argument::Buffer(name, layout, Access::Write) => format!("__global {} *{name}", kind(layout)),
        Argument::Number(name) => format!("uint {name}"),
    }
}

#[test]
fn arguments_are_those_of_the_list() {
    let mut found = kernels();
    let mut expected: Vec<_> = Which::ALL
        .iter()
        .map(|which| {
            (which.name().to_owned(), which.arguments().into_iter().map(written).collect::<Vec<_>>())
        })
        .collect();
    found.sort();
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn every_stage_has_its_kernels() {
    for stage in Stage::ALL.into_iter().filter(|stage| *stage != Stage::Draw) {
        assert!(Which::ALL.contains(&Which::Stage(stage)), "{stage:?}");
        assert_eq!(Which::Stage(stage).name(), format!("stage_{}", stage.name()));
    }
}

/// The kernels into which the fused stage is cut take its bindings, all of them, and write none but those that
/// it writes; all that they have besides is their grids and the number of a chunk.
#[test]
fn the_fused_stage_is_cut_along_its_bindings() {
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
            Argument::Buffer(name, layout, _) => name == "grids" && layout == u32::LAYOUT,
            Argument::Number(name) => name == "chunk",
        };
        assert!(own, "{argument:?}");
    }
}

#[test]
fn no_inexact_function_is_called() {
    for (name, source) in FILES {
        for call in calls(source) {
            let loose = ["native_", "half_", "convert_", "vstore_half"].iter().any(|p| call.starts_with(p));
            assert!(!loose && !FORBIDDEN.contains(&call), "{name} calls {call}");
        }
    }
}

#[test]
fn every_file_names_what_it_mirrors() {
    for (name, source) in FILES.iter().filter(|(name, _)| *name != "gen.cl") {
        let mirrors =
            source.starts_with("// Mirrors") && source.lines().next().is_some_and(|l| l.contains("core"));
        assert!(mirrors || source.starts_with("// No mirror in core: "), "{name}");
    }
}
