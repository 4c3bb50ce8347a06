// Mirrors core/src/accel/hierarchy.rs, and `inner` and `link` of core/src/accel/tree.rs: children and parents. One work-item a
// node.

static ulong code_at(__global const SortKey *keys, uint leaf) {
    return (ulong)keys[leaf].high << 32 | keys[leaf].low;
}

// How many leading bits the codes of two leaves share; -1 if there is no second one.
static int shared_bits(__global const SortKey *keys, uint count, uint a, long b) {
    if (b < 0 || b >= (long)count) {
        return -1;
    }
    const ulong differ = code_at(keys, a) ^ code_at(keys, (uint)b);
    return differ == 0UL ? 64 + (int)clz(a ^ (uint)b) : (int)clz(differ);
}

// Last leaf of the first half of those from `first` to `last`.
static uint split_leaves(__global const SortKey *keys, uint count, uint first, uint last) {
    const int shared = shared_bits(keys, count, first, last);
    uint low = first, high = last;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (shared_bits(keys, count, first, middle) > shared) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// How many leaves an inner node has besides its own, on the side where they have more in common.
static long leaves_beside(__global const SortKey *keys, uint count, uint index, long way, int outside) {
    long most = 2;
    while (shared_bits(keys, count, index, (long)index + most * way) > outside) {
        most *= 2;
    }
    long length = 0;
    for (long step = most / 2; step > 0; step /= 2) {
        if (shared_bits(keys, count, index, (long)index + (length + step) * way) > outside) {
            length += step;
        }
    }
    return length;
}

// First leaf, last leaf, and last leaf of the first half of an inner node.
static uint3 span_of(__global const SortKey *keys, uint count, uint index) {
    const int after = shared_bits(keys, count, index, (long)index + 1);
    const int before = shared_bits(keys, count, index, (long)index - 1);
    const bool up = after > before;
    const uint beside = (uint)leaves_beside(keys, count, index, up ? 1 : -1, up ? before : after);
    const uint first = up ? index : index - beside, last = up ? index + beside : index;
    return (uint3)(first, last, split_leaves(keys, count, first, last));
}

static Node node_of(uint first, uint second) {
    const Node node = {{0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.0f}, first, second};
    return node;
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_tree(__global const AccelFrame *accel_frame, __global const SortKey *keys, __global Node *nodes,
                      __global uint *parents) {
    const uint index = get_global_id(0), count = accel_frame->count;
    if (index == 0u) {
        parents[0] = NOTHING;
    }
    if (index + 1u < count) {
        const uint3 span = span_of(keys, count, index);
        const uint leaf = count - 1u;
        const uint first = span.x == span.z ? leaf + span.z : span.z;
        const uint second = span.y == span.z + 1u ? leaf + span.z + 1u : span.z + 1u;
        nodes[index] = node_of(first, second);
        parents[first] = index;
        parents[second] = index;
    } else if (index < 2u * count - 1u) {
        nodes[index] = node_of(keys[index - (count - 1u)].primitive, NOTHING);
    }
}
