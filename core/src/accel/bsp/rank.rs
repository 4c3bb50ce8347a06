//! Nodes of a tree, and the places of their pieces in the order in which an eye sees them.
//!
//! Each node knows how many pieces there are on either side of its plane. So the place of its own follows from that of its
//! subtree, from the root downwards; there is no traversal, and each cell is by itself.

use bytemuck::{Pod, Zeroable};

/// A node: a plane, the pieces that lie in it, and those before and behind it. Nodes are in the order root, front, back, and
/// so are pieces.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct BspNode {
    /// The triangle whose plane it is.
    pub triangle: u32,
    /// Its own pieces: all in one plane, lower triangles first.
    pub own: u32,
    /// Pieces before the plane.
    pub front: u32,
    /// Pieces behind it.
    pub back: u32,
    /// The root of what is behind it, counted from this node; 0 if there is nothing.
    pub to_back: u32,
}

/// Puts the pieces of a tree into the order in which an eye sees them, far to near. `is_before` says for each triangle
/// whether the eye is before its plane; `first` is the first piece of the tree; `places` is as long as there are nodes, and
/// `order` as there are pieces.
#[inline]
pub fn rank(nodes: &[BspNode], is_before: &[u8], first: u32, places: &mut [u32], order: &mut [u32]) {
    if let Some(place) = places.first_mut() {
        *place = 0;
    }
    let mut piece = first;
    for (k, node) in nodes.iter().enumerate() {
        let place = places[k];
        let eye_is_before = is_before[node.triangle as usize] != 0;
        let (front, own, back) = if eye_is_before {
            (place + node.back + node.own, place + node.back, place)
        } else {
            (place, place + node.front, place + node.front + node.own)
        };
        if node.front > 0 {
            places[k + 1] = front;
        }
        if node.back > 0 {
            places[k + node.to_back as usize] = back;
        }
        // Of those in one plane, wherever the eye is, the lowest triangle is the nearest.
        for place in (own..own + node.own).rev() {
            order[place as usize] = piece;
            piece += 1;
        }
    }
}
