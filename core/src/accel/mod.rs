//! Acceleration structures over triangles and boxes, usable without the renderer: a linear bounding volume hierarchy.
//!
//! | step | file |
//! |---|---|
//! | a box about each primitive | `bounds.rs` |
//! | where its centre is on a curve that fills space | `morton.rs` |
//! | the binary tree over sorted codes, a node at a time (Karras 2012) | `hierarchy.rs` |
//! | boxes of inner nodes, and is the tree sound? | `tree.rs` |
//! | what a frustum sees | `query.rs` |
//! | what a ray hits first | `ray.rs` |
//!
//! There is no allocator here: callers bring the memory and sort the codes. A node's box, children and parent depend on the
//! primitives alone, not on who builds it in which order.

pub mod bounds;
pub mod bsp;
pub mod hierarchy;
pub mod morton;
pub mod query;
pub mod ray;
pub mod tree;
