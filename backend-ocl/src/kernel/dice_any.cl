// Mirrors core/src/kernel/dice_any.rs: a vertex of any surface, which way its patch needs.

// Position of one vertex of a grid, and the derivatives there; `row` and `column` are where it is in the grid.
static void evaluate_any(__constant Frame *frame, __local const Grid *grid, Owner owner, uint row, uint column,
                         float3 *position, float3 *du, float3 *dv) {
    __local const Source *source = grid->sources + owner.slot;
    const uint2 at = owner.at;
    if (source->has == HAS_WEIGHTS) {
        evaluate_rational(frame->zero, source, at, position, du, dv);
    } else if (source->has == HAS_FACES) {
        evaluate_gregory(frame, source, at, position, du, dv);
    } else if (owner.slot != 0u || at.x != grid->column_u[column] || at.y != grid->row_v[row]) {
        evaluate_moved(frame->zero, source, at, position, du, dv);
    } else {
        evaluate(frame->zero, grid, row, column, position, du, dv);
    }
}

// Where a vertex is that lies on a side that is half of another patch's, or does not and is at `position`.
static float3 join(uint zero, __global const Patch *patch, __local const Grid *grid, uint2 at, float3 position) {
    const Owner owner = joined_of(patch, at);
    if (owner.slot == 0u) {
        return position;
    }
    float3 there, du, dv;
    evaluate_moved(zero, grid->sources + owner.slot, owner.at, &there, &du, &dv);
    return there;
}
