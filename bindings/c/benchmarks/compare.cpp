// Measures closest-point queries of p2m, CGAL's AABB_tree (double) and Embree's point query (float), which take turns
// in one program on one thread. Times are CPU times of the thread. Usage: compare SCENE.obj [QUERIES] [ROUNDS].
// docs/c.md has the command that compiles it with Debian's packages libcgal-dev and libembree-dev.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <random>
#include <sstream>
#include <time.h>
#include <vector>

#include "p2m.hpp"

using Vec = std::array<double, 3>;
using Face = std::array<std::uint32_t, 3>;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>;

static double seconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

template <class V> static V sub(V a, V b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
template <class V> static auto dot(V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The nearest point of a triangle in float: the projection onto the face if it is inside, else the nearest point of the
// edges.
using Single = std::array<float, 3>;
static Single nearest(Single p, Single a, Single b, Single c) {
    Single e = sub(b, a), f = sub(c, a), o = sub(p, a), best = a;
    float ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), oe = dot(o, e), of = dot(o, f), det = ee * ff - ef * ef;
    float s = oe * ff - of * ef, t = of * ee - oe * ef, least = INFINITY;
    if (s >= 0 && t >= 0 && s + t <= det && det > 0) {
        for (int k = 0; k < 3; k++) best[k] = a[k] + (s * e[k] + t * f[k]) / det;
        return best;
    }
    const Single ends[3][2] = {{a, b}, {b, c}, {c, a}};
    for (auto &[from, to] : ends) {
        Single d = sub(to, from), at;
        float u = std::min(std::max(dot(sub(p, from), d) / std::max(dot(d, d), 1e-30f), 0.0f), 1.0f);
        for (int k = 0; k < 3; k++) at[k] = from[k] + u * d[k];
        float square = dot(sub(p, at), sub(p, at));
        if (square < least) least = square, best = at;
    }
    return best;
}

struct Search {
    const std::vector<Single> *positions;
    const std::vector<Face> *faces;
    Single query;
    float distance;
};

static bool visit(RTCPointQueryFunctionArguments *arguments) {
    auto &search = *static_cast<Search *>(arguments->userPtr);
    const Face &face = (*search.faces)[arguments->primID];
    const auto &x = *search.positions;
    Single gap = sub(nearest(search.query, x[face[0]], x[face[1]], x[face[2]]), search.query);
    float distance = std::sqrt(dot(gap, gap));
    if (distance >= search.distance) return false;
    search.distance = arguments->query->radius = distance;
    return true;
}

int main(int count, char **arguments) {
    if (count < 2) return std::puts("usage: compare SCENE.obj [QUERIES] [ROUNDS]"), 2;
    const std::size_t n = count > 2 ? std::atol(arguments[2]) : 100000, rounds = count > 3 ? std::atol(arguments[3]) : 5;
    std::vector<Vec> positions;
    std::vector<Face> faces;
    std::ifstream file(arguments[1]);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string kind, word;
        words >> kind;
        if (kind == "v") {
            Vec x;
            words >> x[0] >> x[1] >> x[2];
            positions.push_back(x);
        } else if (kind == "f") {
            std::vector<std::uint32_t> corners;
            while (words >> word) corners.push_back(std::stoul(word) - 1);
            for (std::size_t k = 2; k < corners.size(); k++) faces.push_back({corners[0], corners[k - 1], corners[k]});
        }
    }
    Vec low = positions[0], high = low;
    for (auto &x : positions)
        for (int k = 0; k < 3; k++) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
    const double diagonal = std::sqrt(dot(sub(high, low), sub(high, low)));

    Mesh mesh;
    std::vector<Mesh::Vertex_index> vertices;
    for (auto &x : positions) vertices.push_back(mesh.add_vertex({x[0], x[1], x[2]}));
    for (auto &f : faces) mesh.add_face(vertices[f[0]], vertices[f[1]], vertices[f[2]]);
    CGAL::AABB_tree<Traits> cgal(CGAL::faces(mesh).first, CGAL::faces(mesh).second, mesh);
    cgal.accelerate_distance_queries();

    RTCDevice device = rtcNewDevice("threads=1");
    RTCScene embree = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto *to = static_cast<float *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, positions.size()));
    std::vector<Single> singles;
    for (auto &x : positions) singles.push_back({float(x[0]), float(x[1]), float(x[2])});
    for (auto &x : singles) to = std::copy(x.begin(), x.end(), to);
    std::copy_n(faces.data()->data(), 3 * faces.size(), static_cast<std::uint32_t *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, faces.size())));
    rtcSetGeometryPointQueryFunction(geometry, visit);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(embree, geometry);
    rtcCommitScene(embree);

    const auto scene = p2m::Scene::make(positions, faces);
    const auto tree = p2m::Index::build(scene, "aabb"), octree = p2m::Index::build(scene, "octree");

    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    std::printf("%-8s %10s %10s %10s %10s %10s %10s  ns per query, medians of %zu\n", "set", "cgal", "embree", "aabb", "octree", "aabb batch", "octree b.", rounds);
    for (std::string set : {"10x", "1x", "near", "surface", "grid"}) {
        std::vector<Vec> queries(n);
        const int side = std::max(1, int(std::cbrt(double(n))));
        for (std::size_t i = 0; i < n; i++) {
            Vec part = {uniform(random), uniform(random), uniform(random)};
            if (set == "grid") part = {(i / side / side) / (side + 1.0), (i / side % side + 0.5) / side, (i % side + 0.5) / side};
            const double scale = set == "10x" ? 10 : 1.05;
            for (int k = 0; k < 3; k++) queries[i][k] = (low[k] + high[k]) / 2 + (part[k] - 0.5) * scale * (high[k] - low[k]);
            if (set == "near" || set == "surface") {
                const Face &f = faces[std::size_t(part[2] * faces.size())];
                Vec a = positions[f[0]], e = sub(positions[f[1]], a), g = sub(positions[f[2]], a);
                const double s = 1 - std::sqrt(part[0]), t = (1 - s) * part[1], offset = set == "near" ? normal(random) * 0.01 * diagonal : 0;
                Vec across = {e[1] * g[2] - e[2] * g[1], e[2] * g[0] - e[0] * g[2], e[0] * g[1] - e[1] * g[0]};
                const double length = std::max(std::sqrt(dot(across, across)), 1e-300);
                for (int k = 0; k < 3; k++) queries[i][k] = a[k] + s * e[k] + t * g[k] + offset * across[k] / length;
            }
        }
        std::vector<double> distances(n);
        std::vector<std::uint32_t> ids(n);
        double exact = 0;
        const auto single = [&](const p2m::Index &index) {
            double sum = 0;
            for (auto &q : queries) sum += index.closest_point(q).distance;
            return sum;
        };
        const auto batch = [&](const p2m::Index &index) {
            p2m_array given = {queries.data(), n, 0, P2M_SCALAR_F64};
            p2m_columns columns = {};
            columns.distance.data = distances.data();
            columns.primitive.data = ids.data();
            p2m_batch_options options = p2m_batch_options_default();
            options.threads = 1;
            if (p2m_closest_points(index.get(), &given, &options, &columns) != P2M_STATUS_OK) std::abort();
            double sum = 0;
            for (double distance : distances) sum += distance;
            return sum;
        };
        const std::vector<std::function<double()>> rivals = {
            [&] {
                double sum = 0;
                for (auto &q : queries) sum += std::sqrt(cgal.squared_distance({q[0], q[1], q[2]}));
                return sum;
            },
            [&] {
                double sum = 0;
                for (auto &q : queries) {
                    Search search = {&singles, &faces, {float(q[0]), float(q[1]), float(q[2])}, INFINITY};
                    RTCPointQuery query = {search.query[0], search.query[1], search.query[2], 0, INFINITY};
                    RTCPointQueryContext context;
                    rtcInitPointQueryContext(&context);
                    rtcPointQuery(embree, &query, &context, nullptr, &search);
                    sum += search.distance;
                }
                return sum;
            },
            [&] { return single(tree); }, [&] { return single(octree); }, [&] { return batch(tree); }, [&] { return batch(octree); },
        };
        std::vector<std::vector<double>> times(rivals.size());
        for (std::size_t round = 0; round < rounds; round++)
            for (std::size_t k = 0; k < rivals.size(); k++) {
                const double start = seconds(), sum = rivals[k]();
                times[k].push_back((seconds() - start) / n * 1e9);
                if (k == 0) exact = sum;
                if (std::abs(sum - exact) > 1e-4 * exact + 1e-6 * diagonal * n) std::printf("%s: the sums differ: %g, %g\n", set.c_str(), exact, sum);
            }
        std::printf("%-8s", set.c_str());
        for (auto &row : times) {
            std::sort(row.begin(), row.end());
            std::printf(" %10.0f", row[rounds / 2]);
        }
        std::printf("\n");
    }
}
