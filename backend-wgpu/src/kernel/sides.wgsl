// Mirrors core/src/kernel/sides.rs: how the four sides of a surface are divided, and how finely its grid is diced.

// Lengths in pixels: of the longest lines of the surface along u and along v, and of its sides; or how far it is from
// being flat.
struct Lengths {
    u: f32,
    v: f32,
    sides: vec4<f32>,
}

// Of a surface whose control polygons along u and along v are so long, each in order.
fn lengths_of_polygons(u: vec4<f32>, v: vec4<f32>) -> Lengths {
    return Lengths(longest(u), longest(v), vec4<f32>(u.xw, v.xw));
}

// A surface is no shorter than its sides.
fn with_own_sides(lengths: Lengths, sides: vec4<f32>) -> Lengths {
    return Lengths(
        max(lengths.u, max(sides.x, sides.y)),
        max(lengths.v, max(sides.z, sides.w)),
        sides,
    );
}

// Lengths of sides with another one of this side.
fn with_side(sides: vec4<f32>, side: u32, length: f32) -> vec4<f32> {
    return select(sides, vec4<f32>(length), vec4<u32>(0u, 1u, 2u, 3u) == vec4<u32>(side));
}

fn side_length(sides: vec4<f32>, side: u32) -> f32 {
    let pair = select(sides.xy, sides.zw, side > 1u);
    return select(pair.x, pair.y, (side & 1u) != 0u);
}

fn longest(all: vec4<f32>) -> f32 {
    return max(max(all.x, all.y), max(all.z, all.w));
}

// Length of a polygon of three pieces; the same from either end.
fn polygon(a: f32, b: f32, c: f32) -> f32 {
    return add(add(a, c), b);
}

// Steps of a line that is so long on screen.
fn steps_of(length: f32) -> u32 {
    let steps = clamp(mul(length, frame.density), 1.0, float(i32(frame.rate)));
    return u32(0 - floor(neg(steps)));
}

// How the sides of a surface are divided, packed: as they were, unless they are live and short enough; or long, but
// may not be halved any more.
fn divide(surface: Surface, lengths: Lengths, code: u32) -> vec4<u32> {
    return vec4<u32>(
        divide_side(surface, 0u, lengths.sides.x, code),
        divide_side(surface, 1u, lengths.sides.y, code),
        divide_side(surface, 2u, lengths.sides.z, code),
        divide_side(surface, 3u, lengths.sides.w, code),
    );
}

fn divide_side(surface: Surface, side: u32, length: f32, code: u32) -> u32 {
    let known = chosen(sides_of(surface), side);
    let bits = extent_of(surface, side).bits;
    let is_last = code == DRAW_LIMITED || (length <= frame.bound && !stays_live(surface, side));
    let is_short = is_last && (frame.flags & FLAG_NAIVE) == 0u;
    let is_live = unpacked(known).steps == 0u;
    return select(known, packed(Side(steps_of(length), bits)), is_live && is_short);
}

// Micropolygons along u and along v of a surface whose sides are divided.
fn rates_for(surface: Surface, lengths: Lengths) -> vec2<u32> {
    if (frame.flags & FLAG_FIXED) != 0u {
        return vec2<u32>(frame.rate);
    }
    return vec2<u32>(least_rate(surface, lengths.u, 0u), least_rate(surface, lengths.v, 2u));
}

// Enough for this length, and for every vertex of two sides.
fn least_rate(surface: Surface, length: f32, first: u32) -> u32 {
    let own = steps_of(length);
    let of_first = steps_needed(surface, first);
    let of_second = steps_needed(surface, first + 1u);
    let most = select(of_second, of_first, of_first > of_second);
    return select(most, own, own > most);
}

// What lies between these numbers.
struct Reach {
    low: f32,
    high: f32,
}

fn joined(a: Reach, b: Reach) -> Reach {
    return Reach(min(a.low, b.low), max(a.high, b.high));
}

// Where corners are that have strayed from a surface: it is drawn as far as there. If there are none, nowhere.
struct Strays {
    x: Reach,
    y: Reach,
    // Smallest and largest distance from the eye plane.
    distances: Reach,
    exist: bool,
}

// Farther than anything is.
const NOWHERE: f32 = 1e30;

// As many turns as corners have strayed, since a software device goes through all of a branch that it does not take.
fn strays_of(surface: Surface, hull: Hull) -> Strays {
    var left = strayed_corners(surface);
    let nowhere = Reach(NOWHERE, neg(NOWHERE));
    var strays = Strays(nowhere, nowhere, nowhere, left != 0u);
    while left != 0u {
        let at = corner_at(surface, firstTrailingBit(left));
        let own = stray_at(position_any(hull, at.x, at.y));
        strays.x = joined(strays.x, own.x);
        strays.y = joined(strays.y, own.y);
        strays.distances = joined(strays.distances, own.distances);
        left &= left - 1u;
    }
    return strays;
}

// Mirrors core/src/kernel/dice.rs (position_at): a vertex by itself.
fn position_at(net: Net, u: u32, v: u32) -> vec3<f32> {
    let row = cubic(param(v));
    let weights = cubic(param(u));
    return vec3<f32>(
        coordinate_at(net.x, weights, row),
        coordinate_at(net.y, weights, row),
        coordinate_at(net.z, weights, row),
    );
}

fn coordinate_at(points: array<f32, 16>, weights: vec4<f32>, row: vec4<f32>) -> f32 {
    var c = points;
    return blend4(weights, vec4<f32>(
        blend4(row, vec4<f32>(c[0], c[1], c[2], c[3])),
        blend4(row, vec4<f32>(c[4], c[5], c[6], c[7])),
        blend4(row, vec4<f32>(c[8], c[9], c[10], c[11])),
        blend4(row, vec4<f32>(c[12], c[13], c[14], c[15])),
    ));
}
