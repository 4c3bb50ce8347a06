// Mirrors core/src/kernel/sample.rs (nearer): the order in which samples hide each other.

// Is `new` to be shown rather than `old`?
fn nearer(new_sample: Sample, old: Sample) -> bool {
    if new_sample.depth != old.depth {
        return new_sample.depth > old.depth;
    }
    if new_sample.patch_id != old.patch_id {
        return new_sample.patch_id < old.patch_id;
    }
    if new_sample.u != old.u {
        return new_sample.u < old.u;
    }
    return new_sample.v < old.v;
}
