// No mirror in core: which item a group or an invocation works on. Groups are spread over two dimensions only when
// there are more of them than fit one; the first is then full.

const ITEM_GROUP: u32 = 64u;
const MOST_GROUPS: u32 = 65535u;

fn group_index(group: vec3<u32>) -> u32 {
    return group.y * MOST_GROUPS + group.x;
}

fn item_index(group: vec3<u32>, lane: u32) -> u32 {
    return group_index(group) * ITEM_GROUP + lane;
}
