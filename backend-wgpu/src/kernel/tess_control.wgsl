// Mirrors core/src/kernel/tess_control.rs: which levels a patch has, and how many vertices and primitives it becomes with
// them; an invocation a patch.

@group(0) @binding(0) var<storage, read> tess_frame: TessFrame;
@group(0) @binding(1) var<storage, read> tess_patches: array<TessPatch>;
@group(0) @binding(2) var<storage, read> levels: array<TessLevels>;
@group(0) @binding(3) var<storage, read_write> records: array<TessRecord>;

var<private> topology: Topology;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = tess_frame.zero;
    let item = item_index(group, lane);
    if item < tess_frame.patch_count {
        records[item] = record(levels_of(item));
    }
}

// The record of a patch with these levels.
fn record(asked: TessLevels) -> TessRecord {
    var words = convert(asked);
    for (var number = 0u; number < 6u; number++) {
        divide(number, words[level_of(number)]);
    }
    measure();
    let primitives = select(primitive_count(), 0u, (tess_frame.flags & TESS_POINTS) != 0u);
    return TessRecord(words, vertex_count(), primitives, 0u, 0u, 0u);
}
