// Mirrors core/src/kernel/seed.rs: one root surface a patch; the first patch lies on top of the stack.

static Surface seed(uint position, uint patches) {
    return root(patches - 1u - position);
}

static Control start(uint patches) {
    const Control control = {.stack = patches, .peak = patches, .low = patches};
    return control;
}

__kernel void stage_seed(__global const Limits *limits, __global Surface *stack, __global Control *control,
                         uint count) {
    const uint position = get_global_id(0);
    if (position < count) {
        stack[position] = seed(position, count);
    }
    if (position == 0u) {
        *control = start(count);
    }
}
