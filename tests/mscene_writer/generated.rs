//! The generated code, which the library keeps to itself, where it expects to be: in a module `mscene`.

#[rustfmt::skip]
#[allow(clippy::all, clippy::disallowed_methods, clippy::unwrap_used)]
#[allow(missing_docs, unreachable_pub, unsafe_code, dead_code)]
#[path = "../../src/mscene/mscene_capnp.rs"]
pub(crate) mod mscene_capnp;
