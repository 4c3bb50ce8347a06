// Mirrors core/src/accel/bsp/cells.rs: how many pieces the cells have, far to near. An invocation a cell.

@group(0) @binding(0) var<storage, read> bsp_frame: BspFrame;
@group(0) @binding(1) var<storage, read> first_pieces: array<u32>;
@group(0) @binding(2) var<storage, read_write> counts: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let cell = item_index(group, lane);
    if cell < bsp_frame.cells {
        counts[place_of(cell)] = first_pieces[cell + 1u] - first_pieces[cell];
    }
}
