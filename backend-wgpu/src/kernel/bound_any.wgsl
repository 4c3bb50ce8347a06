// Mirrors core/src/kernel/bound.rs: what of it concerns Gregory patches and the rules of Weber's program.

// Control points of a surface that is even nearer than the one whose hull is known, if the patch is a Gregory
// patch: its lengths are the surface's.
var<private> FOLLOWER: Net;
var<private> IS_GREGORY: bool;

// Lengths along u and along v on screen.
fn extents_of(seen: OnScreen) -> vec2<f32> {
    if IS_GREGORY {
        let own = on_screen(FOLLOWER);
        return vec2<f32>(length_u(own), length_v(own));
    }
    return vec2<f32>(length_u(seen), length_v(seen));
}

fn wobble_of(seen: OnScreen, spread: f32, scale: f32) -> f32 {
    let off_axis = max(largest_of(seen.x), largest_of(seen.y));
    return mul(mul(add(frame.focal, off_axis), spread), scale);
}

fn largest_of(c: array<f32, 16>) -> f32 {
    return max(fold_max(c), neg(fold_min(c)));
}

fn hull_of_gregory(whole: Net, faces: Faces, surface: Surface) -> Hull {
    let slack = mul(max(extent(whole), faces_extent(faces)), ROUNDING);
    let exchanged = (frame.flags & FLAG_WEBER) != 0u;
    let centred = centre_inner(faces, whole, surface, exchanged);
    let part = restricted(centred.net, surface);
    FOLLOWER = follow(faces, part, surface, exchanged);
    return Hull(part, slack, centred.spread);
}

// The pixels that drawing the surface inside a hull can touch.
fn pixels_of(hull: Hull) -> vec4<i32> {
    let nearest = nearest_of(hull);
    if nearest < frame.near {
        return vec4<i32>(0, i32(frame.width), 0, i32(frame.height));
    }
    return seen_pixels(see(hull, nearest));
}

// The verdict on one surface of any patch, by the rules of the frame's profile.
fn bound_any(surface: Surface) -> Verdict {
    let record = faces_of(surface.patch_id);
    let is_gregory = record != 0u;
    IS_GREGORY = is_gregory;
    let whole = in_eye_space(surface.patch_id);
    var faces: Faces;
    var hull: Hull;
    if is_gregory {
        faces = faces_in_eye_space(record);
        hull = hull_of_gregory(whole, faces, surface);
    } else {
        hull = hull_of_bezier(whole, surface);
    }
    if (frame.flags & FLAG_WEBER) == 0u {
        return judge(surface, hull);
    }
    let code = weber_code(whole, faces, is_gregory, surface);
    if code == DRAW {
        return verdict(code, pixels_of(hull));
    }
    return verdict(code, PIXELS_EMPTY);
}
