// Tests of every function of p2m.h, with known answers and every kind of error. The argument is a folder for files.
#include "p2m.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int passed, failed;
#define CHECK(is_true) \
    ((is_true) ? (void)++passed : (void)(++failed, printf("%s:%d: %s\n", __FILE__, __LINE__, #is_true)))
#define OK(call) CHECK((call) == P2M_STATUS_OK || (puts(p2m_last_error()), 0))
// Checks that a call fails with a status, and that the message contains a word.
#define FAILS(name, word, call) CHECK((call) == P2M_STATUS_##name && strstr(p2m_last_error(), word))
#define ARRAY(name, rows, type) ((p2m_array){name, rows, 0, P2M_SCALAR_##type})

// The cube from 0 to 1, whose faces look outwards.
static const double CUBE[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                  {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
static const uint32_t FACES[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
// A query above the cube, one inside and one off a corner.
static const double QUERIES[3][3] = {{0.25, 0.25, 3}, {0.5, 0.4, 0.25}, {4, 5, 1}};
static const double DISTANCES[3] = {2, 0.25, 5};

static p2m_index *build(const p2m_scene *scene, const char *backend) {
    p2m_index_options options = {backend, 0, 0, 0, 1};
    p2m_index *index = NULL;
    OK(p2m_index_build(scene, &options, &index));
    return index;
}

static p2m_scene *cube(void) {
    p2m_scene *scene = NULL;
    p2m_array positions = ARRAY(CUBE, 8, F64), triangles = ARRAY(FACES, 12, U32);
    OK(p2m_scene_new(&positions, &triangles, NULL, NULL, &scene));
    return scene;
}

static void scenes(const p2m_scene *scene) {
    size_t counts[3];
    double low[3], high[3];
    OK(p2m_scene_counts(scene, &counts));
    CHECK(counts[0] == 12 && counts[1] == 0 && counts[2] == 0);
    OK(p2m_scene_bounds(scene, &low, &high));
    CHECK(low[0] == 0 && low[2] == 0 && high[0] == 1 && high[2] == 1);

    // All kinds of primitives, of floats with a gap and of indices of 64 bits.
    float rows[4][4] = {{0, 0, 0, 9}, {1, 0, 0, 9}, {0, 1, 0, 9}, {0, 0, -7, 9}};
    uint64_t triangle[3] = {0, 1, 2}, segment[2] = {0, 3}, point[1] = {3};
    p2m_array positions = {rows, 4, sizeof rows[0], P2M_SCALAR_F32};
    p2m_array triangles = ARRAY(triangle, 1, U64), segments = ARRAY(segment, 1, U64), points = ARRAY(point, 1, U64);
    p2m_scene *mixed = NULL;
    OK(p2m_scene_new(&positions, &triangles, &segments, &points, &mixed));
    OK(p2m_scene_counts(mixed, &counts));
    CHECK(counts[0] == 1 && counts[1] == 1 && counts[2] == 1);
    OK(p2m_scene_bounds(mixed, &low, &high));
    CHECK(low[2] == -7 && high[0] == 1);

    p2m_scene *none = NULL;
    p2m_array bad = positions;
    segment[1] = (uint64_t)1 << 40;
    FAILS(INVALID_ARGUMENT, "32 bits", p2m_scene_new(&positions, NULL, &segments, NULL, &none));
    bad.stride = 6;
    FAILS(INVALID_ARGUMENT, "stride", p2m_scene_new(&bad, NULL, NULL, NULL, &none));
    bad = ARRAY((const char *)rows + 1, 3, F32);
    FAILS(INVALID_ARGUMENT, "address", p2m_scene_new(&bad, NULL, NULL, NULL, &none));
    bad = ARRAY(rows, SIZE_MAX / 2, F32);
    FAILS(INVALID_ARGUMENT, "memory", p2m_scene_new(&bad, NULL, NULL, NULL, &none));
    bad = ARRAY(NULL, 3, F32);
    FAILS(INVALID_ARGUMENT, "null", p2m_scene_new(&bad, NULL, NULL, NULL, &none));
    bad = ARRAY(rows, 3, U32);
    FAILS(INVALID_ARGUMENT, "P2M_SCALAR_F64", p2m_scene_new(&bad, NULL, NULL, NULL, &none));
    FAILS(INVALID_ARGUMENT, "P2M_SCALAR_U64", p2m_scene_new(&positions, &positions, NULL, NULL, &none));
    FAILS(INVALID_ARGUMENT, "null", p2m_scene_new(&positions, &triangles, NULL, NULL, NULL));
    FAILS(INVALID_ARGUMENT, "null", p2m_scene_counts(NULL, &counts));
    FAILS(INVALID_ARGUMENT, "null", p2m_scene_counts(mixed, NULL));
    FAILS(INVALID_ARGUMENT, "null", p2m_scene_bounds(mixed, NULL, &high));
    FAILS(INVALID_ARGUMENT, "path", p2m_scene_read(NULL, &none));
    FAILS(FILE, "/no/such.obj", p2m_scene_read("/no/such.obj", &none));
    CHECK(none == NULL);
    OK(p2m_scene_new(NULL, NULL, NULL, NULL, &none));
    FAILS(INVALID_ARGUMENT, "no primitives", p2m_scene_bounds(none, &low, &high));
    p2m_scene_free(none);
    rows[0][0] = NAN;
    segment[1] = 1;
    FAILS(INVALID_SCENE, "finite", p2m_scene_new(&positions, &triangles, NULL, NULL, &none));
    FAILS(INVALID_SCENE, "finite", p2m_scene_new(&positions, NULL, &segments, NULL, &none));
    p2m_scene_free(mixed);
    p2m_scene_free(NULL);
}

static void indexes(const p2m_scene *scene, const char *folder) {
    p2m_index *index = NULL, *other = NULL;
    p2m_index_options options = {0};
    OK(p2m_index_build(scene, NULL, &index));
    CHECK(strcmp(p2m_index_backend(index), "aabb") == 0);
    CHECK(p2m_index_primitive_count(index) == 12 && p2m_index_memory_bytes(index) > 0);
    CHECK(!p2m_index_backend(NULL) && !p2m_index_primitive_count(NULL) && !p2m_index_memory_bytes(NULL));

    options.queries = 1000;
    OK(p2m_index_build(scene, &options, &other));
    p2m_index_free(other);
    options = (p2m_index_options){"octree", 0, 2.0, 0, 2};
    OK(p2m_index_build(scene, &options, &other));
    CHECK(strcmp(p2m_index_backend(other), "octree") == 0);
    p2m_index_free(other);
    options = (p2m_index_options){"kdop", 0, 0, 18, 0};
    OK(p2m_index_build(scene, &options, &other));
    p2m_index_free(other);
    other = NULL;
    options.kdop_faces = 15;
    FAILS(INVALID_ARGUMENT, "kdop_faces", p2m_index_build(scene, &options, &other));
    options = (p2m_index_options){"aabb", 0, NAN, 0, 0};
    FAILS(INVALID_ARGUMENT, "resolution", p2m_index_build(scene, &options, &other));
    options = (p2m_index_options){"no such", 0, 0, 0, 0};
    FAILS(INVALID_ARGUMENT, "no such", p2m_index_build(scene, &options, &other));
    options = (p2m_index_options){"aabb", 0, 0, 0, UINT32_MAX};
    FAILS(INVALID_ARGUMENT, "threads", p2m_index_build(scene, &options, &other));
    options = (p2m_index_options){"\xff", 0, 0, 0, 0};
    FAILS(INVALID_ARGUMENT, "UTF-8", p2m_index_build(scene, &options, &other));
    FAILS(INVALID_ARGUMENT, "scene", p2m_index_build(NULL, NULL, &other));
    FAILS(INVALID_ARGUMENT, "index", p2m_index_build(scene, NULL, NULL));
    CHECK(other == NULL);

    // The cube, twice as large.
    double rows[8][3];
    for (int i = 0; i < 24; i++) rows[i / 3][i % 3] = 2 * CUBE[i / 3][i % 3];
    p2m_array positions = ARRAY(rows, 8, F64), triangles = ARRAY(FACES, 12, U32);
    p2m_scene *large = NULL;
    p2m_closest answer;
    OK(p2m_scene_new(&positions, &triangles, NULL, NULL, &large));
    OK(p2m_index_refit(index, large, &other));
    OK(p2m_closest_point(other, QUERIES[0], INFINITY, &answer));
    CHECK(answer.distance == 1);
    p2m_scene_free(large);
    p2m_index_free(other);
    triangles.count = 3;
    OK(p2m_scene_new(&positions, &triangles, NULL, NULL, &large));
    FAILS(INVALID_SCENE, "", p2m_index_refit(index, large, &other));
    p2m_scene_free(large);
    p2m_index *octree = build(scene, "octree"), *brute = build(scene, "brute");
    FAILS(UNSUPPORTED, "refit", p2m_index_refit(octree, scene, &other));
    p2m_index_free(octree);

    char path[4096];
    snprintf(path, sizeof path, "%s/cube.p2m", folder);
    OK(p2m_index_save(index, path));
    OK(p2m_index_load(path, &other));
    OK(p2m_closest_point(other, QUERIES[0], INFINITY, &answer));
    CHECK(answer.distance == 2 && strcmp(p2m_index_backend(other), "aabb") == 0);
    p2m_scene *read = NULL;
    OK(p2m_scene_read(path, &read));
    p2m_scene_free(read);
    p2m_index_free(other);
    other = NULL;
    FAILS(UNSUPPORTED, "saved", p2m_index_save(brute, path));
    FAILS(FILE, "/no/such", p2m_index_save(index, "/no/such/folder/x.p2m"));
    FAILS(FILE, "/no/such", p2m_index_load("/no/such.p2m", &other));
    FAILS(INVALID_ARGUMENT, "null", p2m_index_load(NULL, &other));
    CHECK(other == NULL);
    p2m_index_free(brute);
    p2m_index_free(index);
    p2m_index_free(NULL);
}

static int count_three(const p2m_closest *answer, void *user) {
    (void)answer;
    return ++*(int *)user == 3;
}

static void single(const p2m_index *index) {
    p2m_closest answer, near[12];
    const double nan[3] = {0, NAN, 0};
    OK(p2m_closest_point(index, QUERIES[0], INFINITY, &answer));
    CHECK(answer.distance == 2 && answer.lower_bound <= 2 && answer.point[2] == 1 && answer.primitive == 2);
    CHECK(answer.feature == 6 && answer.weights[0] == 0.5 && answer.weights[2] == 0.25);
    OK(p2m_closest_point(index, QUERIES[2], INFINITY, &answer));
    CHECK(answer.distance == 5 && answer.feature <= 2);
    OK(p2m_closest_point(index, QUERIES[0], 1.5, &answer));
    CHECK(answer.primitive == P2M_NO_PRIMITIVE && isinf(answer.distance) && answer.feature == 255);
    FAILS(INVALID_ARGUMENT, "index", p2m_closest_point(NULL, QUERIES[0], 1, &answer));
    FAILS(INVALID_ARGUMENT, "query", p2m_closest_point(index, NULL, 1, &answer));
    FAILS(INVALID_ARGUMENT, "finite", p2m_closest_point(index, nan, 1, &answer));
    FAILS(INVALID_ARGUMENT, "answer", p2m_closest_point(index, QUERIES[0], 1, NULL));
    FAILS(INVALID_ARGUMENT, "misaligned", p2m_closest_point(index, QUERIES[0], 1, (void *)((char *)near + 1)));
    FAILS(INVALID_ARGUMENT, "not a number", p2m_closest_point(index, QUERIES[0], NAN, &answer));

    size_t count = 99;
    OK(p2m_k_nearest(index, QUERIES[0], 3, INFINITY, near, &count));
    CHECK(count == 3 && near[0].distance == 2 && near[0].primitive == 2 && near[1].distance <= near[2].distance);
    OK(p2m_k_nearest(index, QUERIES[0], SIZE_MAX, 2, near, &count));
    CHECK(count == 1);
    OK(p2m_k_nearest(index, QUERIES[0], 0, 2, NULL, &count));
    CHECK(count == 0);
    FAILS(INVALID_ARGUMENT, "answers", p2m_k_nearest(index, QUERIES[0], 3, 0, NULL, &count));
    FAILS(INVALID_ARGUMENT, "not a number", p2m_k_nearest(index, QUERIES[0], 3, NAN, near, &count));
    FAILS(INVALID_ARGUMENT, "count", p2m_k_nearest(index, QUERIES[0], 3, INFINITY, near, NULL));

    int calls = 0;
    bool is_within = false;
    OK(p2m_visit_within(index, QUERIES[0], 2, count_three, &calls));
    CHECK(calls == 1);
    OK(p2m_visit_within(index, QUERIES[0], 9, count_three, (calls = 0, &calls)));
    CHECK(calls == 3);
    FAILS(INVALID_ARGUMENT, "visit", p2m_visit_within(index, QUERIES[0], 9, NULL, NULL));
    OK(p2m_is_any_within(index, QUERIES[0], 2, &is_within));
    CHECK(is_within);
    OK(p2m_is_any_within(index, QUERIES[0], 1.9, &is_within));
    CHECK(!is_within);
    FAILS(INVALID_ARGUMENT, "is_within", p2m_is_any_within(index, QUERIES[0], 2, NULL));
    FAILS(INVALID_ARGUMENT, "not a number", p2m_is_any_within(index, QUERIES[0], NAN, &is_within));
    FAILS(INVALID_ARGUMENT, "not a number", p2m_visit_within(index, QUERIES[0], NAN, count_three, &calls));
}

static void batches(const p2m_index *index) {
    struct row {
        double distance, point[3], weights[3], bound, normal[3];
        uint32_t primitive;
        uint8_t feature;
    } rows[3];
    double distances[3], wide[3][5];
    float floats[3][3];
    p2m_array queries = ARRAY(QUERIES, 3, F64), bad = ARRAY(QUERIES, SIZE_MAX / 32, F64);
    p2m_batch_options options = p2m_batch_options_default();
    p2m_columns columns = {.distance = {rows, sizeof *rows}, .primitive = {&rows->primitive, sizeof *rows},
                           .point = {rows->point, sizeof *rows}, .feature = {&rows->feature, sizeof *rows},
                           .weights = {rows->weights, sizeof *rows}, .lower_bound = {&rows->bound, sizeof *rows},
                           .normal = {rows->normal, sizeof *rows}};
    CHECK(isinf(options.max_distance) && !options.threads && !options.keeps_order && !options.cancel);
    OK(p2m_closest_points(index, &queries, NULL, &columns));
    for (int i = 0; i < 3; i++) {
        p2m_closest one;
        OK(p2m_closest_point(index, QUERIES[i], INFINITY, &one));
        CHECK(rows[i].distance == DISTANCES[i] && rows[i].primitive == one.primitive);
        CHECK(rows[i].feature == one.feature && rows[i].bound == one.lower_bound);
        CHECK(!memcmp(rows[i].point, one.point, sizeof one.point));
        CHECK(!memcmp(rows[i].weights, one.weights, sizeof one.weights));
    }
    CHECK(rows[0].normal[2] == 1 && rows[1].normal[2] == -1 && rows[2].normal[0] > 0.5);

    // Queries of floats, and of rows with a gap, by several threads and in their order.
    for (int i = 0; i < 9; i++) floats[i / 3][i % 3] = (float)(wide[i / 3][i % 3] = QUERIES[i / 3][i % 3]);
    columns = (p2m_columns){.distance = {distances, 0}};
    options = (p2m_batch_options){4.5, 3, true, NULL};
    queries = (p2m_array){wide, 3, sizeof wide[0], P2M_SCALAR_F64};
    OK(p2m_closest_points(index, &queries, &options, &columns));
    CHECK(distances[0] == 2 && distances[1] == 0.25 && isinf(distances[2]));
    queries = ARRAY(floats, 3, F32);
    OK(p2m_closest_points(index, &queries, NULL, &columns));
    CHECK(distances[0] == 2 && distances[2] == 5 && distances[1] == 0.25);

    FAILS(INVALID_ARGUMENT, "memory", p2m_closest_points(index, &bad, NULL, &columns));
    FAILS(INVALID_ARGUMENT, "columns", p2m_closest_points(index, &queries, NULL, NULL));
    columns.distance.stride = 4;
    FAILS(INVALID_ARGUMENT, "distance", p2m_closest_points(index, &queries, NULL, &columns));
    columns.distance.stride = SIZE_MAX - 7;
    FAILS(INVALID_ARGUMENT, "memory", p2m_closest_points(index, &queries, NULL, &columns));
    columns.distance.stride = 0;
    options.max_distance = NAN;
    FAILS(INVALID_ARGUMENT, "max_distance", p2m_closest_points(index, &queries, &options, &columns));
    options.max_distance = 1, options.threads = 1 << 30;
    FAILS(INVALID_ARGUMENT, "threads", p2m_closest_points(index, &queries, &options, &columns));
    p2m_cancel *cancel = p2m_cancel_new();
    options = p2m_batch_options_default(), options.cancel = cancel;
    OK(p2m_closest_points(index, &queries, &options, &columns));
    p2m_cancel_set(cancel);
    FAILS(CANCELLED, "cancelled", p2m_closest_points(index, &queries, &options, &columns));
    FAILS(CANCELLED, "cancelled", p2m_signed_distances(index, &queries, &options, columns.distance));
    floats[2][1] = INFINITY;
    FAILS(INVALID_ARGUMENT, "row 2", p2m_closest_points(index, &queries, NULL, &columns));
    p2m_cancel_free(cancel);
    p2m_cancel_set(NULL);
    p2m_cancel_free(NULL);

    uint8_t inside[3] = {9, 9, 9};
    queries = ARRAY(QUERIES, 3, F64);
    OK(p2m_signed_distances(index, &queries, NULL, columns.distance));
    CHECK(distances[0] == 2 && distances[1] == -0.25 && distances[2] == 5);
    OK(p2m_contains(index, &queries, NULL, (p2m_column){inside, 0}));
    CHECK(inside[0] == 0 && inside[1] == 1 && inside[2] == 0);
    options = p2m_batch_options_default(), options.max_distance = 1;
    OK(p2m_signed_distances(index, &queries, &options, columns.distance));
    CHECK(isnan(distances[0]) && distances[1] == -0.25);
    FAILS(INVALID_ARGUMENT, "null", p2m_signed_distances(index, &queries, NULL, (p2m_column){NULL, 0}));
    FAILS(INVALID_ARGUMENT, "null", p2m_contains(index, &queries, NULL, (p2m_column){NULL, 0}));
    FAILS(INVALID_ARGUMENT, "queries", p2m_contains(index, NULL, NULL, (p2m_column){inside, 0}));
}

static int count_hits(const p2m_hit *hit, void *user) {
    CHECK(hit->t == 1 + ++*(int *)user);
    return 0;
}

static void rays_and_pairs(const p2m_scene *scene, const p2m_index *index) {
    p2m_ray ray = {{0.25, 0.3, 3}, {0, 0, -1}, 0, INFINITY, 0}, rays[2] = {ray, ray};
    p2m_hit hit, hits[2];
    bool is_hit = false;
    int calls = 0;
    OK(p2m_first_hit(index, &ray, &hit));
    CHECK(hit.t == 2 && hit.point[2] == 1 && hit.primitive == 2 && hit.side == 1 && hit.weights[0] > 0);
    OK(p2m_any_hit(index, &ray, &is_hit));
    CHECK(is_hit);
    OK(p2m_visit_hits(index, &ray, count_hits, &calls));
    CHECK(calls == 2);
    rays[1].direction[2] = 1;
    OK(p2m_first_hits(index, rays, 2, NULL, hits));
    CHECK(hits[0].t == 2 && hits[1].primitive == P2M_NO_PRIMITIVE && isinf(hits[1].t));
    OK(p2m_first_hits(index, NULL, 0, NULL, NULL));
    FAILS(INVALID_ARGUMENT, "rays", p2m_first_hits(index, NULL, 2, NULL, hits));
    FAILS(INVALID_ARGUMENT, "memory", p2m_first_hits(index, rays, SIZE_MAX, NULL, hits));
    FAILS(INVALID_ARGUMENT, "hits", p2m_first_hits(index, rays, 2, NULL, NULL));
    FAILS(INVALID_ARGUMENT, "visit", p2m_visit_hits(index, &ray, NULL, NULL));
    FAILS(INVALID_ARGUMENT, "is_hit", p2m_any_hit(index, &ray, NULL));
    ray.direction[2] = 0;
    FAILS(INVALID_ARGUMENT, "ray", p2m_first_hit(index, &ray, &hit));
    p2m_index *octree = build(scene, "octree");
    FAILS(UNSUPPORTED, "aabb", p2m_first_hit(octree, rays, &hit));
    p2m_pair pair;
    FAILS(UNSUPPORTED, "pairs", p2m_closest_pair(index, octree, NULL, 9, &pair));
    p2m_index_free(octree);

    double motion[16] = {1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    OK(p2m_closest_pair(index, index, NULL, INFINITY, &pair));
    CHECK(pair.distance == 0 && pair.is_intersecting);
    OK(p2m_closest_pair(index, index, motion, INFINITY, &pair));
    CHECK(pair.distance == 3 && !pair.is_intersecting && pair.points[0][0] == 1 && pair.points[1][0] == 4);
    CHECK(pair.lower_bound <= 3 && pair.primitives[0] < 12);
    OK(p2m_closest_pair(index, index, motion, 2, &pair));
    CHECK(pair.primitives[0] == P2M_NO_PRIMITIVE && isinf(pair.distance));
    motion[0] = 2;
    FAILS(INVALID_ARGUMENT, "motion", p2m_closest_pair(index, index, motion, 2, &pair));
    FAILS(INVALID_ARGUMENT, "second", p2m_closest_pair(index, NULL, NULL, 2, &pair));
    FAILS(INVALID_ARGUMENT, "pair", p2m_closest_pair(index, index, NULL, 2, NULL));
}

int main(int count, char **arguments) {
    CHECK(strcmp(p2m_last_error(), "") == 0);
    CHECK(strncmp(p2m_version(), "0.", 2) == 0);
    p2m_scene *scene = cube();
    scenes(scene);
    indexes(scene, count > 1 ? arguments[1] : ".");
    p2m_index *index = build(scene, "aabb");
    single(index);
    batches(index);
    rays_and_pairs(scene, index);
    p2m_index_free(index);
    p2m_scene_free(scene);
    printf("%d passed, %d failed\n", passed, failed);
    return failed > 0;
}
