//! Acceleration structures over triangles and boxes, usable without the renderer: a linear bounding volume hierarchy.
//!
//! | step | file |
//! |---|---|
//! | a box about each primitive, and about all | `bounds.rs`, `extent.rs` |
//! | where its centre is on a curve that fills space | `morton.rs` |
//! | codes in order | `sort.rs` |
//! | the binary tree over sorted codes, a node at a time (Karras 2012) | `hierarchy.rs` |
//! | boxes of inner nodes, and is the tree sound? | `tree.rs` |
//! | all that on a device, and again where primitives move | `plan.rs` |
//! | what a frustum sees | `query.rs` |
//! | what a ray hits first | `ray.rs`, `walk.rs` |
//! | what is nearest to a point | `nearest.rs`, `walk.rs` |
//!
//! There is no allocator here: callers bring the memory. A node's box, children and parent depend on the primitives alone, not
//! on who builds it in which order.

pub mod bounds;
pub mod bsp;
pub mod extent;
pub mod hierarchy;
pub mod morton;
pub mod nearest;
pub mod plan;
pub mod query;
pub mod ray;
pub mod sort;
pub mod tree;
pub mod walk;
