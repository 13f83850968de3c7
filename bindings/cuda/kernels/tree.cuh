// The tree: nodes of four children, whose boxes in f32 are rounded outwards.
#pragma once

#include "plate.cuh"

struct alignas(16) Node {
    float low_x[4], high_x[4], low_y[4], high_y[4], low_z[4], high_z[4];
    // The children, each a node or a run of plates. `first` is the number of the node or of the first plate, and
    // `count` the number of plates, or 0 for a node. An empty slot has a box that is infinitely far away.
    uint32_t first[4], count[4];
};
static_assert(sizeof(Node) == 128, "a cache line");

// The largest depth of a tree (src/scene.rs checks it), and the size of a stack that suffices for it.
constexpr int MAX_DEPTH = 40, STACK = 3 * MAX_DEPTH + 4;

P2M_FUNCTION float gap(float low, float high, float x) { return larger(larger(low - x, x - high), 0.0f); }

P2M_FUNCTION float box_square(const Node &n, int k, F3 p) {
    float x = gap(n.low_x[k], n.high_x[k], p.x), y = gap(n.low_y[k], n.high_y[k], p.y);
    float z = gap(n.low_z[k], n.high_z[k], p.z);
    return x * x + y * y + z * z;
}

// Visits the runs of plates depth first, the nearest box first. `visit(first, count)` returns the squared limit above
// which boxes are skipped from then on.
template <class Visit> P2M_FUNCTION void walk(const Node *nodes, F3 p, float limit, Visit visit) {
    uint32_t first[STACK], count[STACK];
    float square[STACK];
    int size = 0;
    uint32_t node = 0;
    while (true) {
        const Node n = nodes[node];
        float d[4];
        int order[4] = {0, 1, 2, 3};
        for (int k = 0; k < 4; k++) d[k] = box_square(n, k, p);
        // Sorts the children with the farthest first, so that the nearest ends up on top of the stack.
        for (int a = 1; a < 4; a++)
            for (int b = a; b > 0 && d[order[b - 1]] < d[order[b]]; b--) {
                int other = order[b];
                order[b] = order[b - 1];
                order[b - 1] = other;
            }
        for (int a = 0; a < 4; a++) {
            int k = order[a];
            if (d[k] <= limit) {
                first[size] = n.first[k];
                count[size] = n.count[k];
                square[size++] = d[k];
            }
        }
        while (true) {
            if (size == 0) return;
            size--;
            if (square[size] > limit) continue;
            if (count[size] == 0) break;
            limit = visit(first[size], count[size]);
        }
        node = first[size];
    }
}

// Returns the computed square above which a box certainly has nothing within `reach` of the query.
P2M_FUNCTION float box_limit(float reach, float fixed) {
    float r = (reach + fixed) * ENLARGED;
    return r * r * ENLARGED;
}

// Returns the plate with the least computed square, starting from the candidate `best`.
P2M_FUNCTION uint32_t nearest_plate(const Node *nodes, const Plate *plates, F3 p, uint32_t best, float &square) {
    square = square_of(load(plates + best), p);
    walk(nodes, p, square, [&](uint32_t first, uint32_t count) {
        for (uint32_t k = first; k < first + count; k++) {
            float s = square_of(load(plates + k), p);
            if (s < square) {
                square = s;
                best = k;
            }
        }
        return square;
    });
    return best;
}
