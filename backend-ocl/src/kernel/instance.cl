// Mirrors core/src/patch/instance.rs: objects may have the same patches, which are then numbered object by object.

// Record and object that a patch's number stands for.
typedef struct {
    uint record;
    uint object;
} Instance;

// The object is the last that does not begin after the patch.
static Instance instance(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                         uint patch_id) {
    if ((frame->flags & FLAG_INSTANCES) == 0u) {
        const Instance only = {patch_id, patches[patch_id].object};
        return only;
    }
    uint low = 0u, high = frame->object_count;
    while (high - low > 1u) {
        const uint half_way = (low + high) / 2u;
        if (objects[half_way].first_patch <= patch_id) {
            low = half_way;
        } else {
            high = half_way;
        }
    }
    const Instance found = {objects[low].first_record + patch_id - objects[low].first_patch, low};
    return found;
}
