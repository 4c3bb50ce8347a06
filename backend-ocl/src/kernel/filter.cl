// Mirrors core/src/kernel/filter.rs: a pixel from the samples around it, weighted, and what its own nearest shows.

// The pixel of this colour, with the nearest of its own `side` x `side` samples.
static Pixel own_samples(int side, __global const Sample *samples, int first, int columns, const float *rgba) {
    Sample nearest = {0u, 0u, 0u, 0u};
    uint covered = 0u;
    for (int row = 0; row < side; row++) {
        for (int column = 0; column < side; column++) {
            const Sample sample = samples[first + row * columns + column];
            if (sample.depth != 0u) {
                covered += 1u;
                nearest = nearer(sample, nearest) ? sample : nearest;
            }
        }
    }
    const Pixel pixel = {{rgba[0], rgba[1], rgba[2], rgba[3]}, nearest.depth, nearest.patch_id, nearest.u, nearest.v,
                         covered};
    return pixel;
}

// The weighted colour of a pixel whose first sample is in this column and row of the buffers' `columns` x `rows`.
static void filtered(__constant Frame *frame, __global const Tap *taps, __global const Sample *samples,
                     __global const Colour *colours, int2 first, int columns, int rows, float *rgba) {
    const uint zero = frame->zero;
    float total = 0.0f;
    uint count = 0u;
    for (uint tap = 0u; tap < frame->taps; tap++) {
        const int x = first.x + taps[tap].column, y = first.y + taps[tap].row;
        if (x < 0 || x >= columns || y < 0 || y >= rows) {
            continue;
        }
        const int place = y * columns + x;
        for (uint k = 0u; samples[place].depth != 0u && k < 4u; k++) {
            rgba[k] = add(rgba[k], mul(taps[tap].weight, colours[place].rgba[k]));
        }
        total = add(total, taps[tap].weight);
        count += 1u;
    }
    const float scale = recip(total);
    for (uint k = 0u; count != frame->taps && k < 4u; k++) {
        rgba[k] = mul(rgba[k], scale);
    }
    rgba[3] = clamp(rgba[3], 0.0f, 1.0f);
}

__kernel void stage_filter(__constant Frame *frame, __global const Tap *taps, __global const Sample *samples,
                           __global const Colour *colours, __global Pixel *pixels, uint count) {
    const uint index = get_global_id(0), across = frame->shown_right - frame->shown_left;
    if (index >= count) {
        return;
    }
    const uint bits = frame->pattern_bits;
    const uint column = frame->shown_left + index % across, row = frame->shown_top + index / across;
    const int columns = (int)((frame->right - frame->left) << bits), rows = (int)((frame->bottom - frame->top) << bits);
    const int2 first = (int2)((int)((column - frame->left) << bits), (int)((row - frame->top) << bits));
    float rgba[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    filtered(frame, taps, samples, colours, first, columns, rows, rgba);
    pixels[index] = own_samples(1 << bits, samples, first.y * columns + first.x, columns, rgba);
}
