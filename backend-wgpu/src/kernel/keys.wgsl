// Mirrors core/src/kernel/sort_last.rs (NOBODY): keys as the device has them. A word each for depth, patch, u and v, so
// that the largest of each wins, and a key that nobody has is 0.

const KEY_WORDS: u32 = 4u;

fn key_of(it: Sample) -> vec4<u32> {
    return vec4<u32>(it.depth, ~it.patch_id, ~it.u, ~it.v);
}

// The sample that has a key.
fn keyed(key: vec4<u32>) -> Sample {
    return Sample(key.x, ~key.y, ~key.z, ~key.w);
}
