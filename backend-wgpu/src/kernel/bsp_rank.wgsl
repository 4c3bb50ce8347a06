// Mirrors core/src/accel/bsp/rank.rs: the order of all pieces. An invocation a cell; the places of nodes are among the pieces of
// their cell.

@group(0) @binding(0) var<storage, read> bsp_frame: BspFrame;
@group(0) @binding(1) var<storage, read> bsp_nodes: array<BspNode>;
@group(0) @binding(2) var<storage, read> first_nodes: array<u32>;
@group(0) @binding(3) var<storage, read> first_pieces: array<u32>;
@group(0) @binding(4) var<storage, read> is_before: array<u32>;
@group(0) @binding(5) var<storage, read> counts: array<u32>;
@group(0) @binding(6) var<storage, read_write> places: array<u32>;
@group(0) @binding(7) var<storage, read_write> order: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = bsp_frame.zero;
    let cell = item_index(group, lane);
    if cell < bsp_frame.cells {
        let start = counts[place_of(cell)];
        rank(first_nodes[cell], first_nodes[cell + 1u], first_pieces[cell], start);
        if loops_were_cut() {
            order[start] = UNFINISHED;
        }
    }
}

fn rank(first: u32, end: u32, first_piece: u32, start: u32) {
    if first < end {
        places[first] = 0u;
    }
    var piece = first_piece;
    for (var index = first; index < end; index++) {
        let node = bsp_nodes[index];
        let own = place_among(index, node);
        // Of those in one plane, wherever the eye is, the lowest triangle is the nearest.
        for (var left = node.own; left > 0u; left--) {
            order[start + own + left - 1u] = piece;
            piece++;
        }
    }
}

// Hands out the places of what is before and behind a node's plane; gives that of its own pieces.
fn place_among(index: u32, node: BspNode) -> u32 {
    let place = places[index];
    let eye_is_before = is_before[node.triangle] != 0u;
    let own = place + select(node.front, node.back, eye_is_before);
    if node.front > 0u {
        places[index + 1u] = select(place, own + node.own, eye_is_before);
    }
    if node.back > 0u {
        places[index + node.to_back] = select(own + node.own, place, eye_is_before);
    }
    return own;
}
