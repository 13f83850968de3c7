// Vectors with a fixed order of operations, on a card and on the host.
//
// The contract of p2m-core fixes every rounding. So this code is compiled without contraction (NVRTC: --fmad=false; a
// C++ compiler: -ffp-contract=off), and each operation below is rounded once, as IEEE 754 says. `cargo xtask cuda`
// checks that the PTX has no fused instruction. The operations are the same as in p2m-core/src/kernel/vector.rs, in the
// same order.
#pragma once

#ifdef __CUDACC__
using uint8_t = unsigned char;
using uint32_t = unsigned int;
using uint64_t = unsigned long long;
#define P2M_FUNCTION __device__ __forceinline__
#define P2M_CALLED __device__ __noinline__
#else
#include <cmath>
#include <cstddef>
#include <cstdint>
#define P2M_FUNCTION inline
#define P2M_CALLED inline
#endif

template <class T> struct Vector {
    T x, y, z;
};
using V3 = Vector<double>;
using F3 = Vector<float>;

template <class T> P2M_FUNCTION Vector<T> sub(Vector<T> a, Vector<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> P2M_FUNCTION Vector<T> add(Vector<T> a, Vector<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> P2M_FUNCTION T dot(Vector<T> a, Vector<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> P2M_FUNCTION T norm_squared(Vector<T> a) { return dot(a, a); }
template <class T> P2M_FUNCTION Vector<T> cross(Vector<T> a, Vector<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// a + s b
template <class T> P2M_FUNCTION Vector<T> add_scaled(Vector<T> a, T s, Vector<T> b) {
    return {a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

// s a + t b
P2M_FUNCTION V3 combine(double s, V3 a, double t, V3 b) {
    return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

// The smaller and the larger of two numbers, by a comparison that treats the sign of zero as p2m-core does.
template <class T> P2M_FUNCTION T smaller(T a, T b) { return a < b ? a : b; }
template <class T> P2M_FUNCTION T larger(T a, T b) { return a > b ? a : b; }
#ifdef __CUDACC__
P2M_FUNCTION float root(float x) { return __fsqrt_rn(x); }
P2M_FUNCTION double root(double x) { return __dsqrt_rn(x); }
#else
template <class T> P2M_FUNCTION T root(T x) { return std::sqrt(x); }
#endif
template <class T> P2M_FUNCTION T magnitude(T x) { return x < 0 ? -x : x; }

// The point of the box from `low` to `high` that is nearest to `x`.
P2M_FUNCTION V3 clamp(V3 x, V3 low, V3 high) {
    x = {smaller(x.x, high.x), smaller(x.y, high.y), smaller(x.z, high.z)};
    return {larger(x.x, low.x), larger(x.y, low.y), larger(x.z, low.z)};
}

// Extends the box from `low` to `high` to contain a point.
P2M_FUNCTION void extend(V3 &low, V3 &high, V3 v) {
    low = {smaller(v.x, low.x), smaller(v.y, low.y), smaller(v.z, low.z)};
    high = {larger(v.x, high.x), larger(v.y, high.y), larger(v.z, high.z)};
}

// The largest magnitude of a component.
template <class T> P2M_FUNCTION T largest(Vector<T> v) {
    return larger(magnitude(v.z), larger(magnitude(v.y), larger(magnitude(v.x), T(0))));
}

P2M_FUNCTION bool lexicographically_less(V3 a, V3 b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.z < b.z;
}

P2M_FUNCTION bool is_equal(V3 a, V3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
