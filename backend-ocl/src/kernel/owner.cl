// Mirrors core/src/patch/owner.rs: which patch evaluates a vertex that several patches have.

// Words of a patch that tell about its sides and corners; of a vertex inside it none does.
#define WORDS 8u
#define NO_WORD WORDS

// Where a vertex is evaluated: number of the patch among the sources of its grid (see `dice.cl`), and u and v there.
typedef struct {
    uint slot;
    uint2 at;
} Owner;

static Owner new_owner(uint slot, uint2 at) {
    const Owner owner = {slot, at};
    return owner;
}

// The patch that a word names; `own` if it names none.
static uint patch_in(uint word, uint own) {
    return word == 0u ? own : (word >> OWNER_SHIFT) - 1u;
}

// Which word tells about a vertex.
static uint word_for(uint2 at) {
    const uint high_u = at.x == PARAM_ONE ? 1u : 0u, high_v = at.y == PARAM_ONE ? 1u : 0u;
    const bool ends_u = at.x == 0u || high_u != 0u, ends_v = at.y == 0u || high_v != 0u;
    if (ends_u && ends_v) {
        return 4u + high_u + 2u * high_v;
    }
    if (ends_v) {
        return high_v;
    }
    return ends_u ? 2u + high_u : NO_WORD;
}

// u and v of what lies at `along` on a side of a patch; `on_side` in core.
static uint2 on_patch_side(uint side, uint along) {
    const uint across = (side & 1u) * PARAM_ONE;
    return side < 2u ? (uint2)(along, across) : (uint2)(across, along);
}

// Where the owner that a word names has the vertex that lies at `along` on a side.
static uint2 place_on(uint word, uint along) {
    const uint number = (word >> 1) & 3u;
    const uint first = (number & 1u) * PARAM_ONE, second = (number >> 1) * PARAM_ONE;
    const bool is_corner = (word & OWNER_IS_CORNER) != 0u, is_reversed = (word & OWNER_IS_REVERSED) != 0u;
    const bool is_half = (word & OWNER_IS_HALF) != 0u;
    if (is_corner && !is_reversed) {
        return is_half ? on_patch_side(number, PARAM_ONE / 2u) : (uint2)(first, second);
    }
    const bool turns = is_reversed && (!is_corner || along > PARAM_ONE / 2u);
    const uint there = turns ? PARAM_ONE - along : along;
    const uint start = (word & OWNER_IS_SECOND) != 0u ? PARAM_ONE / 2u : 0u;
    return on_patch_side(number, is_half ? start + there / 2u : there);
}

// Where a vertex of a patch is evaluated: on source 0, itself, or on that of the word about it.
static Owner owner_of(__global const Patch *patch, uint2 at) {
    const uint number = word_for(at);
    // Where there is no word, one all the same: compilers may load first and branch later.
    const uint word = patch->owners[number % WORDS];
    if (number == NO_WORD || word == 0u) {
        return new_owner(0u, at);
    }
    return new_owner(1u + number, place_on(word, number < 2u ? at.x : at.y));
}
