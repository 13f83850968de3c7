// Distances in f32, with a proved bound on their error (docs/proofs/cuda.md).
//
// A `Plate` is a primitive in a local frame. The first axis runs along its longest edge, and the second one in its plane
// towards the apex. The axes are orthogonal however thin the triangle is, so errors do not depend on its shape. Segments
// and points are plates without area. Coordinates are in units of the scene's frame, in which the scene fits into the
// cube from -1 to 1.
#pragma once

#include "arithmetic.cuh"

struct alignas(16) Plate {
    F3 origin, along, up;           // an end A of the longest edge AB, and the axes
    float length;                   // that of AB
    float left_x, left_y, left_end; // the direction of AC, of length 1, and the length of AC
    float right_x, right_y, right_end; // those of BC
};
static_assert(sizeof(Plate) == 64, "four loads of sixteen bytes");

// Reads a plate by four loads.
P2M_FUNCTION Plate load(const Plate *at) {
#ifdef __CUDACC__
    union {
        float4 part[4];
        Plate plate;
    } read;
    for (int k = 0; k < 4; k++) read.part[k] = __ldg((const float4 *)at + k);
    return read.plate;
#else
    return *at;
#endif
}

constexpr float U32 = 0x1p-24f;
// The bounds on the error of `square_of`, which docs/proofs/cuda.md proves:
// |sqrt(square) - d| <= FIXED_ERROR (|p| + 1) + RELATIVE_ERROR (d + length)
// d is the true distance, and |p| the largest component of the query.
constexpr float FIXED_ERROR = 4 * U32, RELATIVE_ERROR = 40 * U32;
// Enlarges a number by more than the rounding errors of a few operations.
constexpr float ENLARGED = 1 + 16 * U32;

P2M_FUNCTION float fixed_error(F3 p) { return FIXED_ERROR * (largest(p) + 1.0f); }

P2M_FUNCTION float clamp(float x, float end) { return smaller(larger(x, 0.0f), end); }

// Returns the squared distance of a point; `foot_x` and `foot_y` get the nearest point in the frame of the plate.
//
// The point is projected onto the plane. If its projection is inside of the triangle, only the height counts. Otherwise
// the nearest of the three edges does. All cases are computed without divisions and compared.
P2M_FUNCTION float square_and_foot(const Plate &plate, F3 p, float &foot_x, float &foot_y) {
    F3 o = sub(p, plate.origin);
    float x = dot(o, plate.along), y = dot(o, plate.up), z = dot(o, cross(plate.along, plate.up));
    foot_x = clamp(x, plate.length);
    foot_y = 0.0f;
    float gap = x - foot_x, square = gap * gap + y * y;
    float t = x * plate.left_x + y * plate.left_y, s = x * plate.left_y - y * plate.left_x;
    float at = clamp(t, plate.left_end), beyond = t - at, left = beyond * beyond + s * s;
    if (left < square) {
        square = left;
        foot_x = at * plate.left_x;
        foot_y = at * plate.left_y;
    }
    float r = x - plate.length;
    float t2 = r * plate.right_x + y * plate.right_y, s2 = r * plate.right_y - y * plate.right_x;
    at = clamp(t2, plate.right_end), beyond = t2 - at;
    float right = beyond * beyond + s2 * s2;
    if (right < square) {
        square = right;
        foot_x = plate.length + at * plate.right_x;
        foot_y = at * plate.right_y;
    }
    if (y > 0.0f && s > 0.0f && s2 < 0.0f && x > 0.0f && r < 0.0f) {
        square = 0.0f;
        foot_x = x;
        foot_y = y;
    }
    return square + z * z;
}

P2M_FUNCTION float square_of(const Plate &plate, F3 p) {
    float x, y;
    return square_and_foot(plate, p, x, y);
}

// Returns the nearest point of a plate, up to rounding.
P2M_FUNCTION F3 foot_of(const Plate &plate, F3 p) {
    float x, y;
    square_and_foot(plate, p, x, y);
    return add_scaled(add_scaled(plate.origin, x, plate.along), y, plate.up);
}

// Returns an upper bound on the distance of the scene, given the computed distance of one plate.
P2M_FUNCTION float upper_bound(float distance, float length, float fixed) {
    return (distance + fixed + RELATIVE_ERROR * length) * (1 + 4 * RELATIVE_ERROR);
}

// Returns the computed distance above which a plate is certainly farther than an upper bound.
P2M_FUNCTION float candidate_limit(float upper, float length, float fixed) {
    return (upper + fixed + RELATIVE_ERROR * (upper + length)) * ENLARGED;
}
