// Mirrors core/src/accel/ray.rs: what rays hit first. An invocation a probe.

@group(0) @binding(0) var<storage, read> accel_frame: AccelFrame;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> probes: array<Probe>;
@group(0) @binding(4) var<storage, read_write> found: array<Finding>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = accel_frame.zero;
    let item = item_index(group, lane);
    if item < accel_frame.questions {
        begin(probes[item]);
        found[item] = find();
    }
}
