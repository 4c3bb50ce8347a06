// Mirrors core/src/accel/ray.rs: what rays hit first. One work-item a probe.

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_accel_rays(__global const AccelFrame *accel_frame, __global const Node *nodes, __global const Triangle *triangles,
                      __global const Probe *probes, __global Finding *found) {
    const uint index = get_global_id(0), zero = accel_frame->zero;
    if (index < accel_frame->questions) {
        const Search search = search_of(zero, probes + index, true);
        found[index] = find(zero, &search, nodes, triangles);
    }
}
