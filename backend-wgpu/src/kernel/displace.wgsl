// Mirrors core/src/kernel/displace.rs: vertices move along their normals, by bumps that are a function of where they
// are in object space.

// A number that varies in space, and its derivatives along x, y and z.
struct Bump {
    value: f32,
    slope: vec3<f32>,
}

// How far a point of an object is displaced.
fn bump_at(object: u32, point: vec3<f32>) -> Bump {
    var height = objects[object].height;
    var frequency = objects[object].frequency;
    var out = Bump(0.0, vec3<f32>(0.0, 0.0, 0.0));
    for (var octave = 0u; octave < objects[object].octaves; octave++) {
        let wave = noise(scale3(point, frequency), octave);
        out.value = add(out.value, flush(mul(height, wave.value)));
        out.slope = add3(out.slope, flush3(scale3(wave.slope, mul(height, frequency))));
        height = mul(0.5, height);
        frequency = mul(2.0, frequency);
    }
    return out;
}

// Value noise: from -1 to 1, with one value a unit cube's corner.
fn noise(point: vec3<f32>, octave: u32) -> Bump {
    let x = place_in_cell(point.x);
    let y = place_in_cell(point.y);
    let z = place_in_cell(point.z);
    let cell = vec3<i32>(x.cell, y.cell, z.cell);
    let low = square(cell, octave, x, y);
    let high = square(cell + vec3<i32>(0, 0, 1), octave, x, y);
    return Bump(
        between(low.value, high.value, z.weight),
        vec3<f32>(
            between(low.slope.x, high.slope.x, z.weight),
            between(low.slope.y, high.slope.y, z.weight),
            mul(sub(high.value, low.value), z.slope),
        ),
    );
}

// Where a coordinate is in the lattice: its cell, the weight of the cell's high end, and how that changes.
struct InCell {
    cell: i32,
    weight: f32,
    slope: f32,
}

fn place_in_cell(coordinate: f32) -> InCell {
    let c = clamp(flush(coordinate), neg(LATTICE_END), LATTICE_END);
    let cell = floor(c);
    let within = sub(c, float(cell));
    let faded = fade(select(within, 0.0, within < LATTICE_NEAR));
    return InCell(cell, faded.x, faded.y);
}

// The same between the corners of a unit square, the first of which is `first`.
fn square(first: vec3<i32>, octave: u32, x: InCell, y: InCell) -> Bump {
    let low = row_of_square(first, octave, x);
    let high = row_of_square(first + vec3<i32>(0, 1, 0), octave, x);
    return Bump(
        between(low.x, high.x, y.weight),
        vec3<f32>(between(low.y, high.y, y.weight), mul(sub(high.x, low.x), y.slope), 0.0),
    );
}

// Its value and slope along x between two corners.
fn row_of_square(first: vec3<i32>, octave: u32, x: InCell) -> vec2<f32> {
    let a = lattice(first, octave);
    let b = lattice(first + vec3<i32>(1, 0, 0), octave);
    return vec2<f32>(between(a, b, x.weight), mul(sub(b, a), x.slope));
}

// From 0 to 1, smooth to the second derivative at both ends, and its derivative.
fn fade(t: f32) -> vec2<f32> {
    let s = sub(1.0, t);
    let tt = mul(t, t);
    let inner = add(mul(t, sub(mul(6.0, t), 15.0)), 10.0);
    return vec2<f32>(mul(mul(tt, t), inner), mul(30.0, mul(tt, mul(s, s))));
}

// The height at a point of the lattice.
fn lattice(at: vec3<i32>, octave: u32) -> f32 {
    let place = bitcast<vec3<u32>>(at) * vec3<u32>(HASH_X, HASH_Y, HASH_Z);
    let hash = mixed((place.x ^ place.y ^ place.z) + octave * HASH_OCTAVE);
    return sub(mul(float(i32(hash >> 8u)), LATTICE_STEP), 1.0);
}

// Every bit of the result depends on every bit given.
fn mixed(hash: u32) -> u32 {
    let first = (hash ^ (hash >> 16u)) * HASH_FIRST;
    let second = (first ^ (first >> 15u)) * HASH_SECOND;
    return second ^ (second >> 16u);
}

// A vertex in its object's space, displaced and moved to eye space.
fn displaced(object: u32, vertex: Diced) -> Diced {
    let bump = bump_at(object, vertex.point);
    let along = add3(bump.slope, scale3(vertex.normal, neg(dot3(bump.slope, vertex.normal))));
    let point = add3(vertex.point, scale3(vertex.normal, bump.value));
    let normal = add3(vertex.normal, scale3(along, -1.0));
    return Diced(point_to_eye(object, point), normal_to_eye(object, normal));
}

// The unit vector, in eye space, of a normal in the object's space.
fn normal_to_eye(object: u32, normal: vec3<f32>) -> vec3<f32> {
    let scaled = scale3(normal, unit_scale(largest3(normal)));
    let moved = vec3<f32>(
        dot3(normal_row_to_eye(object, 0u), scaled),
        dot3(normal_row_to_eye(object, 1u), scaled),
        dot3(normal_row_to_eye(object, 2u), scaled),
    );
    let turned = scale3(moved, unit_scale(largest3(moved)));
    let unit_vector = scale3(turned, rsqrt(max(dot3(turned, turned), SHADE_TINY)));
    if largest3(unit_vector) > 0.5 {
        return flush3(unit_vector);
    }
    return vec3<f32>(0.0, 0.0, 1.0);
}
