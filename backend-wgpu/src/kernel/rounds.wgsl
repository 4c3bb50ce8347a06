// No mirror in core: how far a chunk is. Tiles may be sampled in several rounds, each of which goes on where the last
// stopped; sort-last takes turns.

struct Rounds {
    // A round ends when so many draws of a kind have been sampled in a block.
    budget: array<u32, 2>,
    // Set if the driver ended a loop early.
    truncated: u32,
    // First draw of the next chunk; zeroed by the host before the first one.
    next: u32,
    // Rounds begun in this chunk.
    round: u32,
    // The turn of sort-last, from the host.
    turn: u32,
    // Draws that are in no chunk yet.
    left: u32,
    // For each kind of grid, not 0 if a block has draws left.
    unfinished: array<u32, 2>,
    // Draws of a block's list that have been sampled: a number a block for one kind, then for the other.
    progress: array<u32>,
}
