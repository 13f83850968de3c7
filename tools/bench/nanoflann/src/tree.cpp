// A KD-tree of nanoflann over points in three dimensions, with a C interface for f32 and f64.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nanoflann.hpp>
#include <new>

namespace {

template <typename T> struct Points {
    const T *coordinates;
    std::size_t count;

    std::size_t kdtree_get_point_count() const { return count; }
    T kdtree_get_pt(std::size_t point, std::size_t axis) const { return coordinates[3 * point + axis]; }
    template <typename Box> bool kdtree_get_bbox(Box &) const { return false; }
};

template <typename T> struct Tree {
    using Metric = nanoflann::L2_Simple_Adaptor<T, Points<T>>;
    using Adaptor = nanoflann::KDTreeSingleIndexAdaptor<Metric, Points<T>, 3, std::uint32_t>;

    Points<T> points;
    Adaptor adaptor;

    Tree(const T *coordinates, std::size_t count) : points{coordinates, count}, adaptor(3, points) {
        adaptor.buildIndex();
    }
};

template <typename T> void *build(const T *coordinates, std::size_t count) noexcept {
    try {
        return new Tree<T>(coordinates, count);
    } catch (...) {
        return nullptr;
    }
}

template <typename T>
void nearest(const void *tree, const T *queries, std::size_t count, T *squares, std::uint32_t *numbers) noexcept {
    for (std::size_t i = 0; i < count; i++) {
        numbers[i] = UINT32_MAX;
        static_cast<const Tree<T> *>(tree)->adaptor.knnSearch(queries + 3 * i, 1, numbers + i, squares + i);
    }
}

} // namespace

extern "C" {
void *p2m_nanoflann_build_f64(const double *coordinates, std::size_t count) { return build(coordinates, count); }
void *p2m_nanoflann_build_f32(const float *coordinates, std::size_t count) { return build(coordinates, count); }
void p2m_nanoflann_nearest_f64(const void *tree, const double *queries, std::size_t count, double *squares,
                               std::uint32_t *numbers) {
    nearest(tree, queries, count, squares, numbers);
}
void p2m_nanoflann_nearest_f32(const void *tree, const float *queries, std::size_t count, float *squares,
                               std::uint32_t *numbers) {
    nearest(tree, queries, count, squares, numbers);
}
void p2m_nanoflann_free_f64(void *tree) { delete static_cast<Tree<double> *>(tree); }
void p2m_nanoflann_free_f32(void *tree) { delete static_cast<Tree<float> *>(tree); }
}
