//! The device headers in the repository are those that core's declarations make.

use std::path::Path;

use micropoly_conformance::headers;

fn compare(path: &str, expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    if std::env::var_os("UPDATE_HEADERS").is_some() {
        std::fs::write(&path, expected).expect("written");
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "{} is out of date: UPDATE_HEADERS=1 makes it anew", path.display());
}

#[test]
fn wgsl_header_is_up_to_date() {
    compare("backend-wgpu/src/kernel/gen.wgsl", &headers::wgsl());
}

#[test]
fn opencl_header_is_up_to_date() {
    compare("backend-ocl/src/kernel/gen.cl", &headers::opencl());
}
