// Mirrors core/src/kernel/filter.rs: a pixel from the samples around it; an invocation a pixel.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> taps: array<Tap>;
@group(0) @binding(2) var<storage, read> samples: array<Sample>;
@group(0) @binding(3) var<storage, read> colours: array<Colour>;
@group(0) @binding(4) var<storage, read_write> pixels: array<Pixel>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let item = item_index(group, lane);
    let wide = frame.shown_right - frame.shown_left;
    if item < wide * (frame.shown_bottom - frame.shown_top) {
        pixels[item] = filtered(frame.shown_left + item % wide, frame.shown_top + item / wide);
    }
}

// The pixel in this column and row of the image.
fn filtered(column: u32, row: u32) -> Pixel {
    let bits = frame.pattern_bits;
    let columns = i32((frame.right - frame.left) << bits);
    let rows = i32((frame.bottom - frame.top) << bits);
    let first = vec2<i32>(i32((column - frame.left) << bits), i32((row - frame.top) << bits));
    var rgba = vec4<f32>(0.0, 0.0, 0.0, 0.0);
    var total = 0.0;
    var count = 0u;
    for (var tap = 0u; tap < frame.taps; tap++) {
        let x = first.x + taps[tap].column;
        let y = first.y + taps[tap].row;
        if x >= 0 && x < columns && y >= 0 && y < rows {
            rgba = with_sample(rgba, u32(y * columns + x), taps[tap].weight);
            total = add(total, taps[tap].weight);
            count += 1u;
        }
    }
    if count != frame.taps {
        let scale = recip(total);
        rgba = vec4<f32>(mul(rgba.x, scale), mul(rgba.y, scale), mul(rgba.z, scale), mul(rgba.w, scale));
    }
    rgba.w = clamp(rgba.w, 0.0, 1.0);
    return own_samples(u32(first.y * columns + first.x), u32(columns), rgba);
}

// What a sample adds to a pixel, if anything is there.
fn with_sample(rgba: vec4<f32>, place: u32, weight: f32) -> vec4<f32> {
    if samples[place].depth == 0u {
        return rgba;
    }
    let colour = colours[place].rgba;
    return vec4<f32>(
        add(rgba.x, mul(weight, colour[0])),
        add(rgba.y, mul(weight, colour[1])),
        add(rgba.z, mul(weight, colour[2])),
        add(rgba.w, mul(weight, colour[3])),
    );
}

// The pixel of this colour, with the nearest of its own samples, of which this is the first.
fn own_samples(first: u32, columns: u32, rgba: vec4<f32>) -> Pixel {
    let side = 1u << frame.pattern_bits;
    var nearest = Sample(0u, 0u, 0u, 0u);
    var covered = 0u;
    for (var own = 0u; own < side * side; own++) {
        let it = samples[first + (own >> frame.pattern_bits) * columns + (own & (side - 1u))];
        if it.depth != 0u {
            covered += 1u;
            if nearer(it, nearest) {
                nearest = it;
            }
        }
    }
    let colour = array<f32, 4>(rgba.x, rgba.y, rgba.z, rgba.w);
    return Pixel(colour, nearest.depth, nearest.patch_id, nearest.u, nearest.v, covered);
}
