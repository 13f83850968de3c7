// p2m: closest points of scenes of triangles, segments and points.
//
// Every function that can fail returns a p2m_status. After a failure p2m_last_error() returns its message; each thread
// has its own. Objects are made by functions that write a pointer to them, and freed by the function that ends in
// _free. Scenes and indexes never change, so any number of threads may use one at the same time. Pointers are checked
// for null and alignment. The caller has to ensure that they point to as much memory as counts and strides say.
// Lengths are in units of the scene. Nothing is kept of the memory of the caller after a call. Outputs must overlap
// neither each other nor inputs. No function throws.


#ifndef P2M_H
#define P2M_H

// Made by cbindgen from bindings/c/src (cargo xtask c --build). Edit the comments there.

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// The id that stands for no primitive.
#define P2M_NO_PRIMITIVE UINT32_MAX

// The status of a call. After any other status than `P2M_STATUS_OK`, the outputs of the call are unspecified, and
// `p2m_last_error` returns the reason.
typedef enum p2m_status {
  // The call succeeded.
  P2M_STATUS_OK = 0,
  // An argument is null, misaligned, out of range or not finite.
  P2M_STATUS_INVALID_ARGUMENT = 1,
  // The scene cannot be indexed.
  P2M_STATUS_INVALID_SCENE = 2,
  // The index does not answer this kind of query.
  P2M_STATUS_UNSUPPORTED = 3,
  // A file could not be read or written.
  P2M_STATUS_FILE = 4,
  // There is not enough memory for threads, or for the k nearest.
  P2M_STATUS_OUT_OF_MEMORY = 5,
  // The call was cancelled.
  P2M_STATUS_CANCELLED = 6,
  // There is a bug in p2m. Please report the message.
  P2M_STATUS_INTERNAL = 7,
} p2m_status;

// The type of the numbers of an array.
typedef enum p2m_scalar {
  // `float`, for coordinates.
  P2M_SCALAR_F32 = 0,
  // `double`, for coordinates.
  P2M_SCALAR_F64 = 1,
  // `uint32_t`, for indices.
  P2M_SCALAR_U32 = 2,
  // `uint64_t`, for indices.
  P2M_SCALAR_U64 = 3,
} p2m_scalar;

// A switch with which another thread, or a signal handler, cancels a call.
typedef struct p2m_cancel p2m_cancel;

// An index over a scene, which it keeps alive. It never changes, and any number of threads may query it.
typedef struct p2m_index p2m_index;

// A scene: triangles, segments and points that share vertices. It is immutable, and any number of threads may use it.
typedef struct p2m_scene p2m_scene;

// The options of a build. All zeros are the defaults.
typedef struct p2m_index_options {
  // The name of a backend: "aabb", "kdop", "octree", "p2m", "brute" or "auto"; null stands for "auto".
  const char *backend;
  // The expected number of queries, by which "auto" chooses. With 0 it chooses "aabb".
  uint64_t queries;
  // The fineness of the cells of an octree: a larger number makes finer cells. 0 stands for the default.
  double resolution;
  // The number of faces of a k-DOP: 6, 14, 18 or 26; 0 stands for 14.
  uint32_t kdop_faces;
  // The number of threads; 0 stands for all processors.
  uint32_t threads;
} p2m_index_options;

// The nearest points of two scenes.
typedef struct p2m_pair {
  // The distance. It is 0 if the scenes intersect, and infinity if there is no answer.
  double distance;
  // A lower bound on the true distance; infinity if there is no answer.
  double lower_bound;
  // The nearest point of each scene. The point of the second scene is given after its motion.
  double points[2][3];
  // The weights of the vertices of each primitive.
  double weights[2][3];
  // The id of the primitive of each scene, or `P2M_NO_PRIMITIVE`.
  uint32_t primitives[2];
  // The feature that each point lies on, as in `p2m_closest`.
  uint8_t features[2];
  // Whether the scenes intersect. It is exact.
  bool is_intersecting;
} p2m_pair;

// The options of a batch. `p2m_batch_options_default` returns the defaults.
typedef struct p2m_batch_options {
  // The largest distance of an answer, in units of the scene. It may be infinite.
  double max_distance;
  // The number of threads; 0 stands for all processors, and 1 for the calling thread.
  uint32_t threads;
  // 1 to answer queries in their order, because neighbours in it are near each other already, and 0 to reorder them.
  uint8_t keeps_order;
  // A switch that cancels the call, or null.
  const struct p2m_cancel *cancel;
} p2m_batch_options;

// The closest point of a scene.
typedef struct p2m_closest {
  // The distance, in units of the scene; infinity if there is no answer.
  double distance;
  // The closest point.
  double point[3];
  // The weights of the vertices of the primitive. The point is the weighted sum of the vertices.
  double weights[3];
  // A lower bound on the true distance. If there is no answer, it is infinity, or about the largest distance in a
  // batch.
  double lower_bound;
  // The id of the primitive, the lowest of equally near ones; `P2M_NO_PRIMITIVE` if there is no answer.
  uint32_t primitive;
  // The feature that the point lies on: 0 to 2 for a vertex, 3 to 5 for the edge from vertex 0, 1 or 2 to the next
  // one, 6 for the face, and 255 if there is no answer.
  uint8_t feature;
} p2m_closest;

// An array that the library reads during a call: `count` rows of one to three numbers, depending on the function.
typedef struct p2m_array {
  // The first number of the first row. It may be null if `count` is 0.
  const void *data;
  // The number of rows.
  size_t count;
  // The number of bytes from one row to the next, a multiple of the size of a number; 0 if there are no gaps between
  // rows.
  size_t stride;
  // The type of the numbers, a value of `p2m_scalar`.
  uint32_t scalar;
} p2m_array;

// An array that the library fills with answers during a call, with a row for each query.
typedef struct p2m_column {
  // The first row, or null if these answers are not needed.
  void *data;
  // The number of bytes from one row to the next; 0 if there are no gaps between rows.
  size_t stride;
} p2m_column;

// The columns of the answers of a batch. Each has a row for each query; a column whose `data` is null is not computed.
// All fields are as in `p2m_closest`.
typedef struct p2m_columns {
  // `double`.
  struct p2m_column distance;
  // `uint32_t`.
  struct p2m_column primitive;
  // `double[3]`.
  struct p2m_column point;
  // `uint8_t`.
  struct p2m_column feature;
  // `double[3]`.
  struct p2m_column weights;
  // `double`.
  struct p2m_column lower_bound;
  // `double[3]`: the normal of the surface at the closest point, of length 1. On edges and at vertices it is the
  // mean of the normals of the adjacent faces, weighted by their angles. It is NaN if there is none.
  struct p2m_column normal;
} p2m_columns;

// A function that receives an answer, and the `user` pointer of the call. Any result but 0 ends the search.
typedef int (*p2m_visit_closest)(const struct p2m_closest *answer, void *user);

// A ray: the points `origin + t * direction` with `t_min <= t <= t_max`.
typedef struct p2m_ray {
  // The point with the parameter 0.
  double origin[3];
  // The direction, of any length but 0. Parameters are in units of this length.
  double direction[3];
  // The smallest parameter.
  double t_min;
  // The largest parameter, which may be infinite.
  double t_max;
  // The distance within which segments and points count as hit. Triangles are hit exactly.
  double radius;
} p2m_ray;

// A hit of a ray.
typedef struct p2m_hit {
  // The parameter, with a single rounding; infinity if there is no hit.
  double t;
  // The point on the primitive that is hit.
  double point[3];
  // The weights of the vertices of the primitive.
  double weights[3];
  // The id of the primitive, or `P2M_NO_PRIMITIVE`.
  uint32_t primitive;
  // The side from which a triangle is hit: 1 from the front, -1 from the back, and 0 along it or without a hit.
  int8_t side;
} p2m_hit;

// A function that receives a hit, and the `user` pointer of the call. Any result but 0 ends the search.
typedef int (*p2m_visit_hit)(const struct p2m_hit *hit, void *user);

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Reads a scene from a file: OBJ, PLY, STL, OFF, a point cloud, or a saved index. The path is UTF-8. Free the scene
// with `p2m_scene_free`.
enum p2m_status p2m_scene_read(const char *path,
                               struct p2m_scene **scene);

// Saves an index with its scene to a file. The file appears under its name when it is complete.
enum p2m_status p2m_index_save(const struct p2m_index *index, const char *path);

// Loads an index with its scene from a file that any p2m program or binding has saved. Free it with `p2m_index_free`.
enum p2m_status p2m_index_load(const char *path,
                               struct p2m_index **index);

// Builds an index over a scene. `options` may be null. Free the index with `p2m_index_free`.
enum p2m_status p2m_index_build(const struct p2m_scene *scene,
                                const struct p2m_index_options *options,
                                struct p2m_index **index);

// Makes an index over another scene with as many primitives in the same order, by a refit: the tree keeps its shape,
// and its boxes are recomputed. The backend has to support it. The old index stays valid. Free the new one with
// `p2m_index_free`.
enum p2m_status p2m_index_refit(const struct p2m_index *index,
                                const struct p2m_scene *scene,
                                struct p2m_index **refitted);

// Frees an index. No other call may be using it. Null is ignored.
void p2m_index_free(struct p2m_index *index);

// Returns the name of the backend, which is valid as long as the index; null for a null pointer.
const char *p2m_index_backend(const struct p2m_index *index);

// Returns the number of primitives; 0 for a null pointer.
size_t p2m_index_primitive_count(const struct p2m_index *index);

// Returns the memory of the index in bytes, without its scene; 0 for a null pointer.
size_t p2m_index_memory_bytes(const struct p2m_index *index);

// Finds the nearest points of two scenes within a distance, which may be infinite. `motion` moves the second scene:
// the 16 numbers of a 4 x 4 matrix, row by row, of a rotation and a translation; null for none. If there is no answer,
// `pair` has `P2M_NO_PRIMITIVE`.
enum p2m_status p2m_closest_pair(const struct p2m_index *first,
                                 const struct p2m_index *second,
                                 const double *motion,
                                 double max_distance,
                                 struct p2m_pair *pair);

// Returns the default options of a batch: no largest distance, all processors, any order, no switch.
struct p2m_batch_options p2m_batch_options_default(void);

// Finds the closest point of the scene to `query`, which has three finite coordinates, within a distance, which may be
// infinite. If there is none, `answer` has `P2M_NO_PRIMITIVE`.
enum p2m_status p2m_closest_point(const struct p2m_index *index,
                                  const double *query,
                                  double max_distance,
                                  struct p2m_closest *answer);

// Finds the closest points of many queries, and writes the columns. Queries are rows of three finite coordinates,
// `float` or `double`. `options` may be null. The answers are the same bits as those of single queries, for any number
// of threads; only lower bounds may differ in their last digits.
enum p2m_status p2m_closest_points(const struct p2m_index *index,
                                   const struct p2m_array *queries,
                                   const struct p2m_batch_options *options,
                                   const struct p2m_columns *columns);

// Finds the `k` primitives nearest to a point within a distance, the nearest first. Writes them to `answers`, which
// has room for `k`, and their number to `count`.
enum p2m_status p2m_k_nearest(const struct p2m_index *index,
                              const double *query,
                              size_t k,
                              double max_distance,
                              struct p2m_closest *answers,
                              size_t *count);

// Calls a function for each primitive within a radius of a point, in any order, until it returns anything but 0. The
// function must not throw or jump out.
enum p2m_status p2m_visit_within(const struct p2m_index *index,
                                 const double *query,
                                 double radius,
                                 p2m_visit_closest visit,
                                 void *user);

// Writes whether any primitive is within a radius of a point.
enum p2m_status p2m_is_any_within(const struct p2m_index *index,
                                  const double *query,
                                  double radius,
                                  bool *is_within);

// Finds the first hit of a ray, the one with the smallest parameter, and of equal ones the one with the lowest id.
enum p2m_status p2m_first_hit(const struct p2m_index *index,
                              const struct p2m_ray *ray,
                              struct p2m_hit *hit);

// Writes whether a ray hits anything.
enum p2m_status p2m_any_hit(const struct p2m_index *index, const struct p2m_ray *ray, bool *is_hit);

// Calls a function for all hits of a ray, one for each primitive that is hit, the nearest first. The function must not
// throw or jump out.
enum p2m_status p2m_visit_hits(const struct p2m_index *index,
                               const struct p2m_ray *ray,
                               p2m_visit_hit visit,
                               void *user);

// Finds the first hits of many rays. `hits` has room for `count`. `options` may be null, and its largest distance is
// ignored.
enum p2m_status p2m_first_hits(const struct p2m_index *index,
                               const struct p2m_ray *rays,
                               size_t count,
                               const struct p2m_batch_options *options,
                               struct p2m_hit *hits);

// Makes a scene from arrays, which are copied. `positions` are the vertices, of type float or double. `triangles` have
// three indices of vertices each, `segments` two, and `points` one. Each of the last three may be null.
//
// Primitives are numbered from 0: first all triangles, then all segments, then all points. Free the scene with
// `p2m_scene_free`. Fails with `P2M_STATUS_INVALID_SCENE` if an index is out of range, if a coordinate of a primitive
// is not finite, or if there are more than 2^30 primitives.
enum p2m_status p2m_scene_new(const struct p2m_array *positions,
                              const struct p2m_array *triangles,
                              const struct p2m_array *segments,
                              const struct p2m_array *points,
                              struct p2m_scene **scene);

// Frees a scene. Indexes over it stay valid. Null is ignored.
void p2m_scene_free(struct p2m_scene *scene);

// Writes the numbers of triangles, segments and points.
enum p2m_status p2m_scene_counts(const struct p2m_scene *scene, size_t (*counts)[3]);

// Writes the lowest and the highest coordinates of all primitives. Fails for a scene without primitives.
enum p2m_status p2m_scene_bounds(const struct p2m_scene *scene, double (*low)[3], double (*high)[3]);

// Writes the signed distance of each query, of type `double`: negative inside of the surface that the triangles form,
// and positive outside. It is NaN if nothing is within the largest distance, and if the sign is not determined. In a
// scene without triangles and without a largest distance it is infinity. The first call for an index prepares the
// signs. Fails with `P2M_STATUS_UNSUPPORTED` for a scene with segments or points.
enum p2m_status p2m_signed_distances(const struct p2m_index *index,
                                     const struct p2m_array *queries,
                                     const struct p2m_batch_options *options,
                                     struct p2m_column distances);

// Writes whether each query is inside of the surface that the triangles form, as 1 or 0 of type `uint8_t`. The largest
// distance of the options is ignored.
enum p2m_status p2m_contains(const struct p2m_index *index,
                             const struct p2m_array *queries,
                             const struct p2m_batch_options *options,
                             struct p2m_column is_inside);

// Returns the message of the last failure on this thread, or the empty string if there was none. The string is valid
// until the next failure on this thread.
const char *p2m_last_error(void);

// Returns the version of the library as a static string, such as "0.1.0".
const char *p2m_version(void);

// Makes a switch that is not set. Free it with `p2m_cancel_free`.
struct p2m_cancel *p2m_cancel_new(void);

// Sets a switch. Calls with this switch end with `P2M_STATUS_CANCELLED`, within milliseconds once they search. Any
// thread and any signal handler may call this function. Null is ignored.
void p2m_cancel_set(const struct p2m_cancel *cancel);

// Frees a switch. No other call may be using it. Null is ignored.
void p2m_cancel_free(struct p2m_cancel *cancel);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* P2M_H */
