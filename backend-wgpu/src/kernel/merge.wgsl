// Mirrors core/src/kernel/sort_last.rs (merge): the samples after the last turn, and keys as before the first; an
// invocation a sample of the frame.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(2) var<storage, read_write> keys: array<vec4<u32>>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = i32(item_index(group, lane));
    let columns = frame_columns();
    let rows = frame_rows();
    let wide = columns.y - columns.x;
    if item >= wide * (rows.y - rows.x) {
        return;
    }
    let place = place_of(columns.x + item % wide, rows.x + item / wide);
    let found = keyed(keys[place]);
    if found.depth != 0u {
        if nearer(found, samples[place]) {
            samples[place] = found;
        }
        keys[place] = vec4<u32>(0u);
    }
}
