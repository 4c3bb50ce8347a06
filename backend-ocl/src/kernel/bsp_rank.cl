// Mirrors core/src/accel/bsp/rank.rs: the order of all pieces. One work-item a cell; the places of nodes are among the pieces of
// their cell.

// Hands out the places of what is before and behind a node's plane; gives that of its own pieces.
static uint place_among(__global const BspNode *node, bool eye_is_before, __global uint *places) {
    const uint own = places[0] + (eye_is_before ? node->back : node->front);
    if (node->front > 0u) {
        places[1] = eye_is_before ? own + node->own : places[0];
    }
    if (node->back > 0u) {
        places[node->to_back] = eye_is_before ? places[0] : own + node->own;
    }
    return own;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_bsp_rank(__global const BspFrame *bsp_frame, __global const BspNode *bsp_nodes, __global const uint *first_nodes,
                    __global const uint *first_pieces, __global const uint *is_before, __global const uint *counts,
                    __global uint *places, __global uint *order) {
    const uint cell = get_global_id(0);
    if (cell >= bsp_frame->cells) {
        return;
    }
    const uint first = first_nodes[cell], end = first_nodes[cell + 1u];
    if (first < end) {
        places[first] = 0u;
    }
    __global uint *own_order = order + counts[place_of(bsp_frame, cell)];
    uint piece = first_pieces[cell];
    for (uint index = first; index < end; index++) {
        __global const BspNode *node = bsp_nodes + index;
        const uint own = place_among(node, is_before[node->triangle] != 0u, places + index);
        // Of those in one plane, wherever the eye is, the lowest triangle is the nearest.
        for (uint left = node->own; left > 0u; left--) {
            own_order[own + left - 1u] = piece;
            piece++;
        }
    }
}
