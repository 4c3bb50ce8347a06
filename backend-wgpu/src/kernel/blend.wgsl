// Mirrors core/src/kernel/blend.rs (blend): the layer that was just found goes behind those before it; an invocation a
// sample.

@group(0) @binding(0) var<storage, read_write> samples: array<Sample>;
@group(0) @binding(1) var<storage, read> colours: array<Colour>;
@group(0) @binding(2) var<storage, read_write> behind: array<Sample>;
@group(0) @binding(3) var<storage, read_write> front: array<Sample>;
@group(0) @binding(4) var<storage, read_write> layers: array<Colour>;
@group(0) @binding(5) var<storage, read_write> more: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let item = item_index(group, lane);
    if item < arrayLength(&samples) && samples[item].depth != 0u {
        // There is no frame; but a depth has no sign, which only we know.
        ZERO = samples[item].depth >> 31u;
        blend(item);
        samples[item] = Sample(0u, 0u, 0u, 0u);
    }
}

fn blend(item: u32) {
    let found = samples[item];
    if front[item].depth == 0u {
        front[item] = found;
    }
    let colour = colours[item].rgba;
    let opacity = colour[3];
    let is_opaque = opacity >= 1.0;
    let before = layers[item].rgba;
    let share = mul(sub(1.0, before[3]), opacity);
    layers[item] = Colour(array<f32, 4>(
        add(before[0], mul(share, colour[0])),
        add(before[1], mul(share, colour[1])),
        add(before[2], mul(share, colour[2])),
        select(add(before[3], share), 1.0, is_opaque),
    ));
    let depth = select(found.depth, OPAQUE_DEPTH, is_opaque);
    behind[item] = Sample(depth, found.patch_id, found.u, found.v);
    if !is_opaque {
        more[0] = 1u;
    }
}
