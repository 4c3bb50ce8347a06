// Mirrors core/src/patch/owner.rs: which patch evaluates a vertex that several patches have.

// In the place of a word's number, of a vertex inside a patch.
const NO_WORD: u32 = 8u;

// Number of the word that tells about a vertex.
fn word_for(u: u32, v: u32) -> u32 {
    let high_u = select(0u, 1u, u == PARAM_ONE);
    let high_v = select(0u, 1u, v == PARAM_ONE);
    let is_side_u = u == 0u || high_u == 1u;
    let is_side_v = v == 0u || high_v == 1u;
    if is_side_u && is_side_v {
        return 4u + high_u + 2u * high_v;
    }
    if is_side_v {
        return high_v;
    }
    return select(NO_WORD, 2u + high_u, is_side_u);
}

// Where the owner that a word names has the vertex that lies at `along` on a side.
fn place_on(word: u32, along: u32) -> vec2<u32> {
    let number = (word >> 1u) & 3u;
    let is_corner = (word & OWNER_IS_CORNER) != 0u;
    let is_reversed = (word & OWNER_IS_REVERSED) != 0u;
    let is_half = (word & OWNER_IS_HALF) != 0u;
    if is_corner && !is_reversed {
        let ends = vec2<u32>(number & 1u, number >> 1u) * PARAM_ONE;
        return select(ends, on_patch_side(number, PARAM_ONE / 2u), is_half);
    }
    let turns = is_reversed && (!is_corner || along > PARAM_ONE / 2u);
    let there = select(along, PARAM_ONE - along, turns);
    let start = select(0u, PARAM_ONE / 2u, (word & OWNER_IS_SECOND) != 0u);
    return on_patch_side(number, select(there, start + there / 2u, is_half));
}

// u and v of what lies at `along` on a side of a patch.
fn on_patch_side(side: u32, along: u32) -> vec2<u32> {
    let across = (side & 1u) * PARAM_ONE;
    return select(vec2<u32>(across, along), vec2<u32>(along, across), side < 2u);
}
