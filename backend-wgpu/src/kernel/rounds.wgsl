// No mirror in core: tiles may be sampled in several rounds, each of which goes on where the last stopped.

struct Rounds {
    // A round ends when so many draws of a kind have been sampled in a tile.
    budget: array<u32, 2>,
    // Set if the driver ended a loop early.
    truncated: u32,
    // Chunks begun; zeroed by the host before the first.
    chunk: u32,
    // Rounds begun in this chunk.
    round: u32,
    // For each kind of grid, not 0 if a tile has draws left.
    unfinished: array<u32, 2>,
    // Draws of the chunk that have been looked through: a number a tile for one kind, then for the other.
    progress: array<u32>,
}
