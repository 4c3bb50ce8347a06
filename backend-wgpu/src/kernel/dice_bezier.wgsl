// No mirror in core: what stands in the place of `instance.wgsl`, `dice_any.wgsl` and all that it needs where all patches are
// Bezier patches that have their sides for themselves, none is displaced, and no two objects have the same ones.

const NETS: u32 = 1u;

struct Instance {
    record: u32,
    object: u32,
}

fn instance(patch_id: u32) -> Instance {
    return Instance(patch_id, object_of(patch_id));
}

fn net_count() -> u32 {
    return NETS;
}

fn is_owned_by_others() -> bool {
    return false;
}

fn prepare_nets(placed: Instance, lane: u32) {
    if lane < 48u {
        nets[lane] = transformed(placed.record, placed.object, lane / 16u, lane % 16u);
    }
}

fn evaluate_on_border(record: u32, at: vec2<u32>) -> Evaluated {
    return evaluate_moved(Owner(0u, at.x, at.y));
}

fn dice_any(draw: Draw, placed: Instance, row: u32, column: u32) -> Diced {
    let evaluated = evaluate_bezier(draw, row, column);
    let at = vertex_of(draw, row, column);
    return Diced(evaluated.point, normal_of(evaluated, Owner(0u, at.x, at.y)));
}
