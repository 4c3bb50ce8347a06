// Mirrors core/src/kernel/known_answers.rs: single operations, to find out whether the device computes right.

static uint answer(uint zero, Question question) {
    const uint a = question.a, b = question.b;
    const float x = as_float(a), y = as_float(b), z = as_float(question.c);
    switch (question.operation) {
    case 0u: return as_uint(add(x, y));
    case 1u: return as_uint(sub(x, y));
    case 2u: return as_uint(mul(x, y));
    case 3u: return as_uint(add(mul(x, y), z));
    case 4u: return as_uint(sub(add(x, y), x));
    case 5u: return as_uint(mul(mul(x, y), z));
    case 6u: return as_uint(add(mul(x, y), mul(x, z)));
    case 7u: return as_uint(min(x, y));
    case 8u: return as_uint(max(x, y));
    case 9u: return as_uint(recip(x));
    case 10u: return as_uint(rsqrt(x));
    case 11u: return (uint)round(x);
    case 12u: return (uint)floor(x);
    case 13u: return as_uint(number((int)a));
    case 14u: return as_uint(flush(x));
    case 15u: return as_uint(unit_scale(x));
    case 16u: return a * b;
    default: return (uint)((int)a >> (b & 31u));
    }
}

__kernel void stage_known_answers(__constant Frame *frame, __global const Question *questions,
                                  __global uint *answers, uint count) {
    const uint index = get_global_id(0);
    if (index < count) {
        answers[index] = answer(frame->zero, questions[index]);
    }
}
