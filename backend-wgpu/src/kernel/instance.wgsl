// Mirrors core/src/patch/instance.rs: objects that have the same patches. Patches are numbered object by object, records
// are not repeated.

// What a patch's number stands for.
struct Instance {
    record: u32,
    object: u32,
}

// The object is the last that does not begin after the patch.
fn instance(patch_id: u32) -> Instance {
    if (frame.flags & FLAG_INSTANCES) == 0u {
        return Instance(patch_id, object_of(patch_id));
    }
    var low = 0u;
    var high = frame.object_count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        let is_low = objects[middle].first_patch <= patch_id;
        low = select(low, middle, is_low);
        high = select(middle, high, is_low);
    }
    return Instance(objects[low].first_record + patch_id - objects[low].first_patch, low);
}
