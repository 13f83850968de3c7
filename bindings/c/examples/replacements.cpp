// Replacements of the calls of other libraries by calls of p2m. Comments have the replaced calls.
#include "p2m.hpp"

#include <iostream>

using Vector = std::array<double, 3>;
using Positions = std::vector<Vector>;
using Faces = std::vector<std::array<int, 3>>;

// CGAL's AABB_tree: its constructor, closest_point, squared_distance, and number_of_intersected_primitives
static void cgal(const Positions& v, const Faces& f) {
    const auto tree = p2m::Index::build(p2m::Scene::make(v, f));
    const Vector query{2, 2, 2};
    const auto nearest = tree.closest_point(query);
    std::cout << nearest.point[0] << ' ' << nearest.distance * nearest.distance << '\n';
    int hits = 0;
    tree.visit_hits(p2m::ray(query, {-1, -1, -1}), [&](const p2m::Hit&) { ++hits; });
    std::cout << hits << '\n';
}

// libigl, with P, V and F as matrices or as vectors
static void libigl(const Positions& P, const Positions& V, const Faces& F) {
    const auto index = p2m::Index::build(p2m::Scene::make(V, F)); // igl::AABB<MatrixXd, 3> tree; tree.init(V, F);
    // igl::point_mesh_squared_distance(P, V, F, sqrD, I, C);
    const auto answers = index.closest_points(P);
    std::cout << answers.distance[0] << ' ' << answers.primitive[0] << ' ' << answers.point[0][0] << '\n';
    // igl::signed_distance(P, V, F, igl::SIGNED_DISTANCE_TYPE_DEFAULT, S, I, C, N);
    const auto S = index.signed_distances(P);
    std::cout << S[0] << '\n';
}

// FCL: the clearance of a moving robot link from its surroundings
static void fcl(const p2m::Index& surroundings, const p2m::Index& link) {
    // CollisionObjectd o2(link, pose);
    const double pose[4][4] = {{1, 0, 0, 3}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    std::cout << surroundings.closest_pair(link, pose).distance << '\n'; // fcl::distance(&o1, &o2, request, result);
}

// FCPW, scene.findClosestPoint and scene.contains
static void fcpw(const p2m::Index& scene) {
    const auto interaction = scene.closest_point({0.1, 0.1, 0.1}, 5.0); // scene.findClosestPoint(x, interaction, 25.0);
    if (p2m::has_answer(interaction)) std::cout << interaction.primitive << '\n';
    std::cout << int(scene.contains(Positions{{0.1, 0.1, 0.1}})[0]) << '\n'; // scene.contains(x)
}

// Embree: rtcPointQuery. Its callback, which computes the distance of each triangle, is not needed here
static void embree(const p2m::Index& scene) {
    // rtcPointQuery(scene, &query, &context, callback, &result);
    const auto result = scene.closest_point({0.1, 0.1, 0.1}, 1.0);
    std::cout << result.distance << '\n';
}

int main() {
    const Positions positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Faces faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const auto index = p2m::Index::build(p2m::Scene::make(positions, faces));
    cgal(positions, faces);
    libigl({{0.1, 0.2, 0.25}}, positions, faces);
    fcl(index, index);
    fcpw(index);
    embree(index);
}
