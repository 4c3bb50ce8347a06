// Mirrors core/src/accel/tree.rs (`fit`): boxes from the leaves upwards. One work-item a leaf and number of its box.
//
// Each number climbs by itself. Whoever comes first to a node leaves its number there and ends; whoever comes second takes
// it, in the same step, and climbs on with both. So whatever has to be seen by another work-item is in the one word that both
// exchange, and no order of memory is asked for but that of single words. Numbers are left with all bits turned round: 0,
// which is nobody's, would be none.

static void set_word(__global Node *node, uint word, uint bits) {
    if (word < 3u) {
        node->low[word] = as_float(bits);
    } else {
        node->high[word - 3u] = as_float(bits);
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_boxes(__global const AccelFrame *accel_frame, __global const Bounds *boxes, __global const uint *parents,
                       __global uint *visits, __global Node *nodes) {
    const uint item = get_global_id(0), count = accel_frame->count;
    if (item >= 6u * count) {
        return;
    }
    const uint word = item % 6u;
    uint node = item / 6u + count - 1u;
    uint bits = bounds_word(boxes + nodes[node].first, word);
    set_word(nodes + node, word, bits);
    while (parents[node] != NOTHING) {
        const uint parent = parents[node];
        __global uint *visit = visits + 6u * parent + word;
        const uint other = ~atomic_xchg(visit, ~bits);
        if (other == ~0u) {
            return;
        }
        *visit = 0u;
        const bool is_first = nodes[parent].first == node;
        bits = is_first ? union_word(word, bits, other) : union_word(word, other, bits);
        set_word(nodes + parent, word, bits);
        node = parent;
    }
}
