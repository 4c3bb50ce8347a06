// Mirrors core/src/accel/query.rs: which leaves a frustum sees. Blocks of leaves are numbered frustum by frustum; a group a
// block.

// What one coordinate can add, at most.
fn farthest(slope: f32, low: f32, high: f32) -> f32 {
    let steep = flush(slope);
    return max(flush(mul(steep, flush(low))), flush(mul(steep, flush(high))));
}

fn is_before(frustum: u32, plane: u32, node: u32) -> bool {
    let at = 4u * plane;
    let x = farthest(frusta[frustum].planes[at], nodes[node].low[0], nodes[node].high[0]);
    let y = farthest(frusta[frustum].planes[at + 1u], nodes[node].low[1], nodes[node].high[1]);
    let z = farthest(frusta[frustum].planes[at + 2u], nodes[node].low[2], nodes[node].high[2]);
    return add(add(add(x, y), z), flush(frusta[frustum].planes[at + 3u])) >= 0.0;
}

fn is_seen(frustum: u32, node: u32) -> bool {
    for (var plane = 0u; plane < 6u; plane++) {
        if !is_before(frustum, plane, node) {
            return false;
        }
    }
    return true;
}

fn blocks() -> u32 {
    return (accel_frame.count + SEE_BLOCK - 1u) / SEE_BLOCK;
}

// An invocation's leaf.
fn leaf_of(block: u32, lane: u32) -> u32 {
    return block % blocks() * SEE_BLOCK + lane;
}

// Does a block's frustum see it?
fn sees_own(block: u32, lane: u32) -> bool {
    let leaf = leaf_of(block, lane);
    if block >= accel_frame.counts || leaf >= accel_frame.count {
        return false;
    }
    return is_seen(block / blocks(), accel_frame.count - 1u + leaf);
}
