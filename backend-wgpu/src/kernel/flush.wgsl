// Mirrors core/src/kernel/take.rs (flush): forgets the draws that have been diced.

@group(0) @binding(0) var<storage, read_write> control: Control;

@compute @workgroup_size(1)
fn main() {
    control.waiting = 0u;
    control.fresh = 0u;
}
