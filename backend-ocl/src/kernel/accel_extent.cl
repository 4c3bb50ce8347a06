// Mirrors core/src/accel/extent.rs: the box about all primitives. One work-item a primitive; a work-group finds its own extent
// before it tells of it.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_extent(__global const AccelFrame *accel_frame, __global const Bounds *boxes, __global uint *extent) {
    __local uint own[6];
    const uint index = get_global_id(0), lane = get_local_id(0);
    if (lane < 6u) {
        own[lane] = 0u;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (index < accel_frame->count) {
        for (uint word = 0u; word < 6u; word++) {
            const uint number = ordered(bounds_word(boxes + index, word));
            atomic_max(own + word, word < 3u ? ~number : number);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane < 6u) {
        atomic_max(extent + lane, own[lane]);
    }
}
