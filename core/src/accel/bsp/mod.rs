//! BSP-grid (Imre 2016): the pieces of a mesh's triangles in the exact order in which an eye sees them.
//!
//! A uniform grid cuts the triangles into pieces, a binary space partition tree (Fuchs, Kedem & Naylor 1980) in each cell
//! cuts them by each other's planes, and what is left is in order wherever the eye is. Nothing is rounded but the corners
//! of the mesh, once.
//!
//! | step | file |
//! |---|---|
//! | corners on a lattice of integers | `lattice.rs` |
//! | planes of triangles and between cells | `plane.rs` |
//! | sums of products that are wider than a word | `exact.rs` |
//! | a convex piece of a triangle, and what a plane makes of it | `polygon.rs` |
//! | which plane is best for a node | `choose.rs` |
//! | which is best for few pieces, exactly | `table.rs` |
//! | cells, and in which order an eye sees them | `cells.rs` |
//! | nodes of a tree, and their pieces' places in the order | `rank.rs` |
//! | the same order in a device's memory | `plan.rs` |
//! | whether the eye sees a piece along a ray | `sight.rs` |
//! | from a camera to rays, from a hit to a sample | `show.rs` |
//!
//! A piece is a triangle and the planes that cut it out. No corner that a cut makes is ever needed to draw it: a ray hits
//! the triangle, and lies on one side of each plane. So there are no seams, whatever is cut.

pub mod cells;
pub mod choose;
pub mod exact;
pub mod lattice;
pub mod plan;
pub mod plane;
pub mod polygon;
pub mod rank;
pub mod show;
pub mod sight;
pub mod table;
