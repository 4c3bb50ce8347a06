// Mirrors core/src/accel/query.rs (`seen`): which leaves of each block a frustum sees, in their order.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> frusta: array<Frustum>;
@group(0) @binding(3) var<storage, read> counts: array<u32>;
@group(0) @binding(4) var<storage, read_write> seen: array<u32>;

var<workgroup> are_seen: array<u32, SEE_BLOCK>;

@compute @workgroup_size(SEE_BLOCK)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = accel_frame.zero;
    let block = group_index(group);
    let is_own = sees_own(block, lane);
    are_seen[lane] = select(0u, 1u, is_own);
    workgroupBarrier();
    if is_own {
        var place = counts[block];
        for (var other = 0u; other < lane; other++) {
            place += are_seen[other];
        }
        seen[place] = nodes[accel_frame.count - 1u + leaf_of(block, lane)].first;
    }
}
