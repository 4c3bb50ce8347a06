// Mirrors core/src/accel/hierarchy.rs, and `inner` and `link` of core/src/accel/tree.rs: children and parents. An invocation a
// node.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> keys: array<SortKey>;
@group(0) @binding(2) var<storage, read_write> nodes: array<Node>;
@group(0) @binding(3) var<storage, read_write> parents: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let index = item_index(group, lane);
    let count = accel_frame.count;
    if index == 0u {
        parents[0] = NOTHING;
    }
    if index + 1u < count {
        let span = span_of(index);
        let leaf = count - 1u;
        let first = select(span.z, leaf + span.z, span.x == span.z);
        let second = select(span.z + 1u, leaf + span.z + 1u, span.y == span.z + 1u);
        nodes[index] = node_of(first, second);
        parents[first] = index;
        parents[second] = index;
    } else if index < 2u * count - 1u {
        nodes[index] = node_of(keys[index - (count - 1u)].primitive, NOTHING);
    }
}

fn node_of(first: u32, second: u32) -> Node {
    return Node(array<f32, 3>(0.0, 0.0, 0.0), array<f32, 3>(0.0, 0.0, 0.0), first, second);
}

// How many leading bits the codes of two leaves share; -1 if there is no second one.
fn shared_bits(a: u32, b: i32) -> i32 {
    if b < 0 || b >= i32(accel_frame.count) {
        return -1;
    }
    let high = keys[a].high ^ keys[b].high;
    let low = keys[a].low ^ keys[b].low;
    if high != 0u {
        return i32(countLeadingZeros(high));
    }
    if low != 0u {
        return 32 + i32(countLeadingZeros(low));
    }
    return 64 + i32(countLeadingZeros(a ^ u32(b)));
}

// First leaf, last leaf, and last leaf of the first half of an inner node.
fn span_of(index: u32) -> vec3<u32> {
    let at = i32(index);
    let after = shared_bits(index, at + 1);
    let before = shared_bits(index, at - 1);
    // Its leaves lie on the side where they have more in common.
    let way = select(-1, 1, after > before);
    let end = at + way * leaves_beside(index, way, select(after, before, after > before));
    let first = u32(select(at, end, end < at));
    let last = u32(select(end, at, end < at));
    return vec3<u32>(first, last, split_leaves(first, last));
}

// How many leaves an inner node has besides its own.
fn leaves_beside(index: u32, way: i32, outside: i32) -> i32 {
    let at = i32(index);
    var most = 2;
    while shared_bits(index, at + most * way) > outside {
        most *= 2;
    }
    var length = 0;
    for (var step = most / 2; step > 0; step /= 2) {
        if shared_bits(index, at + (length + step) * way) > outside {
            length += step;
        }
    }
    return length;
}

// Last leaf of the first half of those from `first` to `last`.
fn split_leaves(first: u32, last: u32) -> u32 {
    let both = shared_bits(first, i32(last));
    var low = first;
    var high = last;
    while high - low > 1u {
        let middle = low + (high - low) / 2u;
        if shared_bits(first, i32(middle)) > both {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}
