//! Device headers, made from the structs and constants that core declares once.

use std::fmt::Write;

use micropoly_core::abi::{Field, LAYOUTS, Scalar, Value, constants};

const NOTE: &str = "// Made from core/src/abi.rs; a test compares. To make it anew:\n\
                    // UPDATE_HEADERS=1 cargo test -p micropoly-conformance --test headers\n";

/// The header for WGSL.
#[must_use]
pub fn wgsl() -> String {
    let mut text = NOTE.to_owned();
    for (name, value) in constants() {
        let _ = match value {
            Value::U32(value) => writeln!(text, "const {name}: u32 = {value}u;"),
            Value::I32(value) => writeln!(text, "const {name}: i32 = {value}i;"),
            Value::F32(value) => writeln!(text, "const {name}: f32 = {value:e}f;"),
        };
    }
    for layout in LAYOUTS {
        let _ = writeln!(text, "\nstruct {} {{", layout.name);
        for Field { name, scalar, count, .. } in layout.fields {
            let scalar = match scalar {
                Scalar::U32 => "u32",
                Scalar::I32 => "i32",
                Scalar::F32 => "f32",
            };
            let _ = match count {
                1 => writeln!(text, "    {name}: {scalar},"),
                _ => writeln!(text, "    {name}: array<{scalar}, {count}>,"),
            };
        }
        text.push_str("}\n");
    }
    text
}

/// The header for OpenCL C.
#[must_use]
pub fn opencl() -> String {
    let mut text = NOTE.to_owned();
    for (name, value) in constants() {
        let _ = match value {
            Value::U32(value) => writeln!(text, "#define {name} {value}u"),
            Value::I32(value) => writeln!(text, "#define {name} {value}"),
            Value::F32(value) => writeln!(text, "#define {name} {value:e}f"),
        };
    }
    for layout in LAYOUTS {
        let _ = writeln!(text, "\ntypedef struct {{");
        for Field { name, scalar, count, .. } in layout.fields {
            let scalar = match scalar {
                Scalar::U32 => "uint",
                Scalar::I32 => "int",
                Scalar::F32 => "float",
            };
            let _ = match count {
                1 => writeln!(text, "    {scalar} {name};"),
                _ => writeln!(text, "    {scalar} {name}[{count}];"),
            };
        }
        let _ = writeln!(text, "}} {};", layout.name);
    }
    text
}
