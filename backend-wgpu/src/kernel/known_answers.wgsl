// Mirrors core/src/kernel/known_answers.rs: single operations of the exact arithmetic.

@group(0) @binding(0) var<storage, read> frame: Frame;
@group(0) @binding(1) var<storage, read> questions: array<Question>;
@group(0) @binding(2) var<storage, read_write> answers: array<u32>;

@compute @workgroup_size(ITEM_GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    ZERO = frame.zero;
    let item = item_index(group, lane);
    if item < arrayLength(&questions) && item < arrayLength(&answers) {
        answers[item] = answer(questions[item]);
    }
}

fn bits(x: f32) -> u32 {
    return bitcast<u32>(x);
}

fn answer(question: Question) -> u32 {
    let a = question.a;
    let b = question.b;
    let x = bitcast<f32>(a);
    let y = bitcast<f32>(b);
    let z = bitcast<f32>(question.c);
    switch question.operation {
        case 0u: { return bits(add(x, y)); }
        case 1u: { return bits(sub(x, y)); }
        case 2u: { return bits(mul(x, y)); }
        case 3u: { return bits(add(mul(x, y), z)); }
        case 4u: { return bits(sub(add(x, y), x)); }
        case 5u: { return bits(mul(mul(x, y), z)); }
        case 6u: { return bits(add(mul(x, y), mul(x, z))); }
        case 7u: { return bits(min(x, y)); }
        case 8u: { return bits(max(x, y)); }
        case 9u: { return bits(recip(x)); }
        case 10u: { return bits(rsqrt(x)); }
        case 11u: { return u32(round(x)); }
        case 12u: { return u32(floor(x)); }
        case 13u: { return bits(float(i32(a))); }
        case 14u: { return bits(flush(x)); }
        case 15u: { return bits(unit_scale(x)); }
        case 16u: { return a * b; }
        default: { return u32(i32(a) >> (b & 31u)); }
    }
}
