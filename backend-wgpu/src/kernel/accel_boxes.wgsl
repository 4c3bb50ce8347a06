// Mirrors core/src/accel/tree.rs (`fit`): boxes from the leaves upwards. An invocation a leaf and number of its box.
//
// WebGPU promises nothing about the order in which groups see each other's writes, but for a single atomic word. So each number
// climbs by itself. Whoever comes first to a node leaves its number there and ends; whoever comes second takes it, in the same
// step, and climbs on with both. Whatever has to be seen by another group is in the one word that both exchange. Numbers are
// left with all bits turned round: 0, which is nobody's, would be none.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> boxes: array<Bounds>;
@group(0) @binding(2) var<storage, read> parents: array<u32>;
@group(0) @binding(3) var<storage, read_write> visits: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> nodes: array<Node>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if item >= 6u * accel_frame.count {
        return;
    }
    let word = item % 6u;
    var node = item / 6u + accel_frame.count - 1u;
    var bits = bounds_word(nodes[node].first, word);
    set_word(node, word, bits);
    while parents[node] != NOTHING {
        let parent = parents[node];
        let other = ~atomicExchange(&visits[6u * parent + word], ~bits);
        if other == ~0u {
            return;
        }
        atomicStore(&visits[6u * parent + word], 0u);
        if nodes[parent].first == node {
            bits = union_word(word, bits, other);
        } else {
            bits = union_word(word, other, bits);
        }
        set_word(parent, word, bits);
        node = parent;
    }
}

fn set_word(node: u32, word: u32, bits: u32) {
    if word < 3u {
        nodes[node].low[word] = bitcast<f32>(bits);
    } else {
        nodes[node].high[word - 3u] = bitcast<f32>(bits);
    }
}
