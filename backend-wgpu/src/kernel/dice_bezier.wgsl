// No mirror in core: what stands in the place of `dice_gregory.wgsl`, `owner.wgsl` and `displace.wgsl` where all
// patches are Bezier patches and none is displaced.

const NETS: u32 = 1u;
const IS_DISPLACED: bool = false;

fn prepare_nets(patch_id: u32, lane: u32) {
    if lane < 48u {
        nets[lane] = transformed(patch_id, lane / 16u, lane % 16u);
    }
}

fn owner_of(patch_id: u32, at: vec2<u32>) -> Owner {
    return Owner(0u, at.x, at.y);
}

fn dice_any(draw: Draw, object: u32, row: u32, column: u32) -> Diced {
    let evaluated = evaluate_bezier(draw, row, column);
    let own = owner_of(draw.patch_id, vertex_of(draw, row, column));
    return Diced(evaluated.point, normal_of(evaluated, own));
}
