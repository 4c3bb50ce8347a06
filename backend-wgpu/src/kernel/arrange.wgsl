// No mirror in core: turns the batch in flight into a number of groups for an indirect dispatch.

@group(0) @binding(0) var<storage, read> control: Control;
@group(0) @binding(1) var<storage, read_write> groups: array<u32, 3>;

@compute @workgroup_size(1)
fn main() {
    let wanted = (control.taken + ITEM_GROUP - 1u) / ITEM_GROUP;
    let tall = wanted > MOST_GROUPS;
    groups[0] = select(wanted, MOST_GROUPS, tall);
    groups[1] = (wanted + MOST_GROUPS - 1u) / MOST_GROUPS;
    groups[2] = 1u;
}
