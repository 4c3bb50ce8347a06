// Mirrors core/src/accel/walk.rs: from the root downwards, what is nearer first.

typedef struct {
    uint nodes[DEEPEST + 2u];
    float nears[DEEPEST + 2u];
    uint height;
} Stack;

// How far away anything in a box is at least, and how far is too far.
static float2 enter(uint zero, const Search *search, __global const Node *node) {
    return search->is_ray ? within(zero, search, node) : (float2)(to_box(zero, search->origin, node), search->far);
}

static void push(Stack *stack, uint node, float2 span) {
    if (span.x <= span.y) {
        stack->nodes[stack->height] = node;
        stack->nears[stack->height] = span.x;
        stack->height += 1u;
    }
}

// The nearer of two, the lower primitive if both are as near.
static Finding nearer(Finding a, Finding b) {
    const bool is_nearer = b.distance < a.distance || (b.distance == a.distance && b.primitive < a.primitive);
    return a.primitive == NOTHING || is_nearer ? b : a;
}

// What is found of a leaf's primitive, beside what is found already.
static Finding find_one(uint zero, const Search *search, __global const Node *leaf, __global const Triangle *triangles,
                      Finding found) {
    const float2 span = enter(zero, search, leaf);
    Finding own = {leaf->first, 0.0f};
    if (search->is_ray) {
        const bool is_hit = hit(zero, search, triangles + leaf->first, &own.distance);
        return is_hit && span.x <= own.distance && own.distance <= span.y ? nearer(found, own) : found;
    }
    own.distance = max(to_triangle(zero, search->origin, triangles + leaf->first), span.x);
    return own.distance <= span.y ? nearer(found, own) : found;
}

// Puts the children of a node on the stack: what is on top is looked at first.
static void push_children(uint zero, const Search *search, __global const Node *nodes, uint index, Stack *stack) {
    const uint a = nodes[index].first, b = nodes[index].second;
    const float2 first = enter(zero, search, nodes + a), second = enter(zero, search, nodes + b);
    const bool swapped = second.x < first.x;
    push(stack, swapped ? a : b, swapped ? first : second);
    push(stack, swapped ? b : a, swapped ? second : first);
}

static Finding find(uint zero, const Search *search, __global const Node *nodes, __global const Triangle *triangles) {
    Stack stack;
    stack.height = 0u;
    push(&stack, 0u, enter(zero, search, nodes));
    Finding found = {NOTHING, 0.0f};
    while (stack.height > 0u) {
        stack.height -= 1u;
        const uint index = stack.nodes[stack.height];
        if (found.primitive != NOTHING && stack.nears[stack.height] > found.distance) {
            continue;
        }
        if (nodes[index].second == NOTHING) {
            found = find_one(zero, search, nodes + index, triangles, found);
        } else {
            push_children(zero, search, nodes, index, &stack);
        }
    }
    return found;
}
