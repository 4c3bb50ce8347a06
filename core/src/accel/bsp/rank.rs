//! Nodes of a tree, and the places of their pieces in the order in which an eye sees them.
//!
//! Each node knows how many pieces there are on either side of its plane. So the place of its own follows from that of its
//! subtree, from the root downwards; there is no traversal, and each cell is by itself.

pub use crate::abi::BspNode;

/// Puts the pieces of a tree into the order in which an eye sees them, far to near. `is_before` says whether
/// the eye is before a triangle's plane; `first` is the first piece of the tree; `places` is as long as there are nodes, and
/// `order` as there are pieces.
#[inline]
pub fn rank(
    nodes: &[BspNode],
    is_before: impl Fn(usize) -> bool,
    first: u32,
    places: &mut [u32],
    order: &mut [u32],
) {
    if let Some(place) = places.first_mut() {
        *place = 0;
    }
    let mut piece = first;
    for (k, node) in nodes.iter().enumerate() {
        let place = places[k];
        let (front, own, back) = if is_before(node.triangle as usize) {
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
