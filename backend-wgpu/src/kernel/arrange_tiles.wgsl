// No mirror in core: the next round of the tiles, groups for each kind of grid; what is not needed has none.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> grids: array<u32>;
@group(0) @binding(2) var<storage, read_write> rounds: Rounds;
@group(0) @binding(3) var<storage, read_write> groups: array<u32, 6>;

@compute @workgroup_size(1)
fn main() {
    for (var kind = 0u; kind < 2u; kind++) {
        let wanted = select(rounds.unfinished[kind], grids[HEAD_KINDS + kind], rounds.round == 0u);
        groups[3u * kind] = grids[HEAD_TILES + 1u];
        groups[3u * kind + 1u] = grids[HEAD_TILES + 3u];
        groups[3u * kind + 2u] = select(0u, 1u, wanted != 0u);
        rounds.unfinished[kind] = 0u;
    }
    rounds.round += 1u;
}
