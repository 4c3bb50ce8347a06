// Made from core/src/abi.rs; a test compares. To make it anew:
// UPDATE_HEADERS=1 cargo test -p micropoly-conformance --test headers
#define PARAM_BITS 24u
#define PARAM_ONE 16777216u
#define PARAM_STEP 5.9604645e-8f
#define MAX_SPLITS 20u
#define MAX_RATE_BITS 4u
#define MAX_RATE 16u
#define FIVE_BITS 31u
#define SIDE_MASK 1023u
#define CORNER_SHIFT 10u
#define RATE_U_SHIFT 10u
#define RATE_V_SHIFT 15u
#define SUBPIXEL_BITS 8u
#define SUBPIXELS 256
#define GUARD_BAND 1.6e4f
#define ROUNDING 9.536743e-7f
#define FAR_OFF 1.048576e6f
#define LENGTH_TINY 9.094947e-13f
#define FLAT 2.4414063e-4f
#define PARALLEL 5.9604645e-8f
#define INNER_MOST 4.4444445e-1f
#define THIRD 3.3333334e-1f
#define PLACE_BITS 12u
#define JOINED_SPLITS 11u
#define LINE_SHARE 1.0416667e-2f
#define SHADE_TINY 1e-30f
#define OWNER_SHIFT 6u
#define OWNER_IS_HALF 16u
#define OWNER_IS_SECOND 32u
#define OWNER_IS_CORNER 8u
#define OWNER_IS_REVERSED 1u
#define KIND_HALVED 15u
#define KIND_HALF_SHIFT 4u
#define KIND_RATIONAL 256u
#define TESS_UNIT 65536u
#define TESS_HALF 32768u
#define MAX_TESS_LEVEL 6.4e1f
#define TESS_TRIANGLES 0u
#define TESS_QUADS 1u
#define TESS_ISOLINES 2u
#define TESS_EQUAL 0u
#define TESS_EVEN 1u
#define TESS_ODD 2u
#define TESS_STADLBAUER 1u
#define TESS_CLOCKWISE 2u
#define TESS_POINTS 4u
#define TESS_CONSTANT 0u
#define TESS_LENGTH 1u
#define TESS_DISTANCE 2u
#define TESS_GIVEN 3u
#define TESS_LINEAR 0u
#define TESS_PN 1u
#define TESS_PHONG 2u
#define TESS_BEZIER 3u
#define TESS_COORDINATES 4u
#define LEVEL_FIXED 16777215u
#define LEVEL_ODD 2147483648u
#define LEVEL_STADLBAUER 1073741824u
#define PIECE_VERTICES 128u
#define PIECE_PRIMITIVES 256u
#define TESS_WINDOW 131072u
#define SORT_BITS 4u
#define SORT_DIGITS 16u
#define SORT_RUN 16u
#define SORT_BLOCK 1024u
#define SEE_BLOCK 64u
#define NOTHING 4294967295u
#define UNFINISHED 4294967294u
#define DEEPEST 96u
#define MAX_OCTAVES 8u
#define LATTICE_END 4.194304e6f
#define LATTICE_NEAR 9.536743e-7f
#define LATTICE_STEP 1.1920929e-7f
#define HASH_X 73856093u
#define HASH_Y 19349663u
#define HASH_Z 83492791u
#define HASH_OCTAVE 2654435769u
#define HASH_FIRST 2146121005u
#define HASH_SECOND 2221713035u
#define LOCAL_BATCH 64u
#define LOCAL_BATCHES 8u
#define LOCAL_DRAWS 512u
#define LOCAL_STACK 256u
#define CULL 0u
#define DRAW 1u
#define SPLIT_U 2u
#define SPLIT_V 3u
#define DRAW_LIMITED 4u
#define FLAG_CULL_BACKFACES 1u
#define FLAG_WEBER 2u
#define FLAG_FIXED 4u
#define FLAG_NAIVE 8u
#define FLAG_WHOLE 16u
#define FLAG_SMOOTH 32u
#define FLAG_LAYERS 64u
#define FLAG_SORT_LAST 128u
#define FLAG_FLAT 256u
#define FLAG_INSTANCES 512u
#define MAX_PATTERN_BITS 3u
#define MAX_SAMPLES 64u
#define OPAQUE_DEPTH 1u
#define WEBER_FAR 1e3f
#define WEBER_MARGIN 3.2e1f
#define WEBER_TINY 1e-12f
#define WEBER_FAR_OFF 1e18f
#define WEBER_SPLITS 23u

typedef struct {
    float x[16];
    float y[16];
    float z[16];
    uint object;
    uint faces;
    uint kind;
    uint owners[8];
} Patch;

typedef struct {
    float to_eye[12];
    float colour[3];
    float specular;
    uint gloss;
    float reach;
    float height;
    float frequency;
    uint octaves;
    float opacity;
    uint first_patch;
    uint first_record;
    float normal_to_eye[9];
} Object;

typedef struct {
    uint width;
    uint height;
    float focal;
    float centre_x;
    float centre_y;
    float near;
    float bound;
    uint levels;
    uint rate;
    float density;
    float around;
    uint flags;
    uint zero;
    uint light_count;
    float ambient[3];
    float light_vector[32];
    float light_colour[24];
    uint left;
    uint right;
    uint top;
    uint bottom;
    uint sample_left;
    uint sample_right;
    uint sample_top;
    uint sample_bottom;
    uint pitch_bits;
    uint pattern_bits;
    int sample_x[64];
    int sample_y[64];
    int least_offset;
    int most_offset;
    uint place_first;
    uint place_column;
    uint place_row;
    uint tile_bits;
    uint shown_left;
    uint shown_right;
    uint shown_top;
    uint shown_bottom;
    uint taps;
    uint object_count;
} Frame;

typedef struct {
    uint patch_count;
    uint domain;
    uint spacing;
    uint flags;
    uint control;
    uint evaluation;
    uint columns;
    uint rows;
    float outer[4];
    float inner[2];
    float eye[3];
    float factor;
    float scale;
    float phong;
    uint zero;
} TessFrame;

typedef struct {
    float points[48];
    float uv[8];
    float edges[16];
    float corners[8];
} TessPatch;

typedef struct {
    float outer[4];
    float inner[2];
} TessLevels;

typedef struct {
    uint levels[6];
    uint vertices;
    uint primitives;
    uint first_vertex;
    uint first_primitive;
    uint first_piece;
} TessRecord;

typedef struct {
    uint first;
    uint end;
    uint vertex_room;
    uint primitive_room;
    uint vertices;
    uint primitives;
    uint pieces;
} TessTotals;

typedef struct {
    float position[3];
    float normal[3];
    float uv[2];
} TessVertex;

typedef struct {
    float low[3];
    float high[3];
} Bounds;

typedef struct {
    float low[3];
    float high[3];
    uint first;
    uint second;
} Node;

typedef struct {
    uint count;
    uint bits;
    uint shift;
    uint counts;
    uint questions;
    uint zero;
} AccelFrame;

typedef struct {
    uint low;
    uint high;
    uint primitive;
} SortKey;

typedef struct {
    float planes[24];
} Frustum;

typedef struct {
    float corners[9];
} Triangle;

typedef struct {
    float origin[3];
    float direction[3];
    float far;
} Probe;

typedef struct {
    uint primitive;
    float distance;
} Finding;

typedef struct {
    uint triangle;
    uint own;
    uint front;
    uint back;
    uint to_back;
} BspNode;

typedef struct {
    int low[3];
    int high[3];
    int offset_low;
    int offset_high;
} BspPlane;

typedef struct {
    uint planes;
    uint cells;
    uint slabs[3];
    uint eye_slabs[3];
    int eye[3];
    uint zero;
} BspFrame;

typedef struct {
    float weight;
    int column;
    int row;
} Tap;

typedef struct {
    float rgba[4];
    uint depth;
    uint patch_id;
    uint u;
    uint v;
    uint covered;
} Pixel;

typedef struct {
    uint patch_id;
    uint u;
    uint v;
    uint shape;
    uint borders[4];
} Surface;

typedef struct {
    uint patch_id;
    uint u;
    uint v;
    uint shape;
    uint borders[4];
    uint columns;
    uint rows;
} Draw;

typedef struct {
    uint code;
    uint columns;
    uint rows;
    uint along_u;
    uint along_v;
} Verdict;

typedef struct {
    uint splits;
    uint draws;
} Slot;

typedef struct {
    uint stack;
    uint taken;
    uint roots;
    uint base;
    uint next_root;
    uint waiting;
    uint fresh;
    uint peak;
    uint processed;
    uint culled;
    uint drawn;
    uint limited;
    uint micropolygons;
    uint overflow;
    uint listed;
} Control;

typedef struct {
    uint stack;
    uint roots;
    uint next_root;
    uint batches;
    uint room;
    uint held;
    uint draws;
    uint first_draw;
    uint processed;
    uint culled;
    uint limited;
    uint micropolygons;
    uint peak;
    uint load;
} Group;

typedef struct {
    uint operation;
    uint a;
    uint b;
    uint c;
} Question;

typedef struct {
    uint patches;
    uint batch;
    uint stack_room;
    uint draw_room;
    uint levels;
    uint groups;
} Limits;

typedef struct {
    float position[3];
    float normal[3];
    float uv[2];
    uint patch_id;
} MeshVertex;

typedef struct {
    uint vertex;
    uint triangle;
} MeshPlace;

typedef struct {
    uint vertices;
    uint triangles;
} MeshTotals;

typedef struct {
    uint depth;
    uint patch_id;
    uint u;
    uint v;
} Sample;

typedef struct {
    float rgba[4];
} Colour;
