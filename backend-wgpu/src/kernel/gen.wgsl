// Made from core/src/abi.rs; a test compares. To make it anew:
// UPDATE_HEADERS=1 cargo test -p micropoly-conformance --test headers
const PARAM_BITS: u32 = 24u;
const PARAM_ONE: u32 = 16777216u;
const PARAM_STEP: f32 = 5.9604645e-8f;
const MAX_SPLITS: u32 = 20u;
const MAX_RATE_BITS: u32 = 4u;
const MAX_RATE: u32 = 16u;
const FIVE_BITS: u32 = 31u;
const SIDE_MASK: u32 = 1023u;
const CORNER_SHIFT: u32 = 10u;
const RATE_U_SHIFT: u32 = 10u;
const RATE_V_SHIFT: u32 = 15u;
const SUBPIXEL_BITS: u32 = 8u;
const SUBPIXELS: i32 = 256i;
const GUARD_BAND: f32 = 1.6e4f;
const ROUNDING: f32 = 9.536743e-7f;
const FAR_OFF: f32 = 1.048576e6f;
const LENGTH_TINY: f32 = 9.094947e-13f;
const FLAT: f32 = 2.4414063e-4f;
const PARALLEL: f32 = 5.9604645e-8f;
const INNER_MOST: f32 = 4.4444445e-1f;
const THIRD: f32 = 3.3333334e-1f;
const PLACE_BITS: u32 = 12u;
const JOINED_SPLITS: u32 = 11u;
const LINE_SHARE: f32 = 1.0416667e-2f;
const SHADE_TINY: f32 = 1e-30f;
const OWNER_SHIFT: u32 = 6u;
const OWNER_IS_HALF: u32 = 16u;
const OWNER_IS_SECOND: u32 = 32u;
const OWNER_IS_CORNER: u32 = 8u;
const OWNER_IS_REVERSED: u32 = 1u;
const KIND_HALVED: u32 = 15u;
const KIND_HALF_SHIFT: u32 = 4u;
const KIND_RATIONAL: u32 = 256u;
const TESS_UNIT: u32 = 65536u;
const TESS_HALF: u32 = 32768u;
const MAX_TESS_LEVEL: f32 = 6.4e1f;
const TESS_TRIANGLES: u32 = 0u;
const TESS_QUADS: u32 = 1u;
const TESS_ISOLINES: u32 = 2u;
const TESS_EQUAL: u32 = 0u;
const TESS_EVEN: u32 = 1u;
const TESS_ODD: u32 = 2u;
const TESS_STADLBAUER: u32 = 1u;
const TESS_CLOCKWISE: u32 = 2u;
const TESS_POINTS: u32 = 4u;
const TESS_CONSTANT: u32 = 0u;
const TESS_LENGTH: u32 = 1u;
const TESS_DISTANCE: u32 = 2u;
const TESS_GIVEN: u32 = 3u;
const TESS_LINEAR: u32 = 0u;
const TESS_PN: u32 = 1u;
const TESS_PHONG: u32 = 2u;
const TESS_BEZIER: u32 = 3u;
const TESS_COORDINATES: u32 = 4u;
const LEVEL_FIXED: u32 = 16777215u;
const LEVEL_ODD: u32 = 2147483648u;
const LEVEL_STADLBAUER: u32 = 1073741824u;
const PIECE_VERTICES: u32 = 128u;
const PIECE_PRIMITIVES: u32 = 256u;
const TESS_WINDOW: u32 = 131072u;
const SORT_BITS: u32 = 4u;
const SORT_DIGITS: u32 = 16u;
const SORT_RUN: u32 = 16u;
const SORT_BLOCK: u32 = 1024u;
const SEE_BLOCK: u32 = 64u;
const NOTHING: u32 = 4294967295u;
const UNFINISHED: u32 = 4294967294u;
const DEEPEST: u32 = 96u;
const MAX_OCTAVES: u32 = 8u;
const LATTICE_END: f32 = 4.194304e6f;
const LATTICE_NEAR: f32 = 9.536743e-7f;
const LATTICE_STEP: f32 = 1.1920929e-7f;
const HASH_X: u32 = 73856093u;
const HASH_Y: u32 = 19349663u;
const HASH_Z: u32 = 83492791u;
const HASH_OCTAVE: u32 = 2654435769u;
const HASH_FIRST: u32 = 2146121005u;
const HASH_SECOND: u32 = 2221713035u;
const LOCAL_BATCH: u32 = 64u;
const LOCAL_BATCHES: u32 = 8u;
const LOCAL_DRAWS: u32 = 512u;
const LOCAL_STACK: u32 = 256u;
const CULL: u32 = 0u;
const DRAW: u32 = 1u;
const SPLIT_U: u32 = 2u;
const SPLIT_V: u32 = 3u;
const DRAW_LIMITED: u32 = 4u;
const FLAG_CULL_BACKFACES: u32 = 1u;
const FLAG_WEBER: u32 = 2u;
const FLAG_FIXED: u32 = 4u;
const FLAG_NAIVE: u32 = 8u;
const FLAG_WHOLE: u32 = 16u;
const FLAG_SMOOTH: u32 = 32u;
const FLAG_LAYERS: u32 = 64u;
const FLAG_SORT_LAST: u32 = 128u;
const FLAG_FLAT: u32 = 256u;
const FLAG_INSTANCES: u32 = 512u;
const MAX_PATTERN_BITS: u32 = 3u;
const MAX_SAMPLES: u32 = 64u;
const OPAQUE_DEPTH: u32 = 1u;
const WEBER_FAR: f32 = 1e3f;
const WEBER_MARGIN: f32 = 3.2e1f;
const WEBER_TINY: f32 = 1e-12f;
const WEBER_FAR_OFF: f32 = 1e18f;
const WEBER_SPLITS: u32 = 23u;

struct Patch {
    x: array<f32, 16>,
    y: array<f32, 16>,
    z: array<f32, 16>,
    object: u32,
    faces: u32,
    kind: u32,
    owners: array<u32, 8>,
}

struct Object {
    to_eye: array<f32, 12>,
    colour: array<f32, 3>,
    specular: f32,
    gloss: u32,
    reach: f32,
    height: f32,
    frequency: f32,
    octaves: u32,
    opacity: f32,
    first_patch: u32,
    first_record: u32,
    normal_to_eye: array<f32, 9>,
}

struct Frame {
    width: u32,
    height: u32,
    focal: f32,
    centre_x: f32,
    centre_y: f32,
    near: f32,
    bound: f32,
    levels: u32,
    rate: u32,
    density: f32,
    around: f32,
    flags: u32,
    zero: u32,
    light_count: u32,
    ambient: array<f32, 3>,
    light_vector: array<f32, 32>,
    light_colour: array<f32, 24>,
    left: u32,
    right: u32,
    top: u32,
    bottom: u32,
    sample_left: u32,
    sample_right: u32,
    sample_top: u32,
    sample_bottom: u32,
    pitch_bits: u32,
    pattern_bits: u32,
    sample_x: array<i32, 64>,
    sample_y: array<i32, 64>,
    least_offset: i32,
    most_offset: i32,
    place_first: u32,
    place_column: u32,
    place_row: u32,
    tile_bits: u32,
    shown_left: u32,
    shown_right: u32,
    shown_top: u32,
    shown_bottom: u32,
    taps: u32,
    object_count: u32,
}

struct TessFrame {
    patch_count: u32,
    domain: u32,
    spacing: u32,
    flags: u32,
    control: u32,
    evaluation: u32,
    columns: u32,
    rows: u32,
    outer: array<f32, 4>,
    inner: array<f32, 2>,
    eye: array<f32, 3>,
    factor: f32,
    scale: f32,
    phong: f32,
    zero: u32,
}

struct TessPatch {
    points: array<f32, 48>,
    uv: array<f32, 8>,
    edges: array<f32, 16>,
    corners: array<f32, 8>,
}

struct TessLevels {
    outer: array<f32, 4>,
    inner: array<f32, 2>,
}

struct TessRecord {
    levels: array<u32, 6>,
    vertices: u32,
    primitives: u32,
    first_vertex: u32,
    first_primitive: u32,
    first_piece: u32,
}

struct TessTotals {
    first: u32,
    end: u32,
    vertex_room: u32,
    primitive_room: u32,
    vertices: u32,
    primitives: u32,
    pieces: u32,
}

struct TessVertex {
    position: array<f32, 3>,
    normal: array<f32, 3>,
    uv: array<f32, 2>,
}

struct Bounds {
    low: array<f32, 3>,
    high: array<f32, 3>,
}

struct Node {
    low: array<f32, 3>,
    high: array<f32, 3>,
    first: u32,
    second: u32,
}

struct AccelFrame {
    count: u32,
    bits: u32,
    shift: u32,
    counts: u32,
    questions: u32,
    zero: u32,
}

struct SortKey {
    low: u32,
    high: u32,
    primitive: u32,
}

struct Frustum {
    planes: array<f32, 24>,
}

struct Triangle {
    corners: array<f32, 9>,
}

struct Probe {
    origin: array<f32, 3>,
    direction: array<f32, 3>,
    far: f32,
}

struct Finding {
    primitive: u32,
    distance: f32,
}

struct BspNode {
    triangle: u32,
    own: u32,
    front: u32,
    back: u32,
    to_back: u32,
}

struct BspPlane {
    low: array<i32, 3>,
    high: array<i32, 3>,
    offset_low: i32,
    offset_high: i32,
}

struct BspFrame {
    planes: u32,
    cells: u32,
    slabs: array<u32, 3>,
    eye_slabs: array<u32, 3>,
    eye: array<i32, 3>,
    zero: u32,
}

struct Tap {
    weight: f32,
    column: i32,
    row: i32,
}

struct Pixel {
    rgba: array<f32, 4>,
    depth: u32,
    patch_id: u32,
    u: u32,
    v: u32,
    covered: u32,
}

struct Surface {
    patch_id: u32,
    u: u32,
    v: u32,
    shape: u32,
    borders: array<u32, 4>,
}

struct Draw {
    patch_id: u32,
    u: u32,
    v: u32,
    shape: u32,
    borders: array<u32, 4>,
    columns: u32,
    rows: u32,
}

struct Verdict {
    code: u32,
    columns: u32,
    rows: u32,
    along_u: u32,
    along_v: u32,
}

struct Slot {
    splits: u32,
    draws: u32,
}

struct Control {
    stack: u32,
    taken: u32,
    roots: u32,
    base: u32,
    next_root: u32,
    waiting: u32,
    fresh: u32,
    peak: u32,
    processed: u32,
    culled: u32,
    drawn: u32,
    limited: u32,
    micropolygons: u32,
    overflow: u32,
    listed: u32,
}

struct Group {
    stack: u32,
    roots: u32,
    next_root: u32,
    batches: u32,
    room: u32,
    held: u32,
    draws: u32,
    first_draw: u32,
    processed: u32,
    culled: u32,
    limited: u32,
    micropolygons: u32,
    peak: u32,
    load: u32,
}

struct Question {
    operation: u32,
    a: u32,
    b: u32,
    c: u32,
}

struct Limits {
    patches: u32,
    batch: u32,
    stack_room: u32,
    draw_room: u32,
    levels: u32,
    groups: u32,
}

struct MeshVertex {
    position: array<f32, 3>,
    normal: array<f32, 3>,
    uv: array<f32, 2>,
    patch_id: u32,
}

struct MeshPlace {
    vertex: u32,
    triangle: u32,
}

struct MeshTotals {
    vertices: u32,
    triangles: u32,
}

struct Sample {
    depth: u32,
    patch_id: u32,
    u: u32,
    v: u32,
}

struct Colour {
    rgba: array<f32, 4>,
}
