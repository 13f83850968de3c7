// Answers to queries: f32 distances select candidates, and the kernel of the contract in f64 decides between them.
//
// A query reads its list twice. The first pass finds the least computed f32 distance and so an upper bound on the true
// distance, with a proved margin. The second pass evaluates in f64 the few primitives whose f32 distance does not
// exceed that bound by more than its error. The tree is searched in the same two passes by queries without a list.
#pragma once

#include "lists.cuh"
#include "nearest.cuh"

// A primitive: the numbers of its vertices, and its id. Unused vertices of segments and points are NO_VERTEX.
struct alignas(16) Primitive {
    uint32_t vertex[3], id;
};
constexpr uint32_t NO_VERTEX = 0xffffffffu;

struct Index {
    const Node *nodes;
    const Plate *plates;
    const Primitive *primitives;
    const void *vertices;           // triples of the scalar of the scene
    const Entry *entries;
    const uint32_t *items;
    Grid grids[2];
    int grid_count;
    double centre[3], per_unit;     // of the frame
};

// The columns of answers. Unwanted columns are null.
struct Columns {
    void *distance, *lower_bound, *point, *weights; // in the scalar of the scene
    uint32_t *primitive;                            // NO_VERTEX where there is no answer
    uint8_t *feature;
};

struct Batch {
    Index index;
    Columns columns;
    const void *queries;      // triples of the scalar of the scene, or of f32
    uint32_t *order, *keys, *ranks, *starts, *placed;
    uint32_t *rest, *rest_count;           // queries in cells without a list
    uint32_t *undecided, *undecided_count; // queries that a processor has to answer
    double radius;            // the largest f64 distance of an answer
    double prune;             // a square above that of the radius
    void *gathered;           // the queries that a processor has to answer
    Columns answers;          // the answers of a processor to them
    uint32_t has_f32_queries;
};

template <class S> P2M_FUNCTION V3 load(const void *triples, size_t i) {
    const S *at = (const S *)triples + 3 * i;
    return {(double)at[0], (double)at[1], (double)at[2]};
}
template <class S> P2M_FUNCTION void store(void *triples, size_t i, double x, double y, double z) {
    S *at = (S *)triples + 3 * i;
    at[0] = (S)x;
    at[1] = (S)y;
    at[2] = (S)z;
}

template <class S> P2M_FUNCTION V3 query(const Batch &b, uint32_t i) {
    return b.has_f32_queries ? load<float>(b.queries, i) : load<S>(b.queries, i);
}

template <class S> P2M_FUNCTION S round_down(double x);
template <> P2M_FUNCTION double round_down<double>(double x) { return x; }
template <> P2M_FUNCTION float round_down<float>(double x) {
#ifdef __CUDACC__
    return __double2float_rd(x);
#else
    float nearest = (float)x;
    return nearest > x ? std::nextafterf(nearest, -INFINITY) : nearest;
#endif
}

// Converts a query to the frame, rounded to f32; returns `false` if it is too far away.
P2M_FUNCTION bool place(const Index &index, V3 q, F3 &p) {
    V3 local = {(q.x - index.centre[0]) * index.per_unit, (q.y - index.centre[1]) * index.per_unit,
                (q.z - index.centre[2]) * index.per_unit};
    p = {(float)local.x, (float)local.y, (float)local.z};
    // The comparison is false for NaN.
    return magnitude(local.x) <= 0x1p30 && magnitude(local.y) <= 0x1p30 && magnitude(local.z) <= 0x1p30;
}

constexpr double DOWN = 1.0 - 0x1p-49, ERROR_PER_SIZE = 8.0 * (1.7321 * 0x1p-53);

// The nearest primitive so far.
struct Best {
    Nearest nearest;
    uint32_t plate, id;
    double prune, certified;
    bool is_found, is_undecided;
};

template <class S> P2M_CALLED void decide(const Batch &b, V3 q, uint32_t plate, Best &best) {
    const Primitive primitive = b.index.primitives[plate];
    V3 vertices[3];
    vertices[0] = load<S>(b.index.vertices, primitive.vertex[0]);
    Nearest found;
    Outcome outcome;
    if (primitive.vertex[1] == NO_VERTEX) {
        outcome = nearest_of_point(q, vertices[0], best.prune, found);
    } else {
        vertices[1] = load<S>(b.index.vertices, primitive.vertex[1]);
        if (primitive.vertex[2] == NO_VERTEX) {
            outcome = nearest_of_segment(q, vertices[0], vertices[1], best.prune, found);
        } else {
            vertices[2] = load<S>(b.index.vertices, primitive.vertex[2]);
            outcome = nearest_of_triangle(q, vertices, best.prune, found);
        }
    }
    best.is_undecided |= outcome == UNDECIDED;
    if (outcome != FOUND) return;
    if (b.columns.lower_bound) best.certified = smaller(root(found.square) - ERROR_PER_SIZE * found.size, best.certified);
    if (!best.is_found || found.square < best.nearest.square ||
        (found.square == best.nearest.square && primitive.id < best.id)) {
        best.nearest = found;
        best.plate = plate;
        best.id = primitive.id;
        best.is_found = true;
        // A square that is zero or below the plain range must not prune.
        best.prune = smaller(larger(found.square, SQUARE_MIN), best.prune);
    }
}

template <class S> P2M_CALLED void write(const Batch &b, uint32_t i, V3 q, const Best &best) {
    double distance = best.is_found ? root(best.nearest.square) : P2M_INFINITY;
    bool is_within = best.is_found && distance <= b.radius;
    if (b.columns.lower_bound) {
        // `smaller` ignores a radius that is NaN.
        double bound = smaller((is_within ? distance : b.radius) * DOWN, best.certified);
        double below = bound * DOWN - 2 * 0x1p-1074;
        ((S *)b.columns.lower_bound)[i] = below > 0 ? round_down<S>(below) : (S)0;
        if (!is_within && !(bound < P2M_INFINITY)) ((S *)b.columns.lower_bound)[i] = (S)P2M_INFINITY;
    }
    if (b.columns.distance) ((S *)b.columns.distance)[i] = (S)(is_within ? distance : P2M_INFINITY);
    if (b.columns.primitive) b.columns.primitive[i] = is_within ? best.id : NO_VERTEX;
    if (b.columns.feature) b.columns.feature[i] = is_within ? (uint8_t)best.nearest.feature : 255;
    if (!is_within) {
        const double nan = P2M_NAN;
        if (b.columns.weights) store<S>(b.columns.weights, i, nan, nan, nan);
        if (b.columns.point) store<S>(b.columns.point, i, nan, nan, nan);
        return;
    }
    if (b.columns.weights) {
        const double *w = best.nearest.weight;
        store<S>(b.columns.weights, i, w[0], w[1], w[2]);
    }
    if (b.columns.point) {
        const Primitive primitive = b.index.primitives[best.plate];
        V3 vertices[3];
        int count = 0;
        for (; count < 3 && primitive.vertex[count] != NO_VERTEX; count++)
            vertices[count] = load<S>(b.index.vertices, primitive.vertex[count]);
        V3 point = point_of(best.nearest, q, vertices, count);
        store<S>(b.columns.point, i, point.x, point.y, point.z);
    }
}

// Returns whether a plate can be the nearest, given an upper bound on the distance.
P2M_FUNCTION bool is_candidate(const Plate &plate, F3 p, float upper, float fixed) {
    float limit = candidate_limit(upper, plate.length, fixed);
    return square_of(plate, p) <= limit * limit * ENLARGED;
}

template <class S> P2M_FUNCTION Best start(const Batch &b) {
    Best best;
    best.is_found = best.is_undecided = false;
    best.prune = b.prune;
    best.certified = P2M_INFINITY;
    return best;
}

template <class S> P2M_FUNCTION void finish(const Batch &b, uint32_t i, V3 q, const Best &best) {
    if (best.is_undecided)
        b.undecided[take(b.undecided_count, 1u)] = i;
    else
        write<S>(b, i, q, best);
}

// Answers a query by the list of its cell. Queries in cells without a list are left to `answer_by_tree`.
template <class S> P2M_FUNCTION void answer_by_list(uint32_t thread, const Batch &b) {
    const Index &index = b.index;
    const uint32_t i = b.order ? b.order[thread] : thread;
    const V3 q = query<S>(b, i);
    F3 p;
    Entry list;
    if (!place(index, q, p)) {
        b.undecided[take(b.undecided_count, 1u)] = i;
        return;
    }
    if (!locate(index.grids, index.grid_count, index.entries, p, list)) {
        b.rest[take(b.rest_count, 1u)] = i;
        return;
    }
    const float fixed = fixed_error(p);
    float square = 3e38f, length = 0.0f;
    for (uint32_t k = list.first; k < list.first + list.count; k++) {
        const Plate plate = load(index.plates + index.items[k]);
        float s = square_of(plate, p);
        length = s < square ? plate.length : length;
        square = smaller(s, square);
    }
    const float upper = upper_bound(root(square), length, fixed);
    Best best = start<S>(b);
    for (uint32_t k = list.first; k < list.first + list.count; k++) {
        uint32_t plate = index.items[k];
        if (is_candidate(load(index.plates + plate), p, upper, fixed)) decide<S>(b, q, plate, best);
    }
    finish<S>(b, i, q, best);
}

// Answers a query by the tree, because its cell has no list.
template <class S> P2M_FUNCTION void answer_by_tree(uint32_t thread, const Batch &b) {
    if (thread >= *b.rest_count) return;
    const Index &index = b.index;
    const uint32_t i = b.rest[thread];
    const V3 q = query<S>(b, i);
    F3 p;
    place(index, q, p);
    const float fixed = fixed_error(p);
    float square;
    uint32_t nearest = nearest_plate(index.nodes, index.plates, p, 0, square);
    const float upper = upper_bound(root(square), load(index.plates + nearest).length, fixed);
    const float limit = box_limit(upper, fixed);
    Best best = start<S>(b);
    walk(index.nodes, p, limit, [&](uint32_t first, uint32_t count) {
        for (uint32_t plate = first; plate < first + count; plate++)
            if (is_candidate(load(index.plates + plate), p, upper, fixed)) decide<S>(b, q, plate, best);
        return limit;
    });
    finish<S>(b, i, q, best);
}

// `gather` copies a query that the processor has to answer, and `put` writes the processor's answer.
template <class S> P2M_FUNCTION void gather(uint32_t i, const Batch &b) {
    V3 q = query<S>(b, b.undecided[i]);
    store<S>(b.gathered, i, q.x, q.y, q.z);
}
template <class S> P2M_FUNCTION void put(uint32_t i, const Batch &b) {
    const Columns &from = b.answers, &to = b.columns;
    const uint32_t at = b.undecided[i];
    if (to.distance) ((S *)to.distance)[at] = ((const S *)from.distance)[i];
    if (to.lower_bound) ((S *)to.lower_bound)[at] = ((const S *)from.lower_bound)[i];
    for (int k = 0; k < 3; k++) {
        if (to.point) ((S *)to.point)[3 * (size_t)at + k] = ((const S *)from.point)[3 * (size_t)i + k];
        if (to.weights) ((S *)to.weights)[3 * (size_t)at + k] = ((const S *)from.weights)[3 * (size_t)i + k];
    }
    if (to.primitive) to.primitive[at] = from.primitive[i];
    if (to.feature) to.feature[at] = from.feature[i];
}

// Sorting of queries by the cells of a lattice of 128 to a side, with queries near the scene apart from queries far
// away. It is a counting sort in three kernels (count, place, scatter). The order within a cell and between groups of
// cells is arbitrary, because only locality matters.
constexpr uint32_t KEYS = 1u << 22, KEYS_PER_GROUP = 64;

P2M_FUNCTION uint32_t spread(uint32_t x) {
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

P2M_FUNCTION uint32_t lattice(float x) { return (uint32_t)smaller(larger((x + 1.0f) * 64.0f, 0.0f), 127.0f); }

template <class S> P2M_FUNCTION void count_key(uint32_t i, const Batch &b) {
    F3 p;
    uint32_t key = 0;
    if (place(b.index, query<S>(b, i), p)) {
        bool is_far = largest(p) > 1.0f;
        float s = is_far ? 1 / 16.0f : 1.0f;
        key = spread(lattice(p.x * s)) | spread(lattice(p.y * s)) << 1 | spread(lattice(p.z * s)) << 2;
        key |= is_far ? KEYS / 2 : 0;
    }
    b.keys[i] = key;
    b.ranks[i] = take(b.starts + key, 1u);
}
// Assigns consecutive places to the keys of a group. Groups take their places in the order in which they run.
P2M_FUNCTION void place_keys(uint32_t i, const Batch &b) {
    uint32_t *starts = b.starts + i * KEYS_PER_GROUP, sum = 0;
    for (uint32_t k = 0; k < KEYS_PER_GROUP; k++) sum += starts[k];
    uint32_t place = sum ? take(b.placed, sum) : 0;
    for (uint32_t k = 0; k < KEYS_PER_GROUP; k++) {
        uint32_t next = place + starts[k];
        starts[k] = place;
        place = next;
    }
}
P2M_FUNCTION void scatter(uint32_t i, const Batch &b) { b.order[b.starts[b.keys[i]] + b.ranks[i]] = i; }
