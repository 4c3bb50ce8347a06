//! The kernels as naga understands them: their buffers are the stages' bindings, their structs core's, they fit
//! what every WebGPU device has, and nothing in them rounds but three functions of `num.wgsl`.

use micropoly_backend_wgpu::{File, Which};
use micropoly_conformance::mirrors::{self, assert_mirrors};
use micropoly_core::abi::{LAYOUTS, Layout, Scalar};
use micropoly_core::stage::{Access, Stage};
use wgpu::naga::front::wgsl::parse_str;
use wgpu::naga::proc::GlobalCtx;
use wgpu::naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use wgpu::naga::{
    AddressSpace, ArraySize, BinaryOperator, Expression, Function, Handle, MathFunction, Module, ScalarKind,
    StorageAccess, Type, TypeInner, UnaryOperator,
};

/// What every WebGPU device allows.
const MOST_INVOCATIONS: u32 = 256;
const MOST_SHARED_BYTES: u32 = 16384;
const MOST_BUFFERS: usize = 8;

/// Built-in functions of integers, whose results no device may choose.
const EXACT: [MathFunction; 7] = [
    MathFunction::CountLeadingZeros,
    MathFunction::CountTrailingZeros,
    MathFunction::CountOneBits,
    MathFunction::FirstLeadingBit,
    MathFunction::FirstTrailingBit,
    MathFunction::ReverseBits,
    MathFunction::ExtractBits,
];

fn parse(name: &str, source: &str) -> Module {
    parse_str(source).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)))
}

/// Every kernel, as it is compiled.
fn modules() -> Vec<(Which, Module)> {
    let module = |kernel: Which| {
        let source: String = kernel.files().iter().map(|(_, source)| *source).collect();
        let module = parse(kernel.name(), &source);
        (kernel, module)
    };
    Which::ALL.into_iter().map(module).collect()
}

fn validated(name: &str, module: &Module) -> ModuleInfo {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(module).unwrap_or_else(|error| panic!("{name}: {error:?}"))
}

fn context(module: &Module) -> GlobalCtx<'_> {
    module.to_ctx()
}

/// All kernel files, each once.
fn files() -> Vec<File> {
    let mut files: Vec<File> = Which::ALL.iter().flat_map(|kernel| kernel.files().iter().copied()).collect();
    files.sort_unstable();
    files.dedup();
    files
}

#[test]
fn every_device_can_run_them() {
    for (kernel, module) in modules() {
        let name = kernel.name();
        let [entry] = module.entry_points.as_slice() else { panic!("{name}: one entry point") };
        assert_eq!(entry.name, "main", "{name}");
        let invocations: u32 = entry.workgroup_size.iter().product();
        assert!(invocations <= MOST_INVOCATIONS, "{name}: {invocations} invocations a group");
        let shared = module.global_variables.iter().filter(|(_, it)| it.space == AddressSpace::WorkGroup);
        // Sizes are multiples of all alignments but those of vectors, which add less than 16 bytes each.
        let bytes: u32 =
            shared.map(|(_, it)| module.types[it.ty].inner.size(context(&module)).next_multiple_of(16)).sum();
        assert!(bytes <= MOST_SHARED_BYTES, "{name}: {bytes} bytes of shared memory");
        assert!(kernel.bindings().len() <= MOST_BUFFERS, "{name}: {} buffers", kernel.bindings().len());
    }
}

#[test]
fn buffers_are_the_bindings() {
    for (kernel, module) in modules() {
        let mut found: Vec<_> = module
            .global_variables
            .iter()
            .filter_map(|(_, it)| it.binding.map(|place| (place.group, place.binding, it)))
            .collect();
        found.sort_by_key(|&(group, place, _)| (group, place));
        assert_eq!(found.len(), kernel.bindings().len(), "{}", kernel.name());
        for (index, ((group, place, variable), (name, access))) in
            found.into_iter().zip(&kernel.bindings()).enumerate()
        {
            assert_eq!((group, place as usize), (0, index), "{}: {name}", kernel.name());
            assert_eq!(variable.name.as_deref(), Some(*name), "{}", kernel.name());
            let expected = match access {
                Access::Read => StorageAccess::LOAD,
                Access::Write => StorageAccess::LOAD | StorageAccess::STORE,
            };
            assert_eq!(
                variable.space,
                AddressSpace::Storage { access: expected },
                "{}: {name}",
                kernel.name()
            );
            if let Some(layout) = layout_of(kernel.stages()[0], name) {
                assert_eq!(entry_name(&module, variable.ty), layout.name, "{}: {name}", kernel.name());
            }
        }
    }
}

/// Layout of a stage's buffer; those that only the backend knows have none.
fn layout_of(stage: Stage, name: &str) -> Option<Layout> {
    stage.bindings().iter().find(|binding| binding.name == name).map(|binding| binding.layout)
}

/// Name of the type of a buffer's entries.
fn entry_name(module: &Module, ty: Handle<Type>) -> String {
    match &module.types[ty] {
        Type { inner: TypeInner::Array { base, .. }, .. } => entry_name(module, *base),
        Type { name: Some(name), .. } => name.clone(),
        Type { inner: TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar), .. }
            if scalar.kind == ScalarKind::Uint =>
        {
            "u32".to_owned()
        }
        Type { inner: TypeInner::Scalar(scalar), .. } if scalar.kind == ScalarKind::Float => "f32".to_owned(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn structs_lie_as_core_lays_them() {
    let source = files().into_iter().find(|(name, _)| *name == "gen.wgsl").expect("a header").1;
    let module = parse("gen.wgsl", source);
    for layout in LAYOUTS {
        let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(layout.name));
        let Some((_, Type { inner: TypeInner::Struct { members, span }, .. })) = found else {
            panic!("no struct {}", layout.name)
        };
        assert_eq!(*span as usize, layout.size, "size of {}", layout.name);
        assert_eq!(members.len(), layout.fields.len(), "fields of {}", layout.name);
        for (member, field) in members.iter().zip(layout.fields) {
            let place = format!("{}.{}", layout.name, field.name);
            assert_eq!(member.name.as_deref(), Some(field.name), "{place}");
            assert_eq!(member.offset as usize, field.offset, "{place}");
            assert_eq!(element(&module, member.ty), (kind(field.scalar), field.count), "{place}");
        }
    }
}

fn kind(scalar: Scalar) -> ScalarKind {
    match scalar {
        Scalar::U32 => ScalarKind::Uint,
        Scalar::I32 => ScalarKind::Sint,
        Scalar::F32 => ScalarKind::Float,
    }
}

/// Scalar and number of a field's elements, which lie side by side.
fn element(module: &Module, ty: Handle<Type>) -> (ScalarKind, usize) {
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) => (scalar.kind, 1),
        TypeInner::Array { base, size: ArraySize::Constant(count), stride: 4 } => {
            (element(module, base).0, count.get() as usize)
        }
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn nothing_rounds_outside_num() {
    for (kernel, module) in modules() {
        let info = validated(kernel.name(), &module);
        for (handle, function) in module.functions.iter() {
            let name = function.name.as_deref().unwrap_or_default();
            assert_exact(kernel.name(), name, &module, function, &info[handle]);
        }
        let main = &module.entry_points[0].function;
        assert_exact(kernel.name(), "main", &module, main, info.get_entry_point(0));
    }
}

/// Fails where a function does something whose bits a device may choose.
fn assert_exact(kernel: &str, name: &str, module: &Module, function: &Function, info: &FunctionInfo) {
    let is_float = |of: &Handle<Expression>| {
        let ty = info[*of].ty.inner_with(&module.types);
        ty.scalar_kind() == Some(ScalarKind::Float)
    };
    for (_, expression) in function.expressions.iter() {
        let fault = match expression {
            Expression::Binary { op, left, right } if is_float(left) || is_float(right) => {
                !is_allowed(*op, name)
            }
            Expression::Unary { op: UnaryOperator::Negate, expr } => is_float(expr),
            Expression::Math { fun, arg, .. } => !EXACT.contains(fun) || is_float(arg),
            // `i32(x)` rounds to zero, which `floor` mends; integers that `float` is given are below 2²⁴.
            Expression::As { kind: ScalarKind::Float, expr, convert: Some(_) } => {
                !is_float(expr) && name != "float"
            }
            Expression::As { expr, convert: Some(_), .. } => is_float(expr) && name != "floor",
            Expression::Derivative { .. } => true,
            _ => false,
        };
        assert!(!fault, "kernel {kernel}, function {name}: {expression:?}");
    }
}

/// May a function do this with floats? All but comparisons must come from `num.wgsl`.
fn is_allowed(operator: BinaryOperator, function: &str) -> bool {
    match operator {
        BinaryOperator::Add => function == "add",
        BinaryOperator::Subtract => function == "sub",
        BinaryOperator::Multiply => function == "mul",
        BinaryOperator::Divide | BinaryOperator::Modulo => false,
        _ => true,
    }
}

#[test]
fn what_rounds_is_found() {
    for (body, is_fine) in [
        ("fn add(a: f32, b: f32) -> f32 { return a + b; }", true),
        ("fn less(a: f32, b: f32) -> bool { return a < b; }", true),
        ("fn f(a: u32, b: u32) -> u32 { return a / b + a; }", true),
        ("fn f(a: f32, b: f32) -> f32 { return a + b; }", false),
        ("fn f(a: vec3<f32>, b: f32) -> vec3<f32> { return b * a; }", false),
        ("fn f(a: f32) -> f32 { return -a; }", false),
        ("fn f(a: f32) -> f32 { return sqrt(a); }", false),
        ("fn f(a: f32, b: f32) -> f32 { return max(a, b); }", false),
        ("fn f(a: f32) -> i32 { return i32(a); }", false),
        ("fn f(a: u32) -> f32 { return f32(a); }", false),
        ("fn mul(a: f32, b: f32) -> f32 { return a / b; }", false),
    ] {
        let module = parse("test", body);
        let info = validated("test", &module);
        let (handle, function) = module.functions.iter().next().expect("a function");
        let name = function.name.as_deref().expect("a name");
        let found = std::panic::catch_unwind(|| assert_exact("test", name, &module, function, &info[handle]));
        assert_eq!(found.is_ok(), is_fine, "{body}");
    }
}

#[test]
fn files_mirror_core() {
    let name_of = |line: &str| line.strip_prefix("fn ").map(mirrors::first_word);
    assert_mirrors(&files(), "wgsl", name_of);
}
