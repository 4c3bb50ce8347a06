// Mirrors core/src/patch/owner.rs: which patch evaluates a vertex that several patches have. Net 0 is the patch's own,
// net w + 1 that of the owner that word w names.

const NETS: u32 = 9u;
// In the place of a word's number, of a vertex inside a patch.
const NO_WORD: u32 = 8u;

// The patch whose net has a number; the patch itself where no other one is its owner.
fn patch_of_net(patch_id: u32, n: u32) -> u32 {
    if n > 0u {
        let word = owner_word(patch_id, n - 1u);
        if word != 0u {
            return (word >> OWNER_SHIFT) - 1u;
        }
    }
    return patch_id;
}

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
    let ends = vec2<u32>(number & 1u, number >> 1u) * PARAM_ONE;
    let is_corner = (word & OWNER_IS_CORNER) != 0u;
    let is_reversed = (word & OWNER_IS_REVERSED) != 0u;
    if is_corner && !is_reversed {
        return ends;
    }
    let turns = is_reversed && (!is_corner || along > PARAM_ONE / 2u);
    let there = select(along, PARAM_ONE - along, turns);
    return select(vec2<u32>(ends.x, there), vec2<u32>(there, ends.x), number < 2u);
}

// Where a vertex of a patch is evaluated: if the patch is displaced, on the vertex's owner.
fn owner_of(patch_id: u32, at: vec2<u32>) -> Owner {
    let which = word_for(at.x, at.y);
    if IS_DISPLACED && which != NO_WORD {
        let word = owner_word(patch_id, which);
        if word != 0u {
            let there = place_on(word, select(at.y, at.x, which < 2u));
            return Owner(which + 1u, there.x, there.y);
        }
    }
    return Owner(0u, at.x, at.y);
}
