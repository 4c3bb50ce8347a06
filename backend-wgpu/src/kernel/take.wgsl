// Mirrors core/src/kernel/take.rs (take): the next batch is the top of the stack.

@group(0) @binding(0) var<storage, read> limits: Limits;
@group(0) @binding(1) var<storage, read_write> control: Control;

@compute @workgroup_size(1)
fn main() {
    control = take(control, limits.batch);
}

fn take(before: Control, batch: u32) -> Control {
    var after = before;
    after.taken = select(batch, before.stack, before.stack < batch);
    after.base = before.stack - after.taken;
    after.low = select(before.low, after.base, after.base < before.low);
    after.waiting = before.waiting + before.fresh;
    after.fresh = 0u;
    return after;
}
