// Mirrors the first half of core's fused stage, dice and shade: one group a draw of the chunk.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> objects: array<Object>;
@group(0) @binding(2) var<storage, read> patches: array<Patch>;
@group(0) @binding(3) var<storage, read> draws: array<Draw>;
@group(0) @binding(4) var<storage, read_write> grids: array<u32>;
@group(0) @binding(5) var<storage, read> patches_more: array<Patch>;

const GROUP: u32 = 64u;
// A grid this wide or less, in 1/256 pixels, can be sampled in 32 bits: see `near` in `triangle.wgsl`.
const NARROW: i32 = 16000;

// The box around all vertices and ends of chords.
var<workgroup> low_x: atomic<i32>;
var<workgroup> high_x: atomic<i32>;
var<workgroup> low_y: atomic<i32>;
var<workgroup> high_y: atomic<i32>;
// Not 0 if a vertex or an end must be clipped.
var<workgroup> must_clip: atomic<u32>;
// Not 0 if a micropolygon may face the eye.
var<workgroup> faces_eye: atomic<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let draw = draws[grids[HEAD_START] + group.x];
    let surface = surface_of(draw);
    let object = object_of(draw.patch_id);
    let base = grid_base(group.x);
    prepare(surface, lane);
    workgroupBarrier();
    for (var at = lane; at < vertices(); at += GROUP) {
        dice(surface, object, at, base);
        measure(Vertex(grid_x[at], grid_y[at], grid_w[at]));
    }
    put_ends(base, lane);
    workgroupBarrier();
    seek_faces(lane);
    workgroupBarrier();
    if lane == 0u {
        put_flags(base);
    }
}

// What all vertices share: the net, then the rows' curves, the columns' weights and the seams.
fn prepare(surface: Surface, lane: u32) {
    if lane < 48u {
        net[lane] = transformed(surface.patch_id, lane / 16u, lane % 16u);
    }
    prepare_faces(surface.patch_id, lane);
    if lane == 63u {
        clear_measures();
    }
    for (var column = lane; column <= frame.rate; column += GROUP) {
        prepare_column(surface, column);
    }
    workgroupBarrier();
    for (var task = lane; task < 3u * (frame.rate + 1u); task += GROUP) {
        prepare_row(surface, task);
    }
    if lane >= 60u {
        seam(surface, lane - 60u);
    }
    if lane == 59u {
        flat_length = mul(size(), FLAT);
    }
}

fn clear_measures() {
    atomicStore(&low_x, 0x7fffffff);
    atomicStore(&high_x, -0x7fffffff);
    atomicStore(&low_y, 0x7fffffff);
    atomicStore(&high_y, -0x7fffffff);
    atomicStore(&must_clip, 0u);
    atomicStore(&faces_eye, 0u);
}

fn measure(vertex: Vertex) {
    atomicMin(&low_x, vertex.x);
    atomicMax(&high_x, vertex.x);
    atomicMin(&low_y, vertex.y);
    atomicMax(&high_y, vertex.y);
    if vertex.w == 0.0 {
        atomicStore(&must_clip, 1u);
    }
}

// The ends of the chords beyond the borders; where there is none, nothing reads them.
fn put_ends(base: u32, lane: u32) {
    if lane < ENDS && seam_chord[lane / 2u] != 0u {
        put_screen(base, vertices() + lane, seam_ends[lane]);
        measure(seam_ends[lane]);
    }
}

// Finds out whether a micropolygon may face the eye, if that matters.
fn seek_faces(lane: u32) {
    let count = select(0u, frame.rate * frame.rate, (frame.flags & FLAG_CULL_BACKFACES) != 0u);
    for (var index = lane; index < count; index += GROUP) {
        if may_face_eye(index / frame.rate, index % frame.rate) {
            atomicStore(&faces_eye, 1u);
        }
    }
}

fn kind() -> u32 {
    if (frame.flags & FLAG_CULL_BACKFACES) != 0u && atomicLoad(&faces_eye) == 0u {
        return KIND_HIDDEN;
    }
    let narrow = atomicLoad(&high_x) - atomicLoad(&low_x) <= NARROW
        && atomicLoad(&high_y) - atomicLoad(&low_y) <= NARROW;
    return select(KIND_GENERAL, KIND_NEAR, narrow && atomicLoad(&must_clip) == 0u);
}

fn put_flags(base: u32) {
    let found = kind();
    var flags = found;
    for (var border = 0u; border < 4u; border++) {
        let height = firstLeadingBit(seam_longest[border]);
        let longest = select(height, SEAM_LONGEST, height > SEAM_LONGEST);
        let bits = longest | select(0u, SEAM_CHORD, seam_chord[border] != 0u);
        flags |= bits << (SEAM_SHIFT + SEAM_BITS * border);
    }
    grids[base] = flags;
    if found != KIND_HIDDEN {
        grids[HEAD_KINDS + found - 1u] = 1u;
    }
}

fn diced(row: u32, column: u32) -> Vertex {
    let at = row * (frame.rate + 1u) + column;
    return Vertex(grid_x[at], grid_y[at], grid_w[at]);
}

// May the micropolygon be seen from the front? See `faces_away` in core.
fn may_face_eye(row: u32, column: u32) -> bool {
    let a = diced(row, column);
    let b = diced(row, column + 1u);
    let c = diced(row + 1u, column + 1u);
    let d = diced(row + 1u, column);
    let whole = a.w > 0.0 && b.w > 0.0 && c.w > 0.0 && d.w > 0.0;
    return !(whole && signed_area(a, b, c) >= 0 && signed_area(a, c, d) >= 0);
}
