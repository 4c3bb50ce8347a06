// No mirror in core: moves on to the next slice of draws; one that is empty has no groups.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> control: Control;
@group(0) @binding(2) var<storage, read_write> slice: Slice;
@group(0) @binding(3) var<storage, read_write> groups: array<u32, 3>;

const TILE: u32 = 16u;

@compute @workgroup_size(1)
fn main() {
    let first = slice.next;
    slice.first = first;
    slice.next = first + slice.size;
    groups[0] = (frame.width + TILE - 1u) / TILE;
    groups[1] = (frame.height + TILE - 1u) / TILE;
    groups[2] = select(0u, 1u, first < control.waiting + control.fresh);
}
