// Prints the distance of a point from a triangle.
#include <array>
#include <iostream>
#include <p2m.hpp>
#include <vector>

int main() {
    const std::vector<std::array<double, 3>> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
    const auto index = p2m::Index::build(p2m::Scene::make(positions, triangles));
    std::cout << index.closest_point({0.25, 0.25, 2}).distance << '\n'; // 2
}
