// No mirror in core: the next round of the tiles, groups for each kind of grid, one a block; what is not needed has none.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> bins: array<u32>;
@group(0) @binding(2) var<storage, read_write> rounds: Rounds;
@group(0) @binding(3) var<storage, read_write> groups: array<u32, 6>;

@compute @workgroup_size(1)
fn main() {
    for (var kind = 0u; kind < 2u; kind++) {
        let box = BOXES + kind * BOX;
        let is_wanted = rounds.round == 0u || rounds.unfinished[kind] != 0u;
        let is_there = bins[box + 1u] != 0u;
        let some = select(0u, 1u, is_wanted && is_there);
        groups[3u * kind] = some * (bins[box + 1u] + bins[box] - 0xffffu);
        groups[3u * kind + 1u] = some * (bins[box + 3u] + bins[box + 2u] - 0xffffu);
        groups[3u * kind + 2u] = some;
        rounds.unfinished[kind] = 0u;
    }
    rounds.round += 1u;
}
