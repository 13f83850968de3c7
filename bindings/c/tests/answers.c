// Writes the columns of the answers to queries from a file, as raw bytes: answers SCENE BACKEND QUERIES ANSWERS
#include "p2m.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(p2m_status status) {
    if (status != P2M_STATUS_OK) {
        fprintf(stderr, "%s\n", p2m_last_error());
        exit(1);
    }
}

int main(int arguments, char **argument) {
    FILE *in = arguments == 5 ? fopen(argument[3], "rb") : NULL, *out = in ? fopen(argument[4], "wb") : NULL;
    if (!out || fseek(in, 0, SEEK_END)) return 2;
    const size_t size = (size_t)ftell(in), count = size / sizeof(double[3]);
    double *queries = malloc(size);
    rewind(in);
    if (!queries || fread(queries, 1, size, in) != size) return 2;

    const p2m_index_options options = {argument[2], 0, 0, 0, 0};
    p2m_scene *scene;
    p2m_index *index;
    check(p2m_scene_read(argument[1], &scene));
    check(p2m_index_build(scene, &options, &index));

    // The columns are stored one after the other, in the order of p2m_columns.
    const size_t widths[7] = {8, 4, 24, 1, 24, 8, 24};
    p2m_column columns[7];
    for (int i = 0; i < 7; i++) columns[i] = (p2m_column){malloc(count * widths[i]), 0};
    p2m_columns all = {columns[0], columns[1], columns[2], columns[3], columns[4], columns[5], columns[6]};
    check(p2m_closest_points(index, &(p2m_array){queries, count, 0, P2M_SCALAR_F64}, NULL, &all));
    // The lower bounds of a batch depend on the course of the search, so the bounds of single queries are written.
    for (size_t i = 0; i < count; i++) {
        p2m_closest answer;
        check(p2m_closest_point(index, queries + 3 * i, INFINITY, &answer));
        ((double *)columns[5].data)[i] = answer.lower_bound;
    }
    for (int i = 0; i < 7; i++) {
        if (fwrite(columns[i].data, widths[i], count, out) != count) return 2;
        free(columns[i].data);
    }
    p2m_index_free(index);
    p2m_scene_free(scene);
    free(queries);
    return fclose(out) || fclose(in);
}
