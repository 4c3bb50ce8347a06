// No mirror in core: the fused stage may run in several rounds, each of which goes on where the last stopped.

struct Rounds {
    // A group stops looking for draws when it has found more than this; at most CHOSEN - GROUP.
    enough: u32,
    // A round ends when this many have been drawn.
    budget: u32,
    // Set if the driver ended a loop early.
    truncated: u32,
    // From here on zeroed before the first round. Rounds begun:
    round: u32,
    // Not 0 if a tile has draws left.
    unfinished: u32,
    // Draws that have been looked through, a tile each.
    progress: array<u32>,
}
