// No mirror in core: the next round of the fused stage; one that is not needed has no groups.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read_write> rounds: Rounds;
@group(0) @binding(2) var<storage, read_write> groups: array<u32, 3>;

const TILE: u32 = 16u;

@compute @workgroup_size(1)
fn main() {
    let wanted = rounds.round == 0u || rounds.unfinished != 0u;
    rounds.round += 1u;
    rounds.unfinished = 0u;
    groups[0] = (frame.width + TILE - 1u) / TILE;
    groups[1] = (frame.height + TILE - 1u) / TILE;
    groups[2] = select(0u, 1u, wanted);
}
