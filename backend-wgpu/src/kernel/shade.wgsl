// Mirrors core/src/kernel/shade.rs: the colour of a vertex, Lambert and Blinn, two-sided.

fn shade(object: u32, point: vec3<f32>, unit_normal: vec3<f32>) -> vec3<f32> {
    let away = unit(point);
    let to_eye = scale3(away, neg(1.0));
    let normal = towards_eye(away, unit_normal);
    var colour = vec3<f32>(
        mul(frame.ambient[0], objects[object].colour[0]),
        mul(frame.ambient[1], objects[object].colour[1]),
        mul(frame.ambient[2], objects[object].colour[2]),
    );
    for (var light = 0u; light < frame.light_count; light++) {
        colour = add_light(object, light, point, to_eye, normal, colour);
    }
    return colour;
}

fn add_light(
    object: u32,
    light: u32,
    point: vec3<f32>,
    to_eye: vec3<f32>,
    normal: vec3<f32>,
    colour: vec3<f32>,
) -> vec3<f32> {
    let to_light = direction(light, point);
    let half = unit(add3(to_light, to_eye));
    let diffuse = max(dot3(normal, to_light), 0.0);
    var highlight = select(0.0, max(dot3(normal, half), 0.0), diffuse > 0.0);
    for (var times = 0u; times < objects[object].gloss; times++) {
        highlight = flush(mul(highlight, highlight));
    }
    return vec3<f32>(
        add(colour.x, reflected(object, light, 0u, diffuse, highlight)),
        add(colour.y, reflected(object, light, 1u, diffuse, highlight)),
        add(colour.z, reflected(object, light, 2u, diffuse, highlight)),
    );
}

fn reflected(object: u32, light: u32, k: u32, diffuse: f32, highlight: f32) -> f32 {
    let colour = objects[object].colour[k];
    let share = add(mul(colour, diffuse), mul(objects[object].specular, highlight));
    return mul(share, frame.light_colour[3u * light + k]);
}

fn direction(light: u32, point: vec3<f32>) -> vec3<f32> {
    let at = 4u * light;
    let p = scale3(point, frame.light_vector[at + 3u]);
    return unit(vec3<f32>(
        sub(frame.light_vector[at], p.x),
        sub(frame.light_vector[at + 1u], p.y),
        sub(frame.light_vector[at + 2u], p.z),
    ));
}

fn towards_eye(away: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    return scale3(normal, select(1.0, -1.0, dot3(normal, away) > 0.0));
}

fn unit(a: vec3<f32>) -> vec3<f32> {
    return scale3(a, rsqrt(max(dot3(a, a), SHADE_TINY)));
}
