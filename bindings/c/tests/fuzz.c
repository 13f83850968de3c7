// Calls the functions of p2m.h with arguments that a fuzzer chooses. Many arguments are invalid, but all pointers
// satisfy the requirements of the header. `cargo xtask c --fuzz SECONDS` runs it.
#include "p2m.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// The bytes of the fuzzer, which determine all arguments.
typedef struct {
    const uint8_t *data;
    size_t size;
} bytes;

static uint8_t next(bytes *input) {
    if (input->size == 0) return 0;
    input->size--;
    return *input->data++;
}

// Returns a coordinate, either small or special.
static double number(bytes *input) {
    static const double special[] = {0.0, -0.0, 1e-310, 1e-160, 1e160, 1.7e308, INFINITY, -INFINITY, NAN};
    uint8_t kind = next(input);
    if (kind >= 250) return special[kind % 9];
    int16_t value = (int16_t)(kind | next(input) << 8);
    return value / 64.0;
}

// Makes an array of rows of `width` numbers in its own memory, with gaps between rows or without. The caller frees it.
static p2m_array array(bytes *input, size_t width, size_t rows, int is_index) {
    uint8_t kind = next(input);
    int is_wide = kind & 1;
    size_t size = is_wide ? 8 : 4, gap = kind & 2 ? size : 0, stride = width * size + gap;
    uint8_t *data = malloc(rows * stride + 16);
    for (size_t row = 0; row < rows; row++)
        for (size_t k = 0; k < width; k++) {
            double value = is_index ? next(input) % 24 : number(input);
            uint8_t *to = data + row * stride + k * size;
            if (is_index && is_wide) *(uint64_t *)to = value > 22 ? UINT64_MAX : (uint64_t)value;
            else if (is_index) *(uint32_t *)to = (uint32_t)value;
            else if (is_wide) *(double *)to = value;
            else *(float *)to = (float)value;
        }
    uint32_t scalar = is_index ? (is_wide ? P2M_SCALAR_U64 : P2M_SCALAR_U32) : (is_wide ? P2M_SCALAR_F64 : P2M_SCALAR_F32);
    p2m_array made = {data, rows, gap || kind & 4 ? stride : 0, scalar};
    return made;
}

// Makes an array invalid, or leaves it as it is.
static p2m_array spoiled(bytes *input, p2m_array made) {
    switch (next(input)) {
    case 1: made.data = NULL; break;
    case 2: made.data = (const char *)made.data + 1; break;
    case 3: made.count = SIZE_MAX / 2; break;
    case 4: made.stride = 1; break;
    case 5: made.stride = SIZE_MAX - 7; break;
    case 6: made.scalar = 77; break;
    }
    return made;
}

static int visit_closest(const p2m_closest *answer, void *user) { return answer->distance < 0 || --*(int *)user < 0; }
static int visit_hit(const p2m_hit *hit, void *user) { return isnan(hit->t) || --*(int *)user < 0; }

static void ask(bytes *input, p2m_index *index, p2m_index *other) {
    size_t rows = next(input) % 40;
    p2m_array made = array(input, 3, rows, 0), queries = spoiled(input, made);
    p2m_batch_options options = p2m_batch_options_default();
    options.max_distance = next(input) % 4 ? INFINITY : number(input);
    options.threads = next(input) % 3;
    options.keeps_order = next(input) & 1;
    size_t stride = next(input) & 1 ? 40 : 0;
    char *out = malloc(7 * 40 * 40 + 40);
    p2m_columns columns;
    p2m_column *all[] = {&columns.distance, &columns.primitive, &columns.point, &columns.feature,
                         &columns.weights, &columns.lower_bound, &columns.normal};
    for (int k = 0; k < 7; k++) {
        uint8_t kind = next(input);
        all[k]->data = kind & 1 ? out + k * 1600 : NULL;
        all[k]->stride = kind == 255 ? 3 : stride;
    }
    p2m_closest_points(index, &queries, next(input) % 8 ? &options : NULL, next(input) % 16 ? &columns : NULL);
    p2m_column column = {next(input) % 16 ? out : NULL, stride};
    p2m_signed_distances(index, &queries, &options, column);
    p2m_contains(index, &queries, &options, column);
    free((void *)made.data);
    free(out);

    double query[3] = {number(input), number(input), number(input)}, radius = number(input);
    p2m_closest answers[8];
    size_t count = next(input) % 9;
    int left = next(input);
    bool is_any;
    p2m_closest_point(index, next(input) % 16 ? query : NULL, radius, answers);
    p2m_k_nearest(index, query, count, radius, answers, &count);
    p2m_visit_within(index, query, radius, next(input) % 16 ? visit_closest : NULL, &left);
    p2m_is_any_within(index, query, radius, &is_any);
    p2m_ray rays[2];
    for (int k = 0; k < 2; k++) {
        p2m_ray ray = {{number(input), number(input), number(input)}, {number(input), number(input), number(input)},
                       0, INFINITY, 0};
        if (next(input) % 4 == 0) ray.t_min = number(input), ray.t_max = number(input), ray.radius = number(input);
        rays[k] = ray;
    }
    p2m_hit hits[2];
    p2m_first_hit(index, rays, hits);
    p2m_any_hit(index, rays, &is_any);
    p2m_visit_hits(index, rays, visit_hit, &left);
    p2m_first_hits(index, rays, next(input) % 16 ? 2 : SIZE_MAX / 64, &options, hits);
    double motion[16] = {1, 0, 0, number(input), 0, 1, 0, number(input), 0, 0, 1, number(input), 0, 0, 0, 1};
    if (next(input) % 4 == 0) motion[next(input) % 16] = number(input);
    p2m_pair pair;
    p2m_closest_pair(index, other, next(input) % 4 ? motion : NULL, radius, &pair);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *const names[] = {NULL, "aabb", "kdop", "octree", "p2m", "brute", "auto", "", "\xff"};
    bytes all = {data, size}, *input = &all;
    p2m_array parts[4], given[4];
    for (int k = 0; k < 4; k++) {
        parts[k] = array(input, k == 0 ? 3 : 4 - k, next(input) % 24, k > 0);
        given[k] = spoiled(input, parts[k]);
    }
    p2m_scene *scene = NULL;
    p2m_index *index = NULL, *refitted = NULL;
    p2m_scene_new(&given[0], &given[1], next(input) % 4 ? &given[2] : NULL, &given[3], next(input) % 32 ? &scene : NULL);
    for (int k = 0; k < 4; k++) free((void *)parts[k].data);
    p2m_index_options options = {names[next(input) % 9], next(input), next(input) % 8 ? 0 : number(input),
                                 next(input) % 8 ? 0 : next(input), 1};
    p2m_index_build(scene, &options, &index);
    if (index) {
        p2m_index_refit(index, scene, &refitted);
        ask(input, index, refitted ? refitted : index);
    } else {
        ask(input, NULL, NULL);
    }
    size_t counts[3];
    double low[3], high[3];
    p2m_scene_counts(scene, &counts);
    p2m_scene_bounds(scene, &low, &high);
    if (strlen(p2m_last_error()) > 100000) abort();
    p2m_index_free(refitted);
    p2m_index_free(index);
    p2m_scene_free(scene);
    return 0;
}
