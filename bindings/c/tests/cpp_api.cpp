// Tests of p2m.hpp with point types of several libraries, with exceptions and without. The argument is a folder for
// files.
#include "p2m.hpp"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <list>
#include <thread>
#if __cplusplus >= 202002L
#include <span>
#endif

static int passed = 0, failed = 0;
#define CHECK(is_true) \
    ((is_true) ? (void)++passed : (void)(++failed, std::printf("%s:%d: %s\n", __FILE__, __LINE__, #is_true)))
// Checks that a call fails with a status, and that the message contains a word.
#define FAILS(status, word, call) CHECK(fails(P2M_STATUS_##status, word, [&] { return call; }))

#ifdef P2M_NO_EXCEPTIONS
template <class T> T get(p2m::Result<T> result) {
    if (!result) std::puts(result.error().what()), std::exit(1);
    return std::move(*result);
}
template <class Call> bool fails(p2m_status status, const char* word, Call call) {
    const auto result = call();
    return !result && result.error().status() == status && std::strstr(result.error().what(), word);
}
#else
template <class T> T get(T value) { return value; }
template <class Call> bool fails(p2m_status status, const char* word, Call call) {
    try {
        static_cast<void>(call());
    } catch (const p2m::Error& error) {
        return error.status() == status && std::strstr(error.what(), word);
    }
    return false;
}
#endif

// Types with the shapes of types of other libraries.
namespace glm_like {
template <class T> struct vec3 { T x, y, z; };
struct mat4 { // By columns.
    using col_type = std::array<float, 4>;
    col_type columns[4];
    const col_type& operator[](int column) const { return columns[column]; }
};
}
namespace eigen_like {
template <class T, bool RowMajor> struct Matrix {
    using Scalar = T;
    static constexpr bool IsRowMajor = RowMajor;
    long row_count, column_count;
    std::vector<T> numbers;
    Matrix(long rows, long columns) : row_count(rows), column_count(columns), numbers(size_t(rows * columns)) {}
    long rows() const { return row_count; }
    long cols() const { return column_count; }
    long innerStride() const { return 1; }
    long outerStride() const { return RowMajor ? column_count : row_count; }
    const T* data() const { return numbers.data(); }
    const T& operator()(long i, long j) const {
        return numbers[size_t(RowMajor ? i * outerStride() + j : j * outerStride() + i)];
    }
    T& operator()(long i, long j) { return const_cast<T&>(static_cast<const Matrix&>(*this)(i, j)); }
};
}
namespace cgal_like {
struct Point_3 {
    double numbers[3];
    double x() const { return numbers[0]; }
    double y() const { return numbers[1]; }
    double z() const { return numbers[2]; }
};
struct Vertex_index {
    uint32_t number;
    uint32_t idx() const { return number; }
};
struct Surface_mesh {
    std::vector<Point_3> points;
    std::vector<std::vector<Vertex_index>> polygons;
    std::vector<Vertex_index> vertices() const {
        std::vector<Vertex_index> all;
        for (uint32_t i = 0; i < points.size(); ++i) all.push_back({i});
        return all;
    }
    std::vector<size_t> faces() const {
        std::vector<size_t> all;
        for (size_t i = 0; i < polygons.size(); ++i) all.push_back(i);
        return all;
    }
    const Point_3& point(Vertex_index vertex) const { return points[vertex.number]; }
    size_t halfedge(size_t face) const { return face; }
    const std::vector<Vertex_index>& vertices_around_face(size_t halfedge) const { return polygons[halfedge]; }
};
}
struct Odd { double values[3]; };
template <> struct p2m::Coordinates<Odd> {
    static const double& at(const Odd& p, size_t i) { return p.values[2 - i]; }
};

using Vector = std::array<double, 3>;
// The cube from 0 to 1, whose faces look outwards.
static const std::vector<Vector> CUBE{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
static const std::vector<std::array<int, 3>> FACES{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
static const std::vector<Vector> QUERIES{{0.25, 0.25, 3}, {0.5, 0.4, 0.25}, {4, 5, 1}};
static const std::vector<double> DISTANCES{2, 0.25, 5};

// Each type of points gives the same distances, alone and in a batch.
template <class Rows> void points(const p2m::Index& index, const Rows& rows) {
    CHECK(get(index.distances(rows)) == DISTANCES);
    CHECK(get(index.closest_points(rows)).point[0] == (Vector{0.25, 0.25, 1}));
    size_t i = 0;
    for (const auto& row : rows) CHECK(get(index.closest_point(row)).distance == DISTANCES[i++]);
}

// Each type of matrices gives the same distances.
template <bool RowMajor> void matrices() {
    eigen_like::Matrix<double, RowMajor> v(8, 3), wrong(8, 2);
    eigen_like::Matrix<int, RowMajor> f(12, 3);
    eigen_like::Matrix<float, RowMajor> q(3, 3);
    for (int i = 0; i < 24; ++i) v(i / 3, i % 3) = CUBE[size_t(i / 3)][size_t(i % 3)];
    for (int i = 0; i < 36; ++i) f(i / 3, i % 3) = FACES[size_t(i / 3)][size_t(i % 3)];
    for (int i = 0; i < 9; ++i) q(i / 3, i % 3) = float(QUERIES[size_t(i / 3)][size_t(i % 3)]);
    const auto index = get(p2m::Index::build(get(p2m::Scene::make(v, f)), "kdop"));
    CHECK(get(index.distances(q)) == DISTANCES);
    FAILS(INVALID_ARGUMENT, "stride", index.distances(wrong));
    eigen_like::Matrix<double, RowMajor> motion(4, 4);
    for (int i = 0; i < 4; ++i) motion(i, i) = 1;
    motion(0, 3) = 4;
    CHECK(get(index.closest_pair(index, motion)).distance == 3);
}

static void types(const p2m::Index& index) {
    points(index, QUERIES);
    std::vector<glm_like::vec3<float>> floats;
    std::vector<cgal_like::Point_3> foreign;
    std::vector<Odd> odd;
    std::vector<std::array<float, 4>> padded;
    for (const auto& q : QUERIES) {
        floats.push_back({float(q[0]), float(q[1]), float(q[2])});
        foreign.push_back({{q[0], q[1], q[2]}});
        odd.push_back({{q[2], q[1], q[0]}});
        padded.push_back({float(q[0]), float(q[1]), float(q[2]), 9});
    }
    points(index, floats);
    points(index, foreign);
    points(index, odd);
    points(index, padded);
    points(index, std::list<Vector>(QUERIES.begin(), QUERIES.end()));
    CHECK(get(index.distances({QUERIES[0].data(), 3})) == DISTANCES);
    const double plain[3][3] = {{0.25, 0.25, 3}, {0.5, 0.4, 0.25}, {4, 5, 1}};
    points(index, plain);
    CHECK(get(index.closest_point({0.25, 0.25, 3})).distance == 2);
#if __cplusplus >= 202002L
    points(index, std::span<const Vector>(QUERIES));
#endif
    matrices<true>();
    matrices<false>();

    cgal_like::Surface_mesh mesh;
    for (const auto& p : CUBE) mesh.points.push_back({{p[0], p[1], p[2]}});
    for (const auto& f : FACES) mesh.polygons.push_back({{uint32_t(f[0])}, {uint32_t(f[1])}, {uint32_t(f[2])}});
    const auto scene = get(p2m::Scene::from_surface_mesh(mesh));
    CHECK(get(scene.counts())[0] == 12 && get(scene.bounds())[1] == (Vector{1, 1, 1}));
    mesh.polygons[5].pop_back();
    FAILS(INVALID_SCENE, "triangle", p2m::Scene::from_surface_mesh(mesh));
}

static void queries(const p2m::Index& index) {
    const auto answer = get(index.closest_point(QUERIES[0]));
    CHECK(answer.primitive == 2 && answer.point[2] == 1 && p2m::has_answer(answer));
    CHECK(!p2m::has_answer(get(index.closest_point(QUERIES[0], 1.5))));
    FAILS(INVALID_ARGUMENT, "finite", index.closest_point({NAN, 0, 0}));

    using namespace p2m;
    const auto all = Distance | Primitive | ClosestPoint | Feature | Weights | LowerBound | Normal;
    const Answers answers = get(index.closest_points(QUERIES, all, BatchOptions(4.5).with_threads(2)));
    CHECK(answers.distance[1] == 0.25 && answers.primitive[0] == 2 && answers.point[0][2] == 1);
    CHECK(answers.feature[0] == 6 && answers.weights[0][0] == 0.5 && answers.lower_bound[0] <= 2);
    CHECK(answers.normal[0][2] == 1 && answers.primitive[2] == P2M_NO_PRIMITIVE && answers.feature[2] == 255);
    CHECK(get(index.closest_points(QUERIES)).feature.empty());

    struct { double distance; uint32_t primitive; } rows[3];
    std::vector<Vector> point(3), weights(3);
    std::array<uint8_t, 3> feature{};
    auto into = Columns().distance(&rows[0].distance, sizeof rows[0]).primitive(&rows[0].primitive, sizeof rows[0]);
    static_cast<void>(index.closest_points_into(QUERIES, into.point(point).feature(feature).weights(weights)));
    CHECK(rows[2].distance == 5 && rows[0].primitive == 2 && feature[0] == 6);
    CHECK(point[0][2] == 1 && weights[0][0] == 0.5);
    double bounds[2];
    FAILS(INVALID_ARGUMENT, "fewer", index.closest_points_into(QUERIES, into.normal(point).lower_bound(bounds)));
    Cancel cancel;
    std::thread([&] { cancel.set(); }).join();
    FAILS(CANCELLED, "cancelled", index.distances(QUERIES, BatchOptions().with_cancel(cancel)));

    const auto nearest = get(index.k_nearest(QUERIES[0], SIZE_MAX, 2.25));
    CHECK(nearest.size() > 1 && nearest.size() < 12 && nearest[0].distance == 2 && nearest[1].distance >= 2);
    CHECK(get(index.within(QUERIES[0], 2)).size() == 1);
    CHECK(get(index.is_any_within(QUERIES[0], 2)) && !get(index.is_any_within(QUERIES[0], 1.5)));
    int calls = 0;
    static_cast<void>(index.visit_within(QUERIES[0], 9, [&](const Closest&) { return ++calls < 3; }));
    CHECK(calls == 3);
    CHECK(get(index.signed_distances(QUERIES)) == (std::vector<double>{2, -0.25, 5}));
    CHECK(get(index.contains(QUERIES)) == (std::vector<uint8_t>{0, 1, 0}));
    FAILS(INVALID_ARGUMENT, "query", index.within({NAN, 0, 0}, 1));

    const auto down = ray({0.25, 0.3, 3}, {0, 0, -1}), up = ray({0.25, 0.3, 3}, {0, 0, 1});
    CHECK(get(index.first_hit(down)).t == 2 && !has_answer(get(index.first_hit(up))));
    CHECK(get(index.any_hit(down)) && !get(index.any_hit(up)));
    CHECK(get(index.first_hits(std::array<p2m_ray, 2>{up, down}))[1].t == 2);
    double sum = 0;
    static_cast<void>(index.visit_hits(down, [&](const Hit& hit) { sum += hit.t; }));
    CHECK(sum == 5);
#ifndef P2M_NO_EXCEPTIONS
    for (bool hits : {false, true}) {
        try {
            calls = 0;
            const auto stop = [&](const auto&) { ++calls, throw 7; };
            hits ? index.visit_hits(down, stop) : index.visit_within(QUERIES[0], 9, stop);
            CHECK(!"it throws");
        } catch (int thrown) {
            CHECK(thrown == 7 && calls == 1);
        }
    }
#endif
    const glm_like::mat4 motion{{{{1, 0, 0, 0}}, {{0, 1, 0, 0}}, {{0, 0, 1, 0}}, {{4, 0, 0, 1}}}};
    const double nested[4][4] = {{1, 0, 0, 4}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    CHECK(get(index.closest_pair(index)).is_intersecting);
    CHECK(get(index.closest_pair(index, motion)).distance == 3);
    CHECK(get(index.closest_pair(index, nested)).distance == 3);
    CHECK(get(index.closest_pair(index, &nested[0][0])).points[1][0] == 4);
    CHECK(!has_answer(get(index.closest_pair(index, nested, 2))));
}

int main(int count, char** arguments) {
    const auto scene = get(p2m::Scene::make(CUBE, FACES, std::vector<std::array<uint64_t, 2>>{}, std::vector<int>{}));
    p2m::Index index = get(p2m::Index::build(scene));
    CHECK(index.backend() == "aabb" && index.primitive_count() == 12 && index.memory_bytes() > 0);
    types(index);
    queries(index);
    const std::string path = std::string(count > 1 ? arguments[1] : ".") + "/cube++.p2m";
    static_cast<void>(index.save(path));
    CHECK(get(get(p2m::Index::load(path)).closest_point(QUERIES[0])).distance == 2);
    CHECK(get(get(p2m::Scene::read(path)).counts())[0] == 12);
    const auto large = get(p2m::Scene::make(std::vector<Vector>(8, Vector{0, 0, 0}), FACES));
    CHECK(get(get(index.refit(large)).closest_point({3, 4, 0})).distance == 5);
    FAILS(FILE, "/no/such", p2m::Index::load("/no/such.p2m"));
    FAILS(FILE, "/no/such", p2m::Scene::read("/no/such.obj"));
    FAILS(INVALID_ARGUMENT, "no such", p2m::Index::build(scene, "no such"));
    FAILS(INVALID_SCENE, "", p2m::Scene::make(CUBE, std::vector<std::array<int, 3>>{{0, 1, -1}}));
    const p2m::Index moved = std::move(index);
    CHECK(get(moved.closest_point(QUERIES[0])).distance == 2);
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed > 0;
}
