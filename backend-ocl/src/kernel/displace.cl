// Mirrors core/src/kernel/displace.rs: vertices move along their normals, by bumps that are a function of where they
// are in object space.

// A number that varies in space, and its derivatives along x, y and z.
typedef struct {
    float value;
    float3 slope;
} Bump;

// From 0 to 1, smooth to the second derivative at both ends, and its derivative.
static float2 fade(uint zero, float t) {
    const float s = sub(1.0f, t), tt = mul(t, t);
    const float inner = add(mul(t, sub(mul(6.0f, t), 15.0f)), 10.0f);
    return (float2)(mul(mul(tt, t), inner), mul(30.0f, mul(tt, mul(s, s))));
}

// The same of a coordinate in its cell, at whose side it may as well be.
static float2 fade_within(uint zero, float coordinate, int cell) {
    const float within = sub(coordinate, number(cell));
    return fade(zero, within < LATTICE_NEAR ? 0.0f : within);
}

// Every bit of the result depends on every bit given.
static uint mixed(uint hash) {
    const uint first = (hash ^ hash >> 16) * HASH_FIRST;
    const uint second = (first ^ first >> 15) * HASH_SECOND;
    return second ^ second >> 16;
}

// The height at a point of the lattice: -1 ..< 1, exactly.
static float lattice(uint zero, int x, int y, int z, uint octave) {
    const uint place = (uint)x * HASH_X ^ (uint)y * HASH_Y ^ (uint)z * HASH_Z;
    const uint hash = mixed(place + octave * HASH_OCTAVE);
    return sub(mul(number((int)(hash >> 8)), LATTICE_STEP), 1.0f);
}

// Noise between the corners of a unit square, z = constant.
static Bump square(uint zero, int3 cell, uint octave, float3 weight, float3 slope) {
    const float a = lattice(zero, cell.x, cell.y, cell.z, octave);
    const float b = lattice(zero, cell.x + 1, cell.y, cell.z, octave);
    const float c = lattice(zero, cell.x, cell.y + 1, cell.z, octave);
    const float d = lattice(zero, cell.x + 1, cell.y + 1, cell.z, octave);
    const float low = between(zero, a, b, weight.x), high = between(zero, c, d, weight.x);
    const float low_slope = mul(sub(b, a), slope.x), high_slope = mul(sub(d, c), slope.x);
    const float across = between(zero, low_slope, high_slope, weight.y);
    const Bump found = {between(zero, low, high, weight.y), (float3)(across, mul(sub(high, low), slope.y), 0.0f)};
    return found;
}

// Value noise: from -1 to 1, with one value a unit cube's corner.
static Bump noise(uint zero, float3 point, uint octave) {
    const float3 p = (float3)(clamp(flush(point.x), neg(LATTICE_END), LATTICE_END),
                              clamp(flush(point.y), neg(LATTICE_END), LATTICE_END),
                              clamp(flush(point.z), neg(LATTICE_END), LATTICE_END));
    const int3 cell = (int3)(floor(p.x), floor(p.y), floor(p.z));
    const float2 x = fade_within(zero, p.x, cell.x), y = fade_within(zero, p.y, cell.y);
    const float2 z = fade_within(zero, p.z, cell.z);
    const float3 weight = (float3)(x.x, y.x, z.x), slope = (float3)(x.y, y.y, z.y);
    const Bump low = square(zero, cell, octave, weight, slope);
    const Bump high = square(zero, cell + (int3)(0, 0, 1), octave, weight, slope);
    const Bump found = {between(zero, low.value, high.value, weight.z),
                        (float3)(between(zero, low.slope.x, high.slope.x, weight.z),
                                 between(zero, low.slope.y, high.slope.y, weight.z),
                                 mul(sub(high.value, low.value), slope.z))};
    return found;
}

// How far a point of an object is displaced, in object units.
static Bump bump(uint zero, __global const Object *object, float3 point) {
    float height = object->height, frequency = object->frequency;
    Bump sum = {0.0f, (float3)(0.0f, 0.0f, 0.0f)};
    for (uint octave = 0u; octave < object->octaves; octave++) {
        const Bump one = noise(zero, scale3(point, frequency), octave);
        sum.value = add(sum.value, flush(mul(height, one.value)));
        sum.slope = add3(sum.slope, flush3(scale3(one.slope, mul(height, frequency))));
        height = mul(0.5f, height);
        frequency = mul(2.0f, frequency);
    }
    return sum;
}

// Displaces a point with a unit normal, which is then of another length; both in the space of their object.
static void displace(uint zero, __global const Object *object, float3 *point, float3 *normal) {
    const Bump here = bump(zero, object, *point);
    const float3 along = add3(here.slope, scale3(*normal, neg(dot3(here.slope, *normal))));
    *point = add3(*point, scale3(*normal, here.value));
    *normal = add3(*normal, scale3(along, -1.0f));
}

// Position and unit normal of one vertex of a grid, where its sources are; or, of an object that is displaced, both
// displaced, and yet to be moved with `place_vertex`.
INLINED void position_and_normal(__constant Frame *frame, __global const Object *object, __global const Patch *patch,
                                 __local const Grid *grid, uint2 at, uint row, uint column, float3 *position,
                                 float3 *normal) {
    const uint zero = frame->zero;
    const Owner owner = is_displaced(object) ? owner_of(patch, at) : new_owner(0u, at);
    float3 du, dv;
    evaluate_any(frame, grid, owner, row, column, position, &du, &dv);
    *normal = normal_of(zero, grid->sources + owner.slot, owner.at, du, dv);
    if (is_displaced(object)) {
        displace(zero, object, position, normal);
    } else if (has_halves(patch)) {
        *position = join(zero, patch, grid, at, *position);
    }
}

// What turns normals as a transform does points: a row a coordinate.
typedef struct {
    float3 x;
    float3 y;
    float3 z;
} NormalTransform;

static NormalTransform normal_to_eye_of(__global const Object *object) {
    const NormalTransform transform = {vload3(0, object->normal_to_eye), vload3(1, object->normal_to_eye),
                                       vload3(2, object->normal_to_eye)};
    return transform;
}

// The unit vector of a normal, turned with its object, or otherwise.
static float3 normal_to_eye(uint zero, NormalTransform transform, float3 normal) {
    const float3 even = scale3(normal, unit_scale(largest3(normal)));
    const float3 there = (float3)(dot3(transform.x, even), dot3(transform.y, even), dot3(transform.z, even));
    const float3 even_there = scale3(there, unit_scale(largest3(there)));
    const float3 found = scale3(even_there, rsqrt(max(dot3(even_there, even_there), SHADE_TINY)));
    return largest3(found) > 0.5f ? flush3(found) : (float3)(0.0f, 0.0f, 1.0f);
}

// Moves a displaced vertex out of the space of its object.
static void place_vertex(uint zero, Transform points, NormalTransform normals, float3 *position, float3 *normal) {
    *position = point_to_eye(zero, points, *position);
    *normal = normal_to_eye(zero, normals, *normal);
}
