// Mirrors core/src/num.rs: the only arithmetic kernels may use.
//
// Every function that rounds takes `zero`, the run-time zero of the frame. With BARRIER defined it is XORed
// into every float result, so that no compiler option can fuse, regroup or simplify. The macros below take
// it from the caller's scope and also hide OpenCL's own functions of the same names.
#pragma OPENCL FP_CONTRACT OFF

#ifdef BARRIER
#define exact(x) as_float(as_uint(x) ^ zero)
#else
#define exact(x) (x)
#endif

// Some drivers have macros of these names.
#undef min
#undef max
#undef clamp
#undef abs
#undef rsqrt
#undef sqrt
#undef round
#undef floor

#define add(a, b) num_add(zero, a, b)
#define sub(a, b) num_sub(zero, a, b)
#define mul(a, b) num_mul(zero, a, b)
#define min(a, b) num_min(a, b)
#define max(a, b) num_max(a, b)
#define clamp(x, low, high) num_clamp(x, low, high)
#define abs(x) num_abs(x)
#define neg(x) num_neg(x)
#define recip(x) num_recip(zero, x)
#define rsqrt(x) num_rsqrt(zero, x)
#define sqrt(x) num_sqrt(zero, x)
#define round(x) num_round(zero, x)
#define floor(x) num_floor(x)
#define number(x) num_float(zero, x)
#define flush(x) num_flush(x)
#define unit_scale(x) num_unit_scale(x)
#define dot3(a, b) num_dot3(zero, a, b)
#define cross3(a, b) num_cross3(zero, a, b)
#define add3(a, b) num_add3(zero, a, b)
#define scale3(a, s) num_scale3(zero, a, s)
#define flush3(a) num_flush3(a)
#define largest3(a) num_largest3(a)

static float num_add(uint zero, float a, float b) {
    return exact(a + b);
}

static float num_sub(uint zero, float a, float b) {
    return exact(a - b);
}

static float num_mul(uint zero, float a, float b) {
    return exact(a * b);
}

// Bits are selected, not floats: no option lets a compiler swap the operands of that.
static float num_min(float a, float b) {
    return as_float(a < b ? as_uint(a) : as_uint(b));
}

static float num_max(float a, float b) {
    return as_float(a > b ? as_uint(a) : as_uint(b));
}

static float num_clamp(float x, float low, float high) {
    return min(max(x, low), high);
}

static float num_abs(float x) {
    return as_float(as_uint(x) & 0x7fffffffu);
}

static float num_neg(float x) {
    return as_float(as_uint(x) ^ 0x80000000u);
}

static float num_recip(uint zero, float x) {
    float y = as_float(0x7ef311c7u - as_uint(x));
    y = mul(y, sub(2.0f, mul(x, y)));
    y = mul(y, sub(2.0f, mul(x, y)));
    return mul(y, sub(2.0f, mul(x, y)));
}

static float num_rsqrt(uint zero, float x) {
    const float half_x = mul(0.5f, x);
    float y = as_float(0x5f375a86u - (as_uint(x) >> 1));
    y = mul(y, sub(1.5f, mul(mul(half_x, y), y)));
    y = mul(y, sub(1.5f, mul(mul(half_x, y), y)));
    return mul(y, sub(1.5f, mul(mul(half_x, y), y)));
}

static float num_sqrt(uint zero, float x) {
    return mul(x, rsqrt(x));
}

static int num_round(uint zero, float x) {
    return as_int(add(x, 12582912.0f)) - 0x4b400000;
}

static int num_floor(float x) {
    const int towards_zero = (int)x;
    return (float)towards_zero > x ? towards_zero - 1 : towards_zero;
}

// `float` in core, which is a reserved word here.
static float num_float(uint zero, int x) {
    return exact((float)x);
}

static float num_flush(float x) {
    return as_float((as_uint(x) & 0x7fffffffu) < 0x20000000u ? 0u : as_uint(x));
}

static float num_unit_scale(float x) {
    const uint exponent = (as_uint(x) >> 23) & 0xffu;
    return as_float(exponent == 0u || exponent > 253u ? 0u : (254u - exponent) << 23);
}

static float num_dot3(uint zero, float3 a, float3 b) {
    return add(add(mul(a.x, b.x), mul(a.y, b.y)), mul(a.z, b.z));
}

static float3 num_cross3(uint zero, float3 a, float3 b) {
    return (float3)(sub(mul(a.y, b.z), mul(a.z, b.y)), sub(mul(a.z, b.x), mul(a.x, b.z)),
                    sub(mul(a.x, b.y), mul(a.y, b.x)));
}

static float3 num_flush3(float3 a) {
    return (float3)(num_flush(a.x), num_flush(a.y), num_flush(a.z));
}

static float3 num_add3(uint zero, float3 a, float3 b) {
    return (float3)(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z));
}

static float3 num_scale3(uint zero, float3 a, float s) {
    return (float3)(mul(a.x, s), mul(a.y, s), mul(a.z, s));
}

static float num_largest3(float3 a) {
    return max(max(abs(a.x), abs(a.y)), abs(a.z));
}

// Four numbers at once.
static float4 add4(uint zero, float4 a, float4 b) {
    return (float4)(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z), add(a.w, b.w));
}

static float4 sub4(uint zero, float4 a, float4 b) {
    return (float4)(sub(a.x, b.x), sub(a.y, b.y), sub(a.z, b.z), sub(a.w, b.w));
}

static float4 mul4(uint zero, float4 a, float4 b) {
    return (float4)(mul(a.x, b.x), mul(a.y, b.y), mul(a.z, b.z), mul(a.w, b.w));
}

// The integers' own.
static int lesser(int a, int b) {
    return a < b ? a : b;
}

static int greater(int a, int b) {
    return a > b ? a : b;
}
