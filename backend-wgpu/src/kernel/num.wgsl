// Mirrors core/src/num.rs: the only arithmetic kernels may use.
//
// Every float result passes the barrier: XOR with ZERO, which is 0 at run time but unknown to compilers,
// so that nothing is fused, regrouped or simplified. Each entry point sets ZERO from the frame first.

var<private> ZERO: u32;

fn exactly(x: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(x) ^ ZERO);
}

fn add(a: f32, b: f32) -> f32 {
    return exactly(a + b);
}

fn sub(a: f32, b: f32) -> f32 {
    return exactly(a - b);
}

fn mul(a: f32, b: f32) -> f32 {
    return exactly(a * b);
}

fn min(a: f32, b: f32) -> f32 {
    return exactly(select(b, a, a < b));
}

fn max(a: f32, b: f32) -> f32 {
    return exactly(select(b, a, a > b));
}

fn clamp(x: f32, low: f32, high: f32) -> f32 {
    return min(max(x, low), high);
}

fn abs(x: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(x) & 0x7fffffffu) ^ ZERO);
}

fn neg(x: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(x) ^ 0x80000000u) ^ ZERO);
}

fn recip(x: f32) -> f32 {
    var y = bitcast<f32>(0x7ef311c7u - bitcast<u32>(x));
    y = mul(y, sub(2.0, mul(x, y)));
    y = mul(y, sub(2.0, mul(x, y)));
    return mul(y, sub(2.0, mul(x, y)));
}

fn rsqrt(x: f32) -> f32 {
    let half = mul(0.5, x);
    var y = bitcast<f32>(0x5f375a86u - (bitcast<u32>(x) >> 1u));
    y = mul(y, sub(1.5, mul(mul(half, y), y)));
    y = mul(y, sub(1.5, mul(mul(half, y), y)));
    return mul(y, sub(1.5, mul(mul(half, y), y)));
}

fn sqrt(x: f32) -> f32 {
    return mul(x, rsqrt(x));
}

fn round(x: f32) -> i32 {
    return bitcast<i32>(add(x, 12582912.0)) - 0x4b400000;
}

fn floor(x: f32) -> i32 {
    let towards_zero = i32(x);
    return select(towards_zero, towards_zero - 1, float(towards_zero) > x);
}

fn float(x: i32) -> f32 {
    return exactly(f32(x));
}

fn flush(x: f32) -> f32 {
    let bits = bitcast<u32>(x);
    return bitcast<f32>(select(bits, 0u, (bits & 0x7fffffffu) < 0x20000000u) ^ ZERO);
}

fn unit_scale(x: f32) -> f32 {
    let exponent = (bitcast<u32>(x) >> 23u) & 0xffu;
    let scale = (254u - exponent) << 23u;
    return bitcast<f32>(select(scale, 0u, exponent == 0u || exponent > 253u) ^ ZERO);
}

fn dot3(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return add(add(mul(a.x, b.x), mul(a.y, b.y)), mul(a.z, b.z));
}

fn cross3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        sub(mul(a.y, b.z), mul(a.z, b.y)),
        sub(mul(a.z, b.x), mul(a.x, b.z)),
        sub(mul(a.x, b.y), mul(a.y, b.x)),
    );
}

fn add3(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z));
}

fn flush3(a: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(flush(a.x), flush(a.y), flush(a.z));
}

fn scale3(a: vec3<f32>, s: f32) -> vec3<f32> {
    return vec3<f32>(mul(a.x, s), mul(a.y, s), mul(a.z, s));
}

fn largest3(a: vec3<f32>) -> f32 {
    return max(max(abs(a.x), abs(a.y)), abs(a.z));
}
