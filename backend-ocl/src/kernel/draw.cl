// Mirrors core's fused stage Draw: dice.rs, shade.rs and sample.rs of core/src/kernel, a grid at a time.
//
// A work-group owns a tile of the image. It goes through all draws, 64 at a time, and dices, shades and
// samples those that can touch its tile. Barriers are reached by all work-items alike.

static bool touches(Draw draw, int4 box) {
    const int left = draw.columns & 0xffffu, right = draw.columns >> 16;
    const int top = draw.rows & 0xffffu, bottom = draw.rows >> 16;
    return left < box.y && right > box.x && top < box.w && bottom > box.z;
}

// The tile of this work-group, cut off at the image's border.
static int4 tile_box(__constant Frame *frame) {
    const int left = get_group_id(0) * TILE, top = get_group_id(1) * TILE;
    return (int4)(left, lesser(left + (int)TILE, frame->width), top, lesser(top + (int)TILE, frame->height));
}

static void clear(__local Tile *tile, uint lane) {
    for (uint pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        tile->depth[pixel] = 0u;
        tile->cell[pixel] = NO_CELL;
    }
}

// Fills the grid: net, then curves and seams, then vertices and their colours.
static void dice_and_shade(__constant Frame *frame, __global const Object *object,
                           __global const Patch *patch, Surface surface, __local Grid *grid, uint lane) {
    dice_net(frame->zero, patch, object, grid, lane);
    barrier(CLK_LOCAL_MEM_FENCE);
    dice_curves(frame, surface, grid, lane);
    if (lane >= GROUP - 4u) {
        grid->seams[lane + 4u - GROUP] = seam_of(frame, &grid->net, surface, lane + 4u - GROUP);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint vertices = grid->stride * grid->stride;
    for (uint at = lane; at < vertices; at += GROUP) {
        float3 position, normal;
        dice_vertex(frame, surface, grid, at, &position, &normal);
        const float3 colour = shade(frame, object, position, normal);
        grid->colour[0][at] = colour.x;
        grid->colour[1][at] = colour.y;
        grid->colour[2][at] = colour.z;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// Is the grid to be drawn? All work-items get the same answer.
static bool is_shown(__constant Frame *frame, __local Grid *grid, uint lane) {
    const uint rate = frame->rate;
    if (!(frame->flags & FLAG_CULL_BACKFACES)) {
        return true;
    }
    for (uint item = lane; item < rate * rate; item += GROUP) {
        if (faces_the_eye(grid, (Place)(item % rate, item / rate))) {
            grid->facing = 1u; // whoever writes, it is the same
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return grid->facing != 0u;
}

// Shows what the tile's pixels have found, where it is nearer than what they have, and forgets it.
static void keep_nearest(Sampler *s, __global Sample *samples, __global Colour *colours, uint lane) {
    for (uint pixel = lane; pixel < TILE_PIXELS; pixel += GROUP) {
        const uint cell = s->tile->cell[pixel];
        if (cell != NO_CELL) {
            const uint column = s->box.x + pixel % TILE, row = s->box.z + pixel / TILE;
            const ulong at = (ulong)row * s->frame->width + column;
            const Place place = place_of(cell);
            const Sample found = sample_of(s->frame, s->surface, place, s->tile->depth[pixel]);
            if (nearer(found, samples[at])) {
                samples[at] = found;
                colours[at] = cell_colour(s->frame->zero, s->grid, place);
            }
            s->tile->depth[pixel] = 0u;
            s->tile->cell[pixel] = NO_CELL;
        }
    }
}

__kernel __attribute__((reqd_work_group_size(GROUP, 1, 1)))
void stage_draw(__constant Frame *frame, __global const Object *objects, __global const Patch *patches,
                __global const Control *control, __global const Draw *draws, __global Sample *samples,
                __global Colour *colours) {
    __local Grid grid;
    __local Tile tile;
    const uint lane = get_local_id(0);
    const uint count = control->waiting + control->fresh;
    const int4 box = tile_box(frame);
    clear(&tile, lane);
    for (uint first = 0u; first < count; first += GROUP) {
        if (lane == 0u) {
            tile.listed = 0u;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        if (first + lane < count && touches(draws[first + lane], box)) {
            tile.list[atomic_inc(&tile.listed)] = first + lane;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint entry = 0u; entry < tile.listed; entry++) {
            const Surface surface = surface_of(draws[tile.list[entry]]);
            __global const Patch *patch = patches + surface.patch_id;
            dice_and_shade(frame, objects + patch->object, patch, surface, &grid, lane);
            if (is_shown(frame, &grid, lane)) {
                Sampler s = {frame, &grid, &tile, surface, box, false, false};
                uint hits = 0xffffffffu;
                for (uint time = 0u; time < 2u; time++) {
                    s.second_time = time == 1u;
                    hits = sample_share(&s, lane, hits);
                    barrier(CLK_LOCAL_MEM_FENCE);
                }
                keep_nearest(&s, samples, colours, lane);
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
