// The plain kernel of p2m-core in f64: the nearest point of a point, a segment or a triangle.
//
// It has the operations of p2m-core/src/kernel/{triangle,edge,face}.rs in the same order, so its bits are the same. The
// slower paths of that kernel are not here: scales beyond the plain range, faces of slivers, and weights whose sign may
// be due to rounding. In these cases the result is `UNDECIDED`, and the processor answers the query. `src/tests.rs`
// compares both kernels on the host.
#pragma once

#include "arithmetic.cuh"

enum Outcome : int { FARTHER = 0, FOUND = 1, UNDECIDED = 2 };

struct Nearest {
    double square;   // the key, which is plain or zero
    V3 offset;       // from the query to the nearest point
    double weight[3];
    double size;     // the largest component of an offset to a vertex
    int feature;     // the code of p2m_core::Feature
};

constexpr double SQUARE_MIN = 0x1p-800, SQUARE_MAX = 0x1p800;
constexpr double MIN_PLAIN_SIZE = 0x1p-250, MAX_PLAIN_SIZE = 0x1p250, MAX_SIZE_PER_EDGE_SQUARED = 0x1p196;
constexpr double ROUGH_SQUARE_MARGIN = 0x1p-34, OUTWARD_MARGIN = 0x1p-38, REJECT_MARGIN_SQUARED = 0x1p-72;
constexpr double SLIVER_SINE_SQUARED = 0x1p-20, MAX_ERROR_FACTOR = 0x1p24, MIN_CERTAIN_WEIGHT = 0x1p-49;
#ifdef __CUDACC__
#define P2M_INFINITY __longlong_as_double(0x7ff0000000000000)
#define P2M_NAN __longlong_as_double(0x7ff8000000000000)
#else
#define P2M_INFINITY HUGE_VAL
#define P2M_NAN __builtin_nan("")
#endif

struct Line {
    bool is_second_nearer;
    V3 direction;
    double inverse, t, square;
};

P2M_FUNCTION Line edge_line(V3 a, V3 b, double aa, double bb) {
    Line l;
    l.is_second_nearer = bb < aa || (bb == aa && lexicographically_less(b, a));
    V3 n = l.is_second_nearer ? b : a, f = l.is_second_nearer ? a : b;
    double nn = l.is_second_nearer ? bb : aa;
    l.direction = sub(f, n);
    l.inverse = 1.0 / norm_squared(l.direction);
    double projected = dot(n, l.direction);
    l.t = -(projected * l.inverse);
    l.square = nn + l.t * projected;
    return l;
}

// Projects the query onto an edge; returns whether the projection lies strictly inside.
P2M_FUNCTION bool edge_foot(const Line &l, V3 a, V3 b, V3 &offset, double &square, double &t) {
    V3 foot = add_scaled(l.is_second_nearer ? b : a, l.t, l.direction);
    double correction = -(dot(foot, l.direction) * l.inverse);
    t = l.t + correction;
    V3 low = a, high = a;
    extend(low, high, b);
    offset = clamp(add_scaled(foot, correction, l.direction), low, high);
    square = norm_squared(offset);
    return 0.0 < l.t && 0.0 < t && t < 1.0;
}

P2M_FUNCTION void set_vertex(Nearest &best, int i, double square, V3 offset) {
    best.square = square;
    best.offset = offset;
    best.feature = i;
    for (int k = 0; k < 3; k++) best.weight[k] = k == i ? 1.0 : 0.0;
}

P2M_FUNCTION void set_edge(Nearest &best, int i, int n, const Line &l, double square, V3 offset, double t) {
    best.square = square;
    best.offset = offset;
    best.feature = 3 + i;
    double a = l.is_second_nearer ? t : 1.0 - t, b = l.is_second_nearer ? 1.0 - t : t;
    best.weight[0] = best.weight[1] = best.weight[2] = 0.0;
    best.weight[i] = a;
    best.weight[(i + 1) % n] = b;
}

P2M_FUNCTION bool has_plain_scale(double size, double inverse) {
    return MIN_PLAIN_SIZE <= size && size <= MAX_PLAIN_SIZE && inverse * (size * size) <= MAX_SIZE_PER_EDGE_SQUARED;
}

// Returns `UNDECIDED` for a square that has lost digits to underflow.
P2M_FUNCTION Outcome plain(Nearest &best) {
    if (best.square >= SQUARE_MIN) return best.square < SQUARE_MAX ? FOUND : UNDECIDED;
    if (!is_equal(best.offset, V3{0, 0, 0})) return UNDECIDED;
    best.square = 0.0;
    return FOUND;
}

P2M_FUNCTION Outcome nearest_of_point(V3 query, V3 vertex, double prune, Nearest &best) {
    V3 offset = sub(vertex, query);
    double square = norm_squared(offset);
    if (square > prune) return FARTHER;
    set_vertex(best, 0, square, offset);
    best.size = largest(offset);
    return plain(best);
}

P2M_FUNCTION Outcome nearest_of_segment(V3 query, V3 a, V3 b, double prune, Nearest &best) {
    V3 p = sub(a, query), q = sub(b, query);
    double size = larger(magnitude(q.z), larger(magnitude(q.y), larger(magnitude(q.x), largest(p))));
    double pp = norm_squared(p), qq = norm_squared(q);
    Line l = edge_line(p, q, pp, qq);
    if (!has_plain_scale(size, l.inverse)) return UNDECIDED;
    bool is_second = qq < pp || (qq == pp && lexicographically_less(b, a));
    set_vertex(best, is_second, is_second ? qq : pp, is_second ? q : p);
    best.size = size;
    if (l.t > 0.0) {
        if (l.square - ROUGH_SQUARE_MARGIN * (size * size) > prune) return FARTHER;
        V3 offset;
        double square, t;
        if (edge_foot(l, p, q, offset, square, t) && square < best.square) set_edge(best, 0, 2, l, square, offset, t);
    } else if (best.square > prune) {
        return FARTHER;
    }
    return plain(best);
}

// Whether edge i of a triangle precedes the feature `other` with the same key.
P2M_FUNCTION bool edge_precedes(const V3 *vertices, int i, int other) {
    if (other < 3) return false;
    int j = other - 3;
    V3 a = vertices[i], b = vertices[(i + 1) % 3], c = vertices[j], d = vertices[(j + 1) % 3];
    bool is_turned = lexicographically_less(b, a), is_other_turned = lexicographically_less(d, c);
    V3 first = is_turned ? b : a, second = is_turned ? a : b;
    V3 first_of_other = is_other_turned ? d : c, second_of_other = is_other_turned ? c : d;
    if (!is_equal(first, first_of_other)) return lexicographically_less(first, first_of_other);
    return lexicographically_less(second, second_of_other);
}

P2M_FUNCTION Outcome nearest_of_triangle(V3 query, const V3 *vertices, double prune, Nearest &best) {
    V3 o[3];
    double squares[3];
    for (int i = 0; i < 3; i++) {
        o[i] = sub(vertices[i], query);
        squares[i] = norm_squared(o[i]);
    }
    V3 low = o[0], high = o[0];
    extend(low, high, o[1]);
    extend(low, high, o[2]);
    double size = largest(low);
    size = larger(magnitude(high.z), larger(magnitude(high.y), larger(magnitude(high.x), size)));
    int v = 0;
    for (int i = 1; i < 3; i++)
        if (squares[i] < squares[v] || (squares[i] == squares[v] && lexicographically_less(vertices[i], vertices[v])))
            v = i;
    best.size = size;
    // Both edges at the nearest vertex lead away from the query.
    V3 next = sub(o[(v + 1) % 3], o[v]), last = sub(o[(v + 2) % 3], o[v]);
    double least = smaller(dot(o[v], next), dot(o[v], last));
    if (least > OUTWARD_MARGIN * (size * size) && MIN_PLAIN_SIZE <= size && size <= MAX_PLAIN_SIZE &&
        SQUARE_MIN <= squares[v] && squares[v] < SQUARE_MAX) {
        if (!(squares[v] <= prune)) return FARTHER;
        set_vertex(best, v, squares[v], o[v]);
        return FOUND;
    }
    Line lines[3];
    for (int i = 0; i < 3; i++) lines[i] = edge_line(o[i], o[(i + 1) % 3], squares[i], squares[(i + 1) % 3]);
    if (!has_plain_scale(size, larger(larger(lines[0].inverse, lines[1].inverse), lines[2].inverse))) return UNDECIDED;
    // The longest edge with its nearer and farther end, and the apex opposite to it.
    int base = 0;
    for (int i = 1; i < 3; i++) {
        double x = lines[i].inverse, y = lines[base].inverse;
        if (x < y || (x == y && lexicographically_less(o[(i + 2) % 3], o[(base + 2) % 3]))) base = i;
    }
    const Line line = lines[base];
    const int near = line.is_second_nearer ? (base + 1) % 3 : base, far = line.is_second_nearer ? base : (base + 1) % 3;
    const int apex = 3 - near - far;
    const V3 n = o[near];
    // The plane of the face, and a first estimate of the projection.
    V3 side = sub(o[apex], n);
    double along = dot(side, line.direction) * line.inverse;
    V3 height = add_scaled(side, -along, line.direction);
    double height_squared = norm_squared(height);
    double error_factor = larger(SLIVER_SINE_SQUARED / (height_squared * line.inverse), 1.0);
    double inverse_height = 1.0 / height_squared;
    double projected = dot(n, height);
    double wa = -(projected * inverse_height), wf = line.t - along * wa, wn = (1.0 - wf) - wa;
    double least_weight = smaller(smaller(wn, wf), wa);
    double plane_square = line.square + wa * projected;
    bool can_estimate = error_factor <= MAX_ERROR_FACTOR;
    double reject = REJECT_MARGIN_SQUARED * error_factor * (size * size);
    bool is_outside = can_estimate && least_weight < 0.0 && reject < least_weight * least_weight * height_squared;
    double face = P2M_INFINITY, factor = 1.0;
    if (!is_outside) {
        face = 0.0 < least_weight ? plane_square : P2M_INFINITY;
        factor = error_factor;
        if (!can_estimate) {
            face = 0.0;
            factor = P2M_INFINITY;
        }
    }
    double rough = smaller(squares[v], face);
    for (int i = 0; i < 3; i++)
        rough = lines[i].t > 0.0 && lines[i].t < 1.0 ? smaller(lines[i].square, rough) : rough;
    double margin = ROUGH_SQUARE_MARGIN * factor * (size * size);
    if (rough - margin > prune) return FARTHER;
    double limit = rough + margin;

    set_vertex(best, v, squares[v], o[v]);
    for (int i = 0; i < 3; i++) {
        if (!(lines[i].t > 0.0 && lines[i].square <= limit)) continue;
        V3 offset;
        double square, t;
        if (edge_foot(lines[i], o[i], o[(i + 1) % 3], offset, square, t) &&
            (square < best.square || (square == best.square && edge_precedes(vertices, i, best.feature))))
            set_edge(best, i, 3, lines[i], square, offset, t);
    }
    if (!is_outside && (plane_square <= limit || !can_estimate)) {
        if (1.0 < error_factor) return UNDECIDED;
        // The point of the first weights, improved by a step along both axes.
        V3 point = add(n, combine(wf, line.direction, wa, side));
        double step_d = -(dot(point, line.direction) * line.inverse);
        double step_h = -(dot(point, height) * inverse_height);
        wa = wa + step_h;
        wf = wf + (step_d - along * step_h);
        wn = (1.0 - wf) - wa;
        double certain = smaller(smaller(wn, wf), wa);
        if (certain > 0.0) {
            if (!(certain >= MIN_CERTAIN_WEIGHT)) return UNDECIDED;
            V3 offset = clamp(add(point, combine(step_d, line.direction, step_h, height)), low, high);
            double square = norm_squared(offset);
            if (square < best.square) {
                best.square = square;
                best.offset = offset;
                best.feature = 6;
                best.weight[near] = wn;
                best.weight[far] = wf;
                best.weight[apex] = wa;
            }
        }
    }
    return plain(best);
}

// Returns the nearest point in the coordinates of the scene.
P2M_FUNCTION V3 point_of(const Nearest &best, V3 query, const V3 *vertices, int count) {
    if (best.feature < 3) return vertices[best.feature];
    V3 point = add(query, best.offset), low, high;
    if (best.feature < 6) {
        int i = best.feature - 3;
        low = high = vertices[i];
        extend(low, high, vertices[(i + 1) % count]);
    } else {
        low = high = vertices[0];
        for (int i = 1; i < count; i++) extend(low, high, vertices[i]);
    }
    return clamp(point, low, high);
}
