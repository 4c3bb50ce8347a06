// No mirror in core: where a chunk of draws lies between its kernels, the one that dices and shades each draw
// once (`draw.cl`) and those that sample them, tile by tile (`tiles.cl`) or one by one (`sort_last.cl`).
//
// One buffer of words: the head, what is known of every draw, then a grid a draw, each with room for the largest. A
// grid is column, row and 1 / distance of its vertices, row after row, then position and colour, a coordinate after the
// other.

// Draws a chunk.
#define CHUNK 2048u

// The head: first draw of the chunk and number of its draws; then, is there any grid of kind 1, of kind 2?
#define HEAD_START 0u
#define HEAD_COUNT 1u
#define HEAD_KINDS 2u
// Low bits of a draw's flags: its kind. Nothing is to be seen of it; it is small and whole, so that it needs
// neither clipping nor wide integers; any other.
#define KIND_HIDDEN 0u
#define KIND_NEAR 1u
#define KIND_GENERAL 2u
#define KIND_MASK 3u
// Above them, micropolygons along u and along v, as in the shape of a draw.
#define RATES_SHIFT 2u

#define FLAGS 4u
// Words a draw from there on: flags; left, right, top and bottom of the samples that it can touch; opacity.
#define FLAGS_WORDS 6u
#define BOX 1u
#define OPACITY 5u
#define GRIDS (FLAGS + FLAGS_WORDS * CHUNK)

// Columns (and rows) of samples that one group samples, at most.
#define BLOCK_BITS 4u
#define BLOCK (1u << BLOCK_BITS)

// All of the frame's samples: left, right, top and bottom.
static int4 frame_box(__constant Frame *frame) {
    return (int4)((int)frame->sample_left, (int)frame->sample_right, (int)frame->sample_top,
                  (int)frame->sample_bottom);
}

// What two boxes have in common.
static int4 common(int4 a, int4 b) {
    return (int4)(greater(a.x, b.x), lesser(a.y, b.y), greater(a.z, b.z), lesser(a.w, b.w));
}

// Vertices of the largest grid.
static uint vertices(__constant Frame *frame) {
    return (frame->rate + 1u) * (frame->rate + 1u);
}

// Micropolygons along u and along v of a grid with these flags.
static uint2 rates_in(uint flags) {
    return (uint2)((flags >> RATES_SHIFT) & FIVE_BITS,
                   (flags >> (RATES_SHIFT + RATE_V_SHIFT - RATE_U_SHIFT)) & FIVE_BITS);
}

// Place of the flags of draw `index` of the chunk.
static uint flags_place(uint index) {
    return FLAGS + FLAGS_WORDS * index;
}

// The samples that a draw can touch: left, right, top and bottom.
static int4 box_at(__global const uint *grids, uint index) {
    __global const uint *box = grids + flags_place(index) + BOX;
    return (int4)((int)box[0], (int)box[1], (int)box[2], (int)box[3]);
}

static void put_box(__global uint *grids, uint index, int4 samples) {
    __global uint *box = grids + flags_place(index) + BOX;
    box[0] = (uint)samples.x;
    box[1] = (uint)samples.y;
    box[2] = (uint)samples.z;
    box[3] = (uint)samples.w;
}

// First word of the grid of draw `index` of the chunk.
static uint grid_base(__constant Frame *frame, uint index) {
    return GRIDS + 9u * index * vertices(frame);
}

// First word of screen coordinate k (column, row, 1 / distance) of a grid.
static uint screen_base(__constant Frame *frame, uint base, uint k) {
    return base + k * vertices(frame);
}

// First word of number k (position x, y, z, colour red, green, blue) of a grid.
static uint space_base(__constant Frame *frame, uint base, uint k) {
    return screen_base(frame, base, 3u + k);
}

static Vertex vertex_at(__constant Frame *frame, __global const uint *grids, uint base, uint at) {
    const Vertex vertex = {as_int(grids[screen_base(frame, base, 0u) + at]),
                           as_int(grids[screen_base(frame, base, 1u) + at]),
                           as_float(grids[screen_base(frame, base, 2u) + at])};
    return vertex;
}

static void put_screen(__constant Frame *frame, __global uint *grids, uint base, uint at, Vertex vertex) {
    grids[screen_base(frame, base, 0u) + at] = as_uint(vertex.x);
    grids[screen_base(frame, base, 1u) + at] = as_uint(vertex.y);
    grids[screen_base(frame, base, 2u) + at] = as_uint(vertex.w);
}

// Position (first = 0) or colour (3) of a vertex.
static float3 space_at(__constant Frame *frame, __global const uint *grids, uint base, uint at, uint first) {
    return (float3)(as_float(grids[space_base(frame, base, first) + at]),
                    as_float(grids[space_base(frame, base, first + 1u) + at]),
                    as_float(grids[space_base(frame, base, first + 2u) + at]));
}

static void put_space(__constant Frame *frame, __global uint *grids, uint base, uint at, uint first,
                      float3 value) {
    grids[space_base(frame, base, first) + at] = as_uint(value.x);
    grids[space_base(frame, base, first + 1u) + at] = as_uint(value.y);
    grids[space_base(frame, base, first + 2u) + at] = as_uint(value.z);
}

// A box that a work-group finds together.
typedef struct {
    int low_x;
    int high_x;
    int low_y;
    int high_y;
} Extents;

static Extents nothing(void) {
    const Extents extents = {0x7fffffff, -0x7fffffff, 0x7fffffff, -0x7fffffff};
    return extents;
}

// Atomics are spared where they would change nothing: what is stored only ever falls, or only rises.
static void lower(volatile __local int *stored, int value) {
    if (value < *stored) {
        atomic_min(stored, value);
    }
}

static void raise(volatile __local int *stored, int value) {
    if (value > *stored) {
        atomic_max(stored, value);
    }
}

static void include(__local Extents *extents, int x, int y) {
    lower(&extents->low_x, x);
    raise(&extents->high_x, x);
    lower(&extents->low_y, y);
    raise(&extents->high_y, y);
}
