// The kernels. A kernel is a function of a thread number and of parameters. On a card, each thread calls it once. On
// the host, for tests, a few threads share all numbers.
#include "answer.cuh"

#ifdef __CUDACC__
#define KERNEL(name, Parameters, function)                                                       \
    extern "C" __global__ void __launch_bounds__(128, 6) name(uint32_t threads, const __grid_constant__ Parameters parameters) { \
        uint32_t thread = blockIdx.x * blockDim.x + threadIdx.x;                                   \
        if (thread < threads) function(thread, parameters);                                        \
    }
#else
#include <thread>
#include <vector>
// Each of three threads takes every third number, in descending order, so that no kernel can rely on the order.
template <class Function> void run(uint32_t threads, Function function) {
    std::vector<std::thread> workers;
    for (uint32_t worker = 0; worker < 3; worker++)
        workers.emplace_back([=] {
            for (uint64_t k = worker; k < threads; k += 3) function(threads - 1 - (uint32_t)k);
        });
    for (std::thread &worker : workers) worker.join();
}
#define KERNEL(name, Parameters, function)                                              \
    extern "C" void name(uint32_t threads, const Parameters *parameters) {                \
        run(threads, [=](uint32_t thread) { function(thread, *parameters); });            \
    }
#endif

KERNEL(p2m_make_list, Building, make_list)
KERNEL(p2m_answer_by_list_f32, Batch, answer_by_list<float>)
KERNEL(p2m_answer_by_list_f64, Batch, answer_by_list<double>)
KERNEL(p2m_answer_by_tree_f32, Batch, answer_by_tree<float>)
KERNEL(p2m_answer_by_tree_f64, Batch, answer_by_tree<double>)
KERNEL(p2m_count_key_f32, Batch, count_key<float>)
KERNEL(p2m_count_key_f64, Batch, count_key<double>)
KERNEL(p2m_place_keys, Batch, place_keys)
KERNEL(p2m_scatter, Batch, scatter)
KERNEL(p2m_gather_f32, Batch, gather<float>)
KERNEL(p2m_gather_f64, Batch, gather<double>)
KERNEL(p2m_put_f32, Batch, put<float>)
KERNEL(p2m_put_f64, Batch, put<double>)

#ifndef __CUDACC__
// The f64 kernel alone, for tests. `numbers` has nine coordinates, of which those of `count` vertices are used.
extern "C" int p2m_nearest(const double *query, const double *numbers, int count, double prune, double *out) {
    V3 q = {query[0], query[1], query[2]}, v[3];
    for (int i = 0; i < count; i++) v[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    Nearest best;
    Outcome outcome = count == 1   ? nearest_of_point(q, v[0], prune, best)
                      : count == 2 ? nearest_of_segment(q, v[0], v[1], prune, best)
                                   : nearest_of_triangle(q, v, prune, best);
    if (outcome != FOUND) return outcome;
    V3 point = point_of(best, q, v, count);
    double all[9] = {best.square, point.x, point.y, point.z, best.weight[0], best.weight[1], best.weight[2],
                     (double)best.feature, best.size};
    for (int i = 0; i < 9; i++) out[i] = all[i];
    return outcome;
}
// `take_of`, for tests of its overflow.
extern "C" bool p2m_take_of(uint64_t *counter, uint32_t amount, uint32_t capacity) {
    uint32_t first;
    return take_of(counter, amount, capacity, first);
}
// The computed square of a plate, for tests of its error bound.
extern "C" float p2m_plate_square(const Plate *plate, const float *p) { return square_of(*plate, F3{p[0], p[1], p[2]}); }
#endif
