// Mirrors core/src/kernel/split.rs: children stay where their parent was, the rest is to be drawn.

static void split(Control control, Surface surface, Verdict verdict, Slot slot, __global Surface *stack,
                  __global Draw *draws) {
    const uint place = control.base + 2u * slot.splits;
    if (verdict.code == SPLIT_U || verdict.code == SPLIT_V) {
        const Halves halves = halves_of(surface, verdict);
        stack[place] = halves.low;
        stack[place + 1u] = halves.high;
    } else if (verdict.code != CULL) {
        draws[control.waiting + slot.draws] = new_draw(surface, verdict);
    }
}

__kernel void stage_split(__global const Control *control, __global const Surface *batch,
                          __global const Verdict *verdicts, __global const Slot *slots,
                          __global Surface *stack, __global Draw *draws) {
    const uint index = get_global_id(0);
    if (control->overflow == 0u && index < control->taken) {
        split(*control, batch[index], verdicts[index], slots[index], stack, draws);
    }
}
