// Mirrors core/src/accel/query.rs: which leaves a frustum sees. Blocks of leaves are numbered frustum by frustum; one
// work-group a block.

// What one coordinate can add, at most.
static float farthest(uint zero, float slope, float low, float high) {
    const float steep = flush(slope);
    return max(flush(mul(steep, flush(low))), flush(mul(steep, flush(high))));
}

static bool is_before(uint zero, __global const float *plane, __global const Node *node) {
    const float x = farthest(zero, plane[0], node->low[0], node->high[0]);
    const float y = farthest(zero, plane[1], node->low[1], node->high[1]);
    const float z = farthest(zero, plane[2], node->low[2], node->high[2]);
    return add(add(add(x, y), z), flush(plane[3])) >= 0.0f;
}

static bool is_seen(uint zero, __global const Frustum *frustum, __global const Node *node) {
    for (uint plane = 0u; plane < 6u; plane++) {
        if (!is_before(zero, frustum->planes + 4u * plane, node)) {
            return false;
        }
    }
    return true;
}

static uint blocks(__global const AccelFrame *frame) {
    return (frame->count + SEE_BLOCK - 1u) / SEE_BLOCK;
}

// A work-item's leaf.
static uint leaf_of(__global const AccelFrame *frame, uint block, uint lane) {
    return block % blocks(frame) * SEE_BLOCK + lane;
}

// Does a block's frustum see it?
static bool sees_own(__global const AccelFrame *frame, __global const Node *nodes, __global const Frustum *frusta,
                     uint block, uint lane) {
    const uint leaf = leaf_of(frame, block, lane);
    __global const Frustum *frustum = frusta + block / blocks(frame);
    return leaf < frame->count && is_seen(frame->zero, frustum, nodes + frame->count - 1u + leaf);
}
