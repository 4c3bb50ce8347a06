//! The kernels' texts: their arguments are the stages' bindings, and they use no arithmetic but `num.cl`'s.

use micropoly_backend_ocl::FILES;
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

/// Text between the brackets after `stage_NAME`.
fn arguments(name: &str) -> Vec<String> {
    let head = format!("stage_{name}(");
    let source = FILES.iter().find_map(|(_, source)| source.split_once(&head)).expect("a kernel a stage").1;
    let list = source.split_once(')').expect("a closing bracket").0;
    list.split(',').map(|argument| argument.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn arguments_are_the_bindings() {
    for stage in Stage::ALL {
        let arguments = arguments(stage.name());
        for (binding, argument) in stage.bindings().iter().zip(&arguments) {
            let kind = binding.layout.name.replace("u32", "uint");
            let expected = match (binding.access, binding.name) {
                (Access::Read, "frame") => "__constant Frame *frame".to_owned(),
                (Access::Read, name) => format!("__global const {kind} *{name}"),
                (Access::Write, name) => format!("__global {kind} *{name}"),
            };
            assert_eq!(argument, &expected, "stage {}", stage.name());
        }
        let rest = &arguments[stage.bindings().len()..];
        assert!(rest.is_empty() || rest == ["uint count"], "stage {}: {rest:?}", stage.name());
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
        assert!(source.starts_with("// Mirrors core"), "{name}");
    }
}
