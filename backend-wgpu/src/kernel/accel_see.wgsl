// Mirrors core/src/accel/query.rs (`seen`): how many leaves of each block a frustum sees.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> frusta: array<Frustum>;
@group(0) @binding(3) var<storage, read_write> counts: array<u32>;

var<workgroup> sum: atomic<u32>;

@compute @workgroup_size(SEE_BLOCK)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = accel_frame.zero;
    let block = group_index(group);
    if lane == 0u {
        atomicStore(&sum, 0u);
    }
    workgroupBarrier();
    if sees_own(block, lane) {
        atomicAdd(&sum, 1u);
    }
    workgroupBarrier();
    if lane == 0u && block < accel_frame.counts {
        counts[block] = atomicLoad(&sum);
    }
}
