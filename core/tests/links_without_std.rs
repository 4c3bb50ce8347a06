//! Does core link into a program that has neither std nor an allocator? `bare/` is that program: built here,
//! then run. It renders a patch and says by its exit code whether anything was seen.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

#[test]
#[cfg_attr(
    not(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu")),
    ignore = "skipped: the program's entry point is written for x86_64 Linux with GNU tools"
)]
fn core_links_and_renders_without_std_and_allocator() {
    let program = build();
    let status = Command::new(&program).status().expect("the program starts");
    assert_eq!(status.code(), Some(0), "1: nothing was drawn, 101: a panic; the program ended with {status}");
}

/// Builds the program, from crates that are already here if possible, and returns its path.
fn build() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bare");
    let outcome = cargo_build(&target, &["--offline"]);
    let outcome = if outcome.status.success() { outcome } else { cargo_build(&target, &[]) };
    let messages = String::from_utf8_lossy(&outcome.stderr);
    assert!(outcome.status.success(), "the program cannot be built:\n{messages}");
    target.join("debug").join("bare")
}

/// Flags and targets that were chosen for the workspace do not suit a program without libraries.
fn cargo_build(target: &Path, options: &[&str]) -> Output {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bare/Cargo.toml");
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.arg("build").args(options).arg("--manifest-path").arg(manifest).arg("--target-dir").arg(target);
    for variable in ["RUSTFLAGS", "CARGO_ENCODED_RUSTFLAGS", "CARGO_BUILD_TARGET"] {
        cargo.env_remove(variable);
    }
    cargo.output().expect("cargo starts")
}
