// Mirrors core/src/kernel/dice_any.rs: which way a surface's patch and its object need.
//
// Net 0 is the patch's own, net w + 1 that of the owner that word w names. If the object is not displaced, only those are
// there that own a side of which the patch's is half.

const NETS: u32 = 9u;
const SIDE_NETS: u32 = 5u;
// Kinds of patches: how they are evaluated.
const IS_BEZIER: u32 = 0u;
const IS_GREGORY: u32 = 1u;
const IS_RATIONAL: u32 = 2u;

// The kind of each net's patch.
var<workgroup> kinds: array<u32, NETS>;
// What patches have besides their nets: of net n from 24 n on. Face points: coordinate k of point l at 8 k + l; or weights.
var<workgroup> besides: array<f32, 24u * NETS>;

// Is the patch's object displaced? Then all nets are in its space, not in eye space.
var<private> IS_DISPLACED: bool;
// What the patch is, where sides are halves of others' and it is not displaced; else 0.
var<private> JOINED_KIND: u32;

// As many nets as the patch needs.
fn net_count() -> u32 {
    return select(select(1u, SIDE_NETS, has_joined_sides()), NETS, IS_DISPLACED);
}

fn has_joined_sides() -> bool {
    return (JOINED_KIND & (KIND_HALVED << KIND_HALF_SHIFT)) != 0u;
}

// Do vertices of the border lie elsewhere than where the patch has them?
fn is_owned_by_others() -> bool {
    return IS_DISPLACED || has_joined_sides();
}

// The net of a patch, and those that its border needs.
fn prepare_nets(placed: Instance, lane: u32) {
    IS_DISPLACED = objects[placed.object].reach > 0.0;
    let is_plain = faces_of(placed.record) == 0u && !IS_DISPLACED;
    JOINED_KIND = select(0u, kind_of(placed.record), is_plain);
    for (var n = 0u; n < net_count(); n++) {
        prepare_net(n, Instance(patch_of_net(placed.record, n), placed.object), lane);
    }
}

// The patch whose net has a number; the patch itself where no other one is its owner.
fn patch_of_net(record: u32, n: u32) -> u32 {
    if n > 0u {
        let word = owner_word(record, n - 1u);
        if word != 0u {
            return (word >> OWNER_SHIFT) - 1u;
        }
    }
    return record;
}

// Control points of net n, which is that of a patch, and what it has besides.
fn prepare_net(n: u32, placed: Instance, lane: u32) {
    let more = faces_of(placed.record);
    let is_rational = (kind_of(placed.record) & KIND_RATIONAL) != 0u;
    if lane == 0u {
        kinds[n] = select(select(IS_GREGORY, IS_RATIONAL, is_rational), IS_BEZIER, more == 0u);
    }
    if lane < 48u {
        nets[48u * n + lane] = source(placed, lane / 16u, lane % 16u);
    }
    if lane < 24u {
        let weight = control_point(more, lane % 16u).x;
        let point = source(Instance(more, placed.object), lane / 8u, lane % 8u);
        besides[24u * n + lane] = select(point, weight, is_rational);
    }
}

// One coordinate (0, 1, 2) of control point `l`, as nets have it.
fn source(placed: Instance, k: u32, l: u32) -> f32 {
    let point = control_point(placed.record, l);
    if IS_DISPLACED {
        return point[k];
    }
    return coordinate_to_eye(placed.object, k, point);
}

// Mirrors core/src/patch/owner.rs: where a vertex of a patch is evaluated: if the patch is displaced, on the vertex's
// owner.
fn owner_of(record: u32, at: vec2<u32>) -> Owner {
    let which = word_for(at.x, at.y);
    if IS_DISPLACED && which != NO_WORD {
        let word = owner_word(record, which);
        if word != 0u {
            let there = place_on(word, select(at.y, at.x, which < 2u));
            return Owner(which + 1u, there.x, there.y);
        }
    }
    return Owner(0u, at.x, at.y);
}

// A vertex on the border of a Bezier patch, where that of a larger patch has it if its side is half of the larger one's.
fn evaluate_on_border(record: u32, at: vec2<u32>) -> Evaluated {
    var evaluated = evaluate_moved(owner_of(record, at));
    let side = joined_side(JOINED_KIND, at);
    if side < 4u {
        let there = joined_place(owner_word(record, side), side, at);
        evaluated.point = moved_point(Owner(side + 1u, there.x, there.y));
    }
    return evaluated;
}

// The point alone, on a Bezier patch.
fn moved_point(at: Owner) -> vec3<f32> {
    let row = cubic(param(at.v));
    let column = cubic(param(at.u));
    return vec3<f32>(
        blend4(column, curve_point(at.n, 0u, row)),
        blend4(column, curve_point(at.n, 1u, row)),
        blend4(column, curve_point(at.n, 2u, row)),
    );
}

// Position and unit normal of a vertex of any patch.
fn dice_any(draw: Draw, placed: Instance, row: u32, column: u32) -> Diced {
    let owner = owner_of(placed.record, vertex_of(draw, row, column));
    let evaluated = evaluate_any(draw, row, column, owner);
    let diced = Diced(evaluated.point, normal_of(evaluated, owner));
    if IS_DISPLACED {
        return displaced(placed.object, diced);
    }
    return diced;
}

// On a Bezier patch `prepare` has done most of it, on the border all.
fn evaluate_any(draw: Draw, row: u32, column: u32, owner: Owner) -> Evaluated {
    let kind = kinds[owner.n];
    if kind == IS_GREGORY {
        return evaluate_gregory(owner);
    }
    if kind == IS_RATIONAL {
        return evaluate_rational(owner);
    }
    return evaluate_bezier(draw, row, column);
}
