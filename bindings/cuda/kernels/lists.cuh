// Interception lists: for each cell of an octree, the primitives that can be nearest to some point of it.
//
// The roots are a dense grid of cubes whose sides are a power of two, so a query finds its cell by exact arithmetic.
//
// A primitive is left out of a cell if one point of the scene, an anchor, is nearer at all eight corners, by more than
// the slack. Then the anchor is nearer everywhere in the cell: the squared distance to a primitive less the squared
// distance to a point is a concave function of the query, so it is positive in a cube if it is positive at the corners
// (docs/proofs/cuda.md, "Lists").
//
// Lists are made level by level. A root takes its candidates from the tree, and its children take theirs from its list.
#pragma once

#include "tree.cuh"

// Special values of `count` in an entry: the cell is divided, or it has no list and its queries search the tree.
constexpr uint32_t DIVIDED = 0xffffffffu, NO_LIST = 0xfffffffeu;
// The most candidates of a cell that its children take from it. The children of a cell with more search the tree anew.
constexpr int MAX_CANDIDATES = 192;
constexpr uint32_t FROM_TREE = 0xffffffffu;

struct Entry {
    uint32_t first, count; // of the list, or of the eight children
};

struct Grid {
    int low[3], cells[3];    // in roots
    int levels;              // of children below the roots
    float per_cell;          // 1 / the side of a cell of the last level
    uint32_t first_entry;    // that of the roots
};

// Finds the entry of the cell that contains a point. Returns `false` if there is no list.
P2M_FUNCTION bool locate(const Grid *grids, int grid_count, const Entry *entries, F3 p, Entry &entry) {
    for (int g = 0; g < grid_count; g++) {
        const Grid &grid = grids[g];
        float x = floorf(p.x * grid.per_cell), y = floorf(p.y * grid.per_cell), z = floorf(p.z * grid.per_cell);
        if (!(largest(F3{x, y, z}) < 0x1p30f)) continue;
        int level = grid.levels;
        int i = (int)x - (grid.low[0] * (1 << level)), j = (int)y - (grid.low[1] * (1 << level)), k = (int)z - (grid.low[2] * (1 << level));
        if (i < 0 || j < 0 || k < 0) continue;
        if (i >> level >= grid.cells[0] || j >> level >= grid.cells[1] || k >> level >= grid.cells[2]) continue;
        entry = entries[grid.first_entry + (i >> level) + grid.cells[0] * ((j >> level) + grid.cells[1] * (k >> level))];
        while (entry.count == DIVIDED) {
            level--;
            entry = entries[entry.first + ((i >> level & 1) | (j >> level & 1) << 1 | (k >> level & 1) << 2)];
        }
        return entry.count != NO_LIST;
    }
    return false;
}

// A cell whose list is to be made.
struct Cell {
    uint32_t entry;          // where its entry goes
    int at[3];               // its lower corner, in cells of its level
    uint32_t first, count;   // the candidates of its parent, or FROM_TREE
};

// Counters that all threads of a level share. They count refused requests as well, so they have 64 bits, which never
// wrap around.
struct Counters {
    uint64_t list_items, entries, cells, candidates; // how many there are
    uint64_t left_out;                               // cells without a list
};

// Adds to a counter, and returns its previous value.
template <class T> P2M_FUNCTION T take(T *counter, T amount) {
#ifdef __CUDACC__
    return atomicAdd(counter, amount);
#else
    return __atomic_fetch_add(counter, amount, __ATOMIC_RELAXED);
#endif
}

// Takes `amount` items of a capacity. Returns whether they fit; `first` is the number of the first item.
P2M_FUNCTION bool take_of(uint64_t *counter, uint32_t amount, uint32_t capacity, uint32_t &first) {
    uint64_t before = take(counter, (uint64_t)amount);
    first = (uint32_t)before;
    return before + amount <= capacity;
}

// The anchors of a cell: for each of its eight corners and its centre, the nearest point of the scene, with upper
// bounds on its distances from all eight corners.
struct Anchors {
    F3 corner[9];
    float fixed;
    float bound[9][8];

    P2M_FUNCTION void set_cell(const int *at, float side) {
        F3 low = {at[0] * side, at[1] * side, at[2] * side};
        float far = 0.0f;
        for (int k = 0; k < 8; k++) {
            corner[k] = {low.x + (k & 1 ? side : 0), low.y + (k & 2 ? side : 0), low.z + (k & 4 ? side : 0)};
            far = larger(far, largest(corner[k]));
        }
        corner[8] = {low.x + side / 2, low.y + side / 2, low.z + side / 2};
        fixed = FIXED_ERROR * (far + 1.0f);
    }

    P2M_FUNCTION void set_anchor(int j, const Plate &plate) {
        F3 y = foot_of(plate, corner[j]);
        // The slack covers the rounding of the anchor and its distance from its plate.
        float distance = root(norm_squared(sub(corner[j], y)));
        float slack = 4 * fixed + RELATIVE_ERROR * (distance + plate.length);
        for (int k = 0; k < 8; k++) bound[j][k] = (root(norm_squared(sub(corner[k], y))) + slack) * ENLARGED;
    }

    // Returns whether a primitive or box, given lower bounds on its distances from the corners, can be nearest in the
    // cell.
    P2M_FUNCTION bool is_needed(const float *lower) const {
        for (int j = 8; j >= 0; j--) {
            bool is_farther = true;
            for (int k = 0; k < 8 && is_farther; k++) is_farther = lower[k] > bound[j][k];
            if (is_farther) return false;
        }
        return true;
    }

    P2M_FUNCTION bool is_plate_needed(const Plate &plate) const {
        float lower[8];
        for (int k = 0; k < 8; k++) {
            float distance = root(square_of(plate, corner[k]));
            lower[k] = distance - (fixed + RELATIVE_ERROR * (distance + plate.length));
        }
        return is_needed(lower);
    }

    P2M_FUNCTION bool is_box_needed(const Node &n, int slot) const {
        float lower[8];
        for (int k = 0; k < 8; k++) {
            float distance = root(box_square(n, slot, corner[k]));
            lower[k] = distance - RELATIVE_ERROR * distance;
        }
        return is_needed(lower);
    }
};

// The parameters of `make_list`, which makes the lists of a level of a grid.
struct Building {
    const Node *nodes;
    const Plate *plates;
    Entry *entries;
    uint32_t *items;              // of lists
    const Cell *cells;
    Cell *children;
    const uint32_t *candidates;   // of the level above
    uint32_t *next_candidates;    // of this level
    Counters *counters;
    uint32_t item_capacity, entry_capacity, candidate_capacity, cell_capacity;
    float side;                   // of a cell of this level
    uint32_t divide_above;        // the length of a list above which a cell is divided
    uint32_t list_limit;          // the longest list of a cell of the last level
    uint32_t is_last_level;
};

P2M_FUNCTION void make_list(uint32_t i, const Building &b) {
    const Cell cell = b.cells[i];
    Anchors anchors;
    anchors.set_cell(cell.at, b.side);
    uint32_t found[MAX_CANDIDATES];
    int count = 0;
    if (cell.first == FROM_TREE) {
        uint32_t best = 0;
        for (int j = 8; j >= 0; j--) {
            float square;
            best = nearest_plate(b.nodes, b.plates, anchors.corner[j], best, square);
            anchors.set_anchor(j, load(b.plates + best));
        }
        uint32_t stack[STACK];
        int size = 0;
        stack[size++] = 0;
        while (size > 0 && count <= MAX_CANDIDATES) {
            const Node n = b.nodes[stack[--size]];
            for (int slot = 0; slot < 4; slot++) {
                if (n.low_x[slot] > n.high_x[slot] || !anchors.is_box_needed(n, slot)) continue;
                if (n.count[slot] == 0) {
                    stack[size++] = n.first[slot];
                    continue;
                }
                for (uint32_t k = n.first[slot]; k < n.first[slot] + n.count[slot]; k++) {
                    if (!anchors.is_plate_needed(load(b.plates + k))) continue;
                    if (count < MAX_CANDIDATES) found[count] = k;
                    count++;
                }
            }
        }
    } else {
        float square[9];
        uint32_t best[9];
        for (int j = 0; j < 9; j++) square[j] = 3e38f;
        for (uint32_t c = cell.first; c < cell.first + cell.count; c++) {
            uint32_t k = b.candidates[c];
            const Plate plate = load(b.plates + k);
            for (int j = 0; j < 9; j++) {
                float s = square_of(plate, anchors.corner[j]);
                if (s < square[j]) {
                    square[j] = s;
                    best[j] = k;
                }
            }
        }
        for (int j = 0; j < 9; j++) anchors.set_anchor(j, load(b.plates + best[j]));
        for (uint32_t c = cell.first; c < cell.first + cell.count; c++)
            if (anchors.is_plate_needed(load(b.plates + b.candidates[c]))) found[count++] = b.candidates[c];
    }
    bool is_complete = count <= MAX_CANDIDATES;
    Entry entry = {0, NO_LIST};
    if (!b.is_last_level && (!is_complete || (uint32_t)count > b.divide_above)) {
        uint32_t from = FROM_TREE, children, at;
        if (is_complete && take_of(&b.counters->candidates, count, b.candidate_capacity, from))
            for (int k = 0; k < count; k++) b.next_candidates[from + k] = found[k];
        else
            from = FROM_TREE;
        // The entries and cells that are counted are written as well, because the next level reads all of them.
        if (take_of(&b.counters->entries, 8, b.entry_capacity, children) &&
            take_of(&b.counters->cells, 8, b.cell_capacity, at)) {
            entry = {children, DIVIDED};
            for (uint32_t k = 0; k < 8; k++) {
                b.entries[children + k] = {0, NO_LIST};
                Cell child = {children + k, {0, 0, 0}, from, (uint32_t)count};
                for (int axis = 0; axis < 3; axis++) child.at[axis] = 2 * cell.at[axis] + (k >> axis & 1);
                b.children[at + k] = child;
            }
        }
    } else if (is_complete && (uint32_t)count <= b.list_limit) {
        uint32_t from;
        if (take_of(&b.counters->list_items, count, b.item_capacity, from)) {
            for (int k = 0; k < count; k++) b.items[from + k] = found[k];
            entry = {from, (uint32_t)count};
        }
    }
    if (entry.count == NO_LIST) take(&b.counters->left_out, (uint64_t)1);
    b.entries[cell.entry] = entry;
}
