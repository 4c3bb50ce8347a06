// Mirrors core/src/accel/walk.rs: from the root downwards, what is nearer first.
//
// Some drivers end loops before they are through: then nothing is found, and the plan says so.

const STACK_ROOM: u32 = DEEPEST + 2u;

// Where what is looked for is looked from, and how far.
var<private> origin: vec3<f32>;
var<private> limit: f32;

var<private> stack: array<u32, STACK_ROOM>;
var<private> nears: array<f32, STACK_ROOM>;
var<private> height: u32;

fn push(node: u32, span: vec2<f32>) {
    if span.x <= span.y {
        stack[height] = node;
        nears[height] = span.x;
        height += 1u;
    }
}

// The nearer of two, the lower primitive if both are as near.
fn nearer(a: Finding, b: Finding) -> Finding {
    let is_nearer = b.distance < a.distance || (b.distance == a.distance && b.primitive < a.primitive);
    if a.primitive == NOTHING || is_nearer {
        return b;
    }
    return a;
}

// What is found of a leaf's primitive, beside what is found already.
fn find_one(leaf: u32, found: Finding) -> Finding {
    let primitive = nodes[leaf].first;
    let distance = distance_to(primitive, enter(leaf));
    if distance < 0.0 {
        return found;
    }
    return nearer(found, Finding(primitive, distance));
}

// Puts the children of a node on the stack: what is on top is looked at first.
fn push_children(node: u32) {
    let a = nodes[node].first;
    let b = nodes[node].second;
    let first = enter(a);
    let second = enter(b);
    if second.x < first.x {
        push(a, first);
        push(b, second);
    } else {
        push(b, second);
        push(a, first);
    }
}

fn find() -> Finding {
    height = 0u;
    push(0u, enter(0u));
    var found = Finding(NOTHING, 0.0);
    while height > 0u {
        height -= 1u;
        let node = stack[height];
        if found.primitive != NOTHING && nears[height] > found.distance {
            continue;
        }
        if nodes[node].second == NOTHING {
            found = find_one(node, found);
        } else {
            push_children(node);
        }
    }
    if loops_were_cut() {
        return Finding(UNFINISHED, 0.0);
    }
    return found;
}
