// Mirrors core/src/kernel/blend.rs: the layer that was just found goes behind those that were found before.

// Is (patch, u, v) of `a` before that of `b`?
static bool comes_before(Sample a, Sample b) {
    if (a.patch_id != b.patch_id) {
        return a.patch_id < b.patch_id;
    }
    return a.u != b.u ? a.u < b.u : a.v < b.v;
}

// Is `new_sample` behind the last layer that was found?
static bool is_behind(Sample new_sample, Sample last) {
    if (last.depth == 0u) {
        return true;
    }
    return new_sample.depth != last.depth ? new_sample.depth < last.depth : comes_before(last, new_sample);
}

// All layers so far, with another one behind them.
static Colour blended(uint zero, Colour layers, Colour found) {
    const float opacity = found.rgba[3];
    const float share = mul(sub(1.0f, layers.rgba[3]), opacity);
    for (uint k = 0u; k < 3u; k++) {
        layers.rgba[k] = add(layers.rgba[k], mul(share, found.rgba[k]));
    }
    layers.rgba[3] = opacity >= 1.0f ? 1.0f : add(layers.rgba[3], share);
    return layers;
}

__kernel void stage_blend(__global Sample *samples, __global const Colour *colours, __global Sample *behind,
                          __global Sample *front, __global Colour *layers, __global uint *more, uint count) {
    const uint index = get_global_id(0);
    if (index >= count || samples[index].depth == 0u) {
        return;
    }
    const Sample found = samples[index], none = {0u, 0u, 0u, 0u};
    // The sign of 1 / distance is a zero that no compiler knows of.
    const uint zero = found.depth >> 31;
    const bool is_opaque = colours[index].rgba[3] >= 1.0f;
    if (front[index].depth == 0u) {
        front[index] = found;
    }
    layers[index] = blended(zero, layers[index], colours[index]);
    behind[index] = found;
    if (is_opaque) {
        behind[index].depth = OPAQUE_DEPTH;
    } else {
        *more = 1u; // whoever writes, it is the same
    }
    samples[index] = none;
}
