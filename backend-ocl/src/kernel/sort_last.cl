// Mirrors core/src/kernel/sort_last.rs: grids of a chunk are sampled wherever they are, once a turn, and merged by atomic
// maxima and minima. One work-group a draw; then a work-item a sample.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_sort_last(__constant Frame *frame, __global const Draw *draws, __global const uint *grids,
                     __global const Sample *behind, __global const Sample *samples, __global Colour *colours,
                     __global Sample *keys, uint turn) {
    const uint index = get_group_id(0);
    const uint flags = grids[flags_place(index)], kind = flags & KIND_MASK;
    if (index >= grids[HEAD_COUNT] || kind == KIND_HIDDEN) {
        return;
    }
    Sampler s = {frame, grids, &draws[grids[HEAD_START]], behind, frame_box(frame), turn, 0, 0u, keys, samples, colours};
    const uint count = rates_in(flags).x * rates_in(flags).y;
    for (uint number = get_local_id(0); number < count; number += GROUP) {
        sample_one(&s, kind, index, number, index);
    }
}

// The keys of the chunk are merged with what there was before, and forgotten.
__kernel void merge_keys(__constant Frame *frame, __global Sample *samples, __global Sample *keys) {
    const int4 box = frame_box(frame);
    const int column = box.x + (int)get_global_id(0), row = box.z + (int)get_global_id(1);
    if (column >= box.y) {
        return;
    }
    const uint place = place_of_sample(frame, column, row);
    const Sample key = keys[place], none = {0u, NOBODY, NOBODY, NOBODY};
    if (key.depth != 0u && nearer(key, samples[place])) {
        samples[place] = key;
    }
    keys[place] = none;
}
