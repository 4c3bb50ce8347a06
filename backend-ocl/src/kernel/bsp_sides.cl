// Mirrors core/src/accel/bsp/plane.rs (`BspPlane::is_before`): which planes the eye is before. One work-item a plane.

static long sum_of(__global const int *words, __global const int *eye) {
    return (long)words[0] * eye[0] + (long)words[1] * eye[1] + (long)words[2] * eye[2];
}

static bool is_before_plane(__global const BspPlane *plane, __global const int *eye) {
    const long low = sum_of(plane->low, eye) - plane->offset_low;
    const long high = sum_of(plane->high, eye) - plane->offset_high + (low >> 32);
    return high > 0 || (high == 0 && (uint)low != 0u);
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_bsp_sides(__global const BspFrame *bsp_frame, __global const BspPlane *planes, __global uint *is_before) {
    const uint index = get_global_id(0);
    if (index < bsp_frame->planes) {
        is_before[index] = is_before_plane(planes + index, bsp_frame->eye);
    }
}
