// p2m for C++17 and later: closest points of scenes of triangles, segments and points.
//
//     p2m::Scene scene = p2m::Scene::make(positions, triangles);  // vectors of points, Eigen matrices, ..
//     p2m::Index index = p2m::Index::build(scene);
//     p2m::Closest answer = index.closest_point({0.0, 0.5, 1.0});
//     std::vector<double> distances = index.distances(queries);
//
// p2m.h documents units, threads and answers. A failure throws a p2m::Error. If P2M_NO_EXCEPTIONS is defined, functions
// return a p2m::Result instead, which holds a value or an error; otherwise Result<T> below is T. If memory cannot be
// allocated, std::bad_alloc is thrown, as in the standard library.
//
// A point may have any type with `p[i]`, with members x, y, z, or with functions x(), y(), z(). For other types,
// specialise p2m::Coordinates. No other library is included: the types of Eigen, glm and CGAL fit by their shape.
#ifndef P2M_HPP
#define P2M_HPP

#include "p2m.h"

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

// A program may link translation units with exceptions and without.
#ifdef P2M_NO_EXCEPTIONS
#define P2M_MODE results
#else
#define P2M_MODE exceptions
#endif

namespace p2m {
inline namespace P2M_MODE {

using Closest = p2m_closest;
using Hit = p2m_hit;
using Pair = p2m_pair;

constexpr double infinity = std::numeric_limits<double>::infinity();

// Returns whether a query has an answer.
inline bool has_answer(const Closest& answer) { return answer.primitive != P2M_NO_PRIMITIVE; }
inline bool has_answer(const Hit& hit) { return hit.primitive != P2M_NO_PRIMITIVE; }
inline bool has_answer(const Pair& pair) { return pair.primitives[0] != P2M_NO_PRIMITIVE; }

// A failure: its status and its message.
class Error : public std::runtime_error {
public:
    Error(p2m_status status, const std::string& message) : std::runtime_error(message), status_(status) {}
    p2m_status status() const { return status_; }

private:
    p2m_status status_;
};

#ifdef P2M_NO_EXCEPTIONS
// A value or an error. Check it before use: the value of an error is undefined.
template <class T> class [[nodiscard]] Result {
public:
    Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : held_(std::in_place_index<1>, std::move(error)) {}
    explicit operator bool() const { return held_.index() == 0; }
    T& operator*() & { return *std::get_if<0>(&held_); }
    const T& operator*() const& { return *std::get_if<0>(&held_); }
    T&& operator*() && { return std::move(*std::get_if<0>(&held_)); }
    T* operator->() { return std::get_if<0>(&held_); }
    const T* operator->() const { return std::get_if<0>(&held_); }
    const Error& error() const { return *std::get_if<1>(&held_); }

private:
    std::variant<T, Error> held_;
};
template <> class [[nodiscard]] Result<void> : public Result<std::monostate> {
public:
    Result() : Result<std::monostate>(std::monostate()) {}
    Result(Error error) : Result<std::monostate>(std::move(error)) {}
};
#else
template <class T> using Result = T;
#endif

// The coordinates of a point type, and the vertices of a triangle type. Specialise it for other types.
template <class P, class = void> struct Coordinates {
    static decltype(auto) at(const P& p, size_t i) { return (p[i]); }
};

namespace detail {

#ifdef P2M_NO_EXCEPTIONS
template <class T> Result<T> fail(Error error) { return error; }
#else
template <class T> [[noreturn]] T fail(const Error& error) { throw error; }
#endif

// Returns the value of a call, or the error of its status.
template <class T> Result<T> done(p2m_status status, T value) {
    if (status != P2M_STATUS_OK) return fail<T>(Error(status, p2m_last_error()));
    return value;
}
inline Result<void> done(p2m_status status) {
    if (status != P2M_STATUS_OK) return fail<void>(Error(status, p2m_last_error()));
    return Result<void>();
}

template <class, class P, template <class> class Form> struct Has : std::false_type {};
template <class P, template <class> class Form> struct Has<std::void_t<Form<const P&>>, P, Form> : std::true_type {};
// Whether an expression with a value of the type compiles.
template <class P, template <class> class Form> constexpr bool has = Has<void, P, Form>::value;

template <class P> using Subscript = decltype(std::declval<P>()[0]);
template <class P> using Members = decltype(double(std::declval<P>().x + std::declval<P>().y + std::declval<P>().z));
template <class P> using Functions =
    decltype(double(std::declval<P>().x() + std::declval<P>().y() + std::declval<P>().z()));
template <class M> using Elements = decltype(double(std::declval<M>()(0, 0)));
template <class M> using Nested = decltype(double(std::declval<M>()[0][0]));
template <class M> using MatrixSize = decltype(std::declval<M>().rows() + std::declval<M>().cols());
template <class M> using Strides = decltype(std::declval<M>().data() + std::declval<M>().outerStride());
template <class M> using ColumnMajor = typename std::remove_reference_t<M>::col_type;
template <class R> using Begin = decltype(*std::begin(std::declval<R>()));
template <class R> using Contiguous = decltype(std::data(std::declval<R>()) + std::size(std::declval<R>()));

template <class T, bool IsIndex> constexpr bool is_read_in_place =
    IsIndex ? std::is_integral_v<T> && (sizeof(T) == 4 || sizeof(T) == 8)
            : std::is_same_v<T, float> || std::is_same_v<T, double>;

template <class T> constexpr uint32_t scalar_of =
    std::is_floating_point_v<T> ? (sizeof(T) == 4 ? P2M_SCALAR_F32 : P2M_SCALAR_F64)
                                : (sizeof(T) == 4 ? P2M_SCALAR_U32 : P2M_SCALAR_U64);

template <class T, void (*free)(T*)> struct Free {
    void operator()(T* object) const { free(object); }
};
template <class T, void (*free)(T*)> using Handle = std::unique_ptr<T, Free<T, free>>;

// Calls a function of p2m.h that writes an answer, and returns the answer.
template <class Answer, class Call> Result<Answer> asked(Call call) {
    Answer answer{};
    const p2m_status status = call(&answer);
    return done(status, answer);
}

// Calls a function of p2m.h that makes an object, and returns the object.
template <class Object, class T, class Call> Result<Object> made(Call call) {
    T* object = nullptr;
    const p2m_status status = call(&object);
    return done(status, Object(object));
}

} // namespace detail

template <class P> struct Coordinates<P, std::enable_if_t<std::is_arithmetic_v<P>>> {
    static const P& at(const P& p, size_t) { return p; }
};
template <class P>
struct Coordinates<P, std::enable_if_t<detail::has<P, detail::Members> && !detail::has<P, detail::Subscript>>> {
    static decltype(auto) at(const P& p, size_t i) { return (i == 0 ? p.x : i == 1 ? p.y : p.z); }
};
template <class P>
struct Coordinates<P, std::enable_if_t<detail::has<P, detail::Functions> && !detail::has<P, detail::Subscript>>> {
    static decltype(auto) at(const P& p, size_t i) { return (i == 0 ? p.x() : i == 1 ? p.y() : p.z()); }
};

// A point of any type, for arguments.
class Point {
public:
    Point(double x, double y, double z) : coordinates_{x, y, z} {}
    template <class P> Point(const P& p)
        : coordinates_{double(Coordinates<P>::at(p, 0)), double(Coordinates<P>::at(p, 1)),
                       double(Coordinates<P>::at(p, 2))} {}
    const double* data() const { return coordinates_; }

private:
    double coordinates_[3];
};

// Rows of an array of the caller, for arguments: three coordinates, or one to three indices of vertices. Vectors and
// spans of points, other ranges, and Eigen's matrices with a row for each point convert to it. Rows of float, double,
// and integers of 32 or 64 bits are read in place if the numbers of a row follow each other; others are copied.
template <size_t N, bool IsIndex> class Rows {
public:
    Rows() = default;
    Rows(const Rows&) = delete;
    Rows& operator=(const Rows&) = delete;

    // Makes an array of `count` rows. `stride` is the number of bytes from one row to the next, or 0 if there are no
    // gaps.
    template <class T> Rows(const T* first, size_t count, size_t stride = 0)
        : array_{first, count, stride, detail::scalar_of<T>} {
        static_assert(detail::is_read_in_place<T, IsIndex>, "no type of coordinates or of indices");
    }

    template <class R, class = std::enable_if_t<detail::has<R, detail::Begin> || detail::has<R, detail::MatrixSize>>>
    Rows(const R& rows) {
        if constexpr (detail::has<R, detail::MatrixSize>) {
            read_matrix(rows);
        } else {
            read_range(rows);
        }
    }

    const p2m_array* get() const { return &array_; }
    size_t count() const { return array_.count; }

private:
    using Number = std::conditional_t<IsIndex, uint64_t, double>;

    template <class M> void read_matrix(const M& rows) {
        using T = typename M::Scalar;
        const auto count = static_cast<size_t>(rows.rows());
        if (static_cast<size_t>(rows.cols()) != N) {
            // A stride that no row can have, so that every call fails.
            array_ = {this, count, 1, detail::scalar_of<Number>};
            return;
        }
        if constexpr (detail::has<M, detail::Strides> && detail::is_read_in_place<T, IsIndex>) {
            if (M::IsRowMajor && (N == 1 || rows.innerStride() == 1)) {
                const auto stride = static_cast<size_t>(rows.outerStride()) * sizeof(T);
                array_ = {rows.data(), count, stride, detail::scalar_of<T>};
                return;
            }
        }
        for (size_t i = 0; i < count; ++i) {
            for (size_t j = 0; j < N; ++j) {
                copy_.push_back(static_cast<Number>(rows(static_cast<int64_t>(i), static_cast<int64_t>(j))));
            }
        }
        read_copy();
    }

    template <class R> void read_range(const R& rows) {
        using P = std::remove_cv_t<std::remove_reference_t<decltype(*std::begin(rows))>>;
        static_assert(N == 1 || !std::is_arithmetic_v<P>, "pass flat arrays by a pointer and a number of rows");
        using At = decltype(Coordinates<P>::at(std::declval<const P&>(), 0));
        using T = std::remove_cv_t<std::remove_reference_t<At>>;
        if constexpr (detail::has<R, detail::Contiguous> && std::is_lvalue_reference_v<At> &&
                      detail::is_read_in_place<T, IsIndex>) {
            if (std::size(rows) == 0) return;
            const P& row = *std::data(rows);
            const T* first = &Coordinates<P>::at(row, 0);
            bool follow = true;
            for (size_t j = 1; j < N; ++j) follow = follow && &Coordinates<P>::at(row, j) == first + j;
            if (follow) {
                array_ = {first, std::size(rows), sizeof(P), detail::scalar_of<T>};
                return;
            }
        }
        for (const auto& row : rows) {
            for (size_t j = 0; j < N; ++j) copy_.push_back(static_cast<Number>(Coordinates<P>::at(row, j)));
        }
        read_copy();
    }

    void read_copy() { array_ = {copy_.data(), copy_.size() / N, 0, detail::scalar_of<Number>}; }

    p2m_array array_{nullptr, 0, 0, detail::scalar_of<Number>};
    std::vector<Number> copy_;
};

using Points = Rows<3, false>;
using TriangleIndices = Rows<3, true>;
using SegmentIndices = Rows<2, true>;
using PointIndices = Rows<1, true>;

// A rotation and a translation, for arguments: a matrix of 4 x 4 of Eigen (Matrix4d, Isometry3d), of glm (by its
// columns), nested arrays by rows, or 16 numbers row by row. The default is the identity.
class Motion {
public:
    Motion() = default;
    template <class M> Motion(const M& m) : moves_(true) {
        for (int i = 0; i < 4; ++i) {
            for (int j = 0; j < 4; ++j) {
                double& number = numbers_[4 * i + j];
                if constexpr (detail::has<M, detail::Elements>) {
                    number = static_cast<double>(m(i, j));
                } else if constexpr (detail::has<M, detail::ColumnMajor>) {
                    number = static_cast<double>(m[j][i]);
                } else if constexpr (detail::has<M, detail::Nested>) {
                    number = static_cast<double>(m[i][j]);
                } else {
                    number = static_cast<double>(m[4 * i + j]);
                }
            }
        }
    }
    const double* data() const { return moves_ ? numbers_ : nullptr; }

private:
    double numbers_[16] = {};
    bool moves_ = false;
};

// A switch with which another thread, or a signal handler, cancels a batch.
class Cancel {
public:
    Cancel() : handle_(p2m_cancel_new()) {}
    void set() const { p2m_cancel_set(handle_.get()); }
    const p2m_cancel* get() const { return handle_.get(); }

private:
    detail::Handle<p2m_cancel, p2m_cancel_free> handle_;
};

// The options of a build. The name of a backend converts to them.
struct IndexOptions : p2m_index_options {
    IndexOptions(const char* name = nullptr) : p2m_index_options{name, 0, 0.0, 0, 0} {}
};

// The options of a batch. A number converts to them as the largest distance.
struct BatchOptions : p2m_batch_options {
    BatchOptions(double largest = infinity) : p2m_batch_options(p2m_batch_options_default()) { max_distance = largest; }
    BatchOptions& with_threads(uint32_t number) { return threads = number, *this; }
    BatchOptions& with_cancel(const Cancel& by) { return cancel = by.get(), *this; }
};

// The columns that a batch returns. Join them by |.
enum Wanted : unsigned { Distance = 1, Primitive = 2, ClosestPoint = 4, Feature = 8, Weights = 16, LowerBound = 32,
                         Normal = 64 };
constexpr Wanted operator|(Wanted a, Wanted b) { return Wanted(unsigned(a) | unsigned(b)); }

// The answers of a batch, as in p2m_columns. A column has a row for each query, or is empty if it was not requested.
struct Answers {
    std::vector<double> distance;
    std::vector<uint32_t> primitive;
    std::vector<std::array<double, 3>> point;
    std::vector<uint8_t> feature;
    std::vector<std::array<double, 3>> weights;
    std::vector<double> lower_bound;
    std::vector<std::array<double, 3>> normal;
};

// Memory of the caller for answers: vectors, arrays and spans, whose size is checked, or a pointer with the number of
// bytes from one row to the next.
class Columns {
public:
    template <class O> Columns& distance(O&& o, size_t skip = 0) { return set<double>(to_.distance, o, skip); }
    template <class O> Columns& primitive(O&& o, size_t skip = 0) { return set<uint32_t>(to_.primitive, o, skip); }
    template <class O> Columns& point(O&& o, size_t skip = 0) { return set<double[3]>(to_.point, o, skip); }
    template <class O> Columns& feature(O&& o, size_t skip = 0) { return set<uint8_t>(to_.feature, o, skip); }
    template <class O> Columns& weights(O&& o, size_t skip = 0) { return set<double[3]>(to_.weights, o, skip); }
    template <class O> Columns& lower_bound(O&& o, size_t skip = 0) { return set<double>(to_.lower_bound, o, skip); }
    template <class O> Columns& normal(O&& o, size_t skip = 0) { return set<double[3]>(to_.normal, o, skip); }
    const p2m_columns* get() const { return &to_; }
    // The number of rows of the shortest column.
    size_t rows() const { return rows_; }

private:
    template <class Row, class O> Columns& set(p2m_column& column, O& out, size_t stride) {
        using Number = std::remove_extent_t<Row>;
        if constexpr (std::is_pointer_v<O>) {
            static_assert(std::is_same_v<std::remove_pointer_t<O>, Number>, "a column of another type");
            column = {out, stride};
        } else {
            using Element = std::remove_reference_t<decltype(*std::data(out))>;
            static_assert(sizeof(Element) == sizeof(Row) && alignof(Element) == alignof(Row) &&
                              (!std::is_arithmetic_v<Element> || std::is_same_v<Element, Row>),
                          "a column of another type");
            rows_ = std::min(rows_, std::size(out));
            column = {std::data(out), 0};
        }
        return *this;
    }

    p2m_columns to_{};
    size_t rows_ = std::numeric_limits<size_t>::max();
};

// Returns a ray from a point in a direction.
inline p2m_ray ray(const Point& origin, const Point& direction) {
    p2m_ray ray{};
    std::copy_n(origin.data(), 3, ray.origin);
    std::copy_n(direction.data(), 3, ray.direction);
    ray.t_max = infinity;
    return ray;
}

// A scene. It never changes.
class Scene {
public:
    // Takes ownership of an object of p2m.h, and frees it.
    explicit Scene(p2m_scene* handle) : handle_(handle) {}
    const p2m_scene* get() const { return handle_.get(); }

    // Makes a scene. Primitives are numbered from 0: first all triangles, then all segments, then all points.
    static Result<Scene> make(const Points& positions, const TriangleIndices& triangles,
                              const SegmentIndices& segments = {}, const PointIndices& points = {}) {
        return detail::made<Scene, p2m_scene>([&](auto made) {
            return p2m_scene_new(positions.get(), triangles.get(), segments.get(), points.get(), made);
        });
    }

    static Result<Scene> read(const std::string& path) {
        return detail::made<Scene, p2m_scene>([&](auto made) { return p2m_scene_read(path.c_str(), made); });
    }

    // Makes a scene from a triangle mesh with the functions of CGAL's Surface_mesh. The id of a primitive is the place
    // of its face in `faces()`.
    template <class Mesh> static Result<Scene> from_surface_mesh(const Mesh& mesh) {
        std::vector<std::array<double, 3>> positions;
        for (auto vertex : mesh.vertices()) {
            const auto i = static_cast<size_t>(vertex.idx());
            if (i >= positions.size()) positions.resize(i + 1);
            const Point point(mesh.point(vertex));
            std::copy_n(point.data(), 3, positions[i].begin());
        }
        std::vector<uint64_t> triangles;
        size_t faces = 0;
        for (auto face : mesh.faces()) {
            for (auto vertex : mesh.vertices_around_face(mesh.halfedge(face))) {
                triangles.push_back(static_cast<uint64_t>(vertex.idx()));
            }
            if (triangles.size() != 3 * ++faces) {
                return detail::fail<Scene>(Error(P2M_STATUS_INVALID_SCENE, "a face of the mesh is not a triangle"));
            }
        }
        return make(positions, {triangles.data(), faces});
    }

    // Returns the numbers of triangles, segments and points.
    Result<std::array<size_t, 3>> counts() const {
        size_t counts[3] = {};
        const auto status = p2m_scene_counts(get(), &counts);
        return detail::done(status, std::array<size_t, 3>{counts[0], counts[1], counts[2]});
    }

    // Returns the lowest and the highest coordinates of all primitives.
    Result<std::array<std::array<double, 3>, 2>> bounds() const {
        double low[3] = {}, high[3] = {};
        const auto status = p2m_scene_bounds(get(), &low, &high);
        std::array<std::array<double, 3>, 2> bounds{{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}};
        return detail::done(status, bounds);
    }

private:
    detail::Handle<p2m_scene, p2m_scene_free> handle_;
};

// An index over a scene, which it keeps alive. Any number of threads may query it.
class Index {
public:
    // Takes ownership of an object of p2m.h, and frees it.
    explicit Index(p2m_index* handle) : handle_(handle) {}
    const p2m_index* get() const { return handle_.get(); }

    static Result<Index> build(const Scene& scene, const IndexOptions& options = {}) {
        return detail::made<Index, p2m_index>([&](auto made) { return p2m_index_build(scene.get(), &options, made); });
    }

    static Result<Index> load(const std::string& path) {
        return detail::made<Index, p2m_index>([&](auto made) { return p2m_index_load(path.c_str(), made); });
    }

    Result<void> save(const std::string& path) const { return detail::done(p2m_index_save(get(), path.c_str())); }

    // Returns an index over another scene that has as many primitives, in the same order.
    Result<Index> refit(const Scene& scene) const {
        return detail::made<Index, p2m_index>([&](auto made) { return p2m_index_refit(get(), scene.get(), made); });
    }

    std::string backend() const { return p2m_index_backend(get()); }
    size_t primitive_count() const { return p2m_index_primitive_count(get()); }
    size_t memory_bytes() const { return p2m_index_memory_bytes(get()); }

    // Finds the closest point within a distance. `has_answer` tells whether there is one.
    Result<Closest> closest_point(const Point& query, double max_distance = infinity) const {
        return detail::asked<Closest>([&](auto answer) {
            return p2m_closest_point(get(), query.data(), max_distance, answer);
        });
    }

    // Finds the closest points of many queries.
    Result<Answers> closest_points(const Points& queries, Wanted wanted = Distance | Primitive | ClosestPoint,
                                   const BatchOptions& options = {}) const {
        Answers answers;
        Columns columns;
        const auto size = [&](Wanted column, auto& rows) {
            if (wanted & column) rows.resize(queries.count());
            return (wanted & column) != 0;
        };
        if (size(Distance, answers.distance)) columns.distance(answers.distance);
        if (size(Primitive, answers.primitive)) columns.primitive(answers.primitive);
        if (size(ClosestPoint, answers.point)) columns.point(answers.point);
        if (size(Feature, answers.feature)) columns.feature(answers.feature);
        if (size(Weights, answers.weights)) columns.weights(answers.weights);
        if (size(LowerBound, answers.lower_bound)) columns.lower_bound(answers.lower_bound);
        if (size(Normal, answers.normal)) columns.normal(answers.normal);
        const auto status = p2m_closest_points(get(), queries.get(), &options, columns.get());
        return detail::done(status, std::move(answers));
    }

    // Finds the closest points of many queries, and writes them to memory of the caller.
    Result<void> closest_points_into(const Points& queries, const Columns& columns,
                                     const BatchOptions& options = {}) const {
        if (columns.rows() < queries.count()) {
            return detail::fail<void>(Error(P2M_STATUS_INVALID_ARGUMENT, "columns: one has fewer rows than queries"));
        }
        return detail::done(p2m_closest_points(get(), queries.get(), &options, columns.get()));
    }

    Result<std::vector<double>> distances(const Points& queries, const BatchOptions& options = {}) const {
        std::vector<double> distances(queries.count());
        const Columns columns = Columns().distance(distances);
        const auto status = p2m_closest_points(get(), queries.get(), &options, columns.get());
        return detail::done(status, std::move(distances));
    }

    // Returns the signed distances of many queries.
    Result<std::vector<double>> signed_distances(const Points& queries, const BatchOptions& options = {}) const {
        std::vector<double> distances(queries.count());
        const auto status = p2m_signed_distances(get(), queries.get(), &options, {distances.data(), 0});
        return detail::done(status, std::move(distances));
    }

    // Returns whether each query is inside, as 1 or 0.
    Result<std::vector<uint8_t>> contains(const Points& queries, const BatchOptions& options = {}) const {
        std::vector<uint8_t> is_inside(queries.count());
        const auto status = p2m_contains(get(), queries.get(), &options, {is_inside.data(), 0});
        return detail::done(status, std::move(is_inside));
    }

    // Returns the k nearest primitives within a distance, the nearest first.
    Result<std::vector<Closest>> k_nearest(const Point& query, size_t k, double max_distance = infinity) const {
        std::vector<Closest> answers(std::min(k, primitive_count()));
        size_t count = 0;
        const auto status = p2m_k_nearest(get(), query.data(), answers.size(), max_distance, answers.data(), &count);
        answers.resize(count);
        return detail::done(status, std::move(answers));
    }

    // Calls `visit` with each primitive within a radius, in any order, until it returns false. It may return nothing.
    // An exception that it throws ends the search and leaves this function.
    template <class Visit> Result<void> visit_within(const Point& query, double radius, Visit&& visit) const {
        Visitor<Visit> visitor{visit, {}};
        return visitor.end(p2m_visit_within(get(), query.data(), radius, visitor.template call<Closest>, &visitor));
    }

    // Returns the primitives within a radius, in any order.
    Result<std::vector<Closest>> within(const Point& query, double radius) const {
        std::vector<Closest> answers;
        Visitor visitor{[&](const Closest& answer) { answers.push_back(answer); }, {}};
        const auto status =
            p2m_visit_within(get(), query.data(), radius, visitor.template call<Closest>, &visitor);
        visitor.rethrow();
        return detail::done(status, std::move(answers));
    }

    Result<bool> is_any_within(const Point& query, double radius) const {
        return detail::asked<bool>([&](auto answer) { return p2m_is_any_within(get(), query.data(), radius, answer); });
    }

    // Finds the first hit of a ray. `has_answer` tells whether there is one.
    Result<Hit> first_hit(const p2m_ray& ray) const {
        return detail::asked<Hit>([&](auto answer) { return p2m_first_hit(get(), &ray, answer); });
    }

    Result<bool> any_hit(const p2m_ray& ray) const {
        return detail::asked<bool>([&](auto answer) { return p2m_any_hit(get(), &ray, answer); });
    }

    // Calls `visit` with all hits of a ray, the nearest first, as `visit_within` does.
    template <class Visit> Result<void> visit_hits(const p2m_ray& ray, Visit&& visit) const {
        Visitor<Visit> visitor{visit, {}};
        return visitor.end(p2m_visit_hits(get(), &ray, visitor.template call<Hit>, &visitor));
    }

    // Finds the first hits of a vector, an array or a span of rays.
    template <class R> Result<std::vector<Hit>> first_hits(const R& rays, const BatchOptions& options = {}) const {
        std::vector<Hit> hits(std::size(rays));
        const auto status = p2m_first_hits(get(), std::data(rays), std::size(rays), &options, hits.data());
        return detail::done(status, std::move(hits));
    }

    // Finds the nearest points of two scenes. `motion` moves the second one.
    Result<Pair> closest_pair(const Index& second, const Motion& motion = {}, double max_distance = infinity) const {
        return detail::asked<Pair>([&](auto answer) {
            return p2m_closest_pair(get(), second.get(), motion.data(), max_distance, answer);
        });
    }

private:

    // A visitor behind a C pointer. No exception may cross the C code.
    template <class Visit> struct Visitor {
        Visit visit;
        std::exception_ptr thrown;

        template <class Answer> static int call(const Answer* answer, void* user) {
            auto& self = *static_cast<Visitor*>(user);
#ifndef P2M_NO_EXCEPTIONS
            try {
                return self.ends(*answer);
            } catch (...) {
                self.thrown = std::current_exception();
                return 1;
            }
#else
            return self.ends(*answer);
#endif
        }
        template <class Answer> int ends(const Answer& answer) {
            if constexpr (std::is_void_v<decltype(visit(answer))>) {
                visit(answer);
                return 0;
            } else {
                return visit(answer) ? 0 : 1;
            }
        }
        void rethrow() {
#ifndef P2M_NO_EXCEPTIONS
            if (thrown) std::rethrow_exception(thrown);
#endif
        }
        Result<void> end(p2m_status status) {
            rethrow();
            return detail::done(status);
        }
    };
    template <class Visit> Visitor(Visit, std::exception_ptr) -> Visitor<Visit>;

    detail::Handle<p2m_index, p2m_index_free> handle_;
};

} // namespace P2M_MODE
} // namespace p2m

#undef P2M_MODE

#endif // P2M_HPP
