// Mirrors core/src/kernel/split.rs: children stay where their parent was; the rest is to be drawn. Where stack and
// draws lie is for the kernels to say (`put_surface`, `put_draw`).

fn split(control: Control, surface: Surface, verdict: Verdict, slot: Slot) {
    let place = control.base + 2u * slot.splits;
    switch verdict.code {
        case CULL: {}
        case SPLIT_U, SPLIT_V: {
            let children = halves(surface, verdict);
            put_surface(place, children.low);
            put_surface(place + 1u, children.high);
        }
        default: {
            put_draw(control.waiting + slot.draws, draw_of(surface, verdict));
        }
    }
}
