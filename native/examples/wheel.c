/* The stops of the mouse wheel after a click on a face: ./wheel MODEL.off FACE [SAVED]
 *
 * MODEL.off holds triangles. Prints a line for each stop, its node and how many faces it has; the one that a click alone
 * takes has a star. Writes the hierarchy to the file SAVED, the same bytes on every machine. */
#include <partwheel.h>

#include <stdio.h>
#include <stdlib.h>

static int refused(const char *what)
{
    fprintf(stderr, "%s: %s\n", what, pw_error_message());
    return EXIT_FAILURE;
}

/* A file's vertices and triangles, which the caller frees; 0 if it is no OFF file of triangles. */
static int read_off(const char *path, double **vertices, size_t *vertex_count, int32_t **triangles,
                    size_t *triangle_count)
{
    FILE *file = fopen(path, "r");
    size_t edges, i;
    int whole = file && fscanf(file, "OFF %zu %zu %zu", vertex_count, triangle_count, &edges) == 3 &&
                *vertex_count <= PW_MAX_COUNT && *triangle_count <= PW_MAX_COUNT &&
                (*vertices = malloc(3 * *vertex_count * sizeof **vertices)) != NULL &&
                (*triangles = malloc(3 * *triangle_count * sizeof **triangles)) != NULL;
    for (i = 0; whole && i < 3 * *vertex_count; i++)
        whole = fscanf(file, "%lf", *vertices + i) == 1;
    for (i = 0; whole && i < *triangle_count; i++) {
        int32_t *corner = *triangles + 3 * i;
        whole = fscanf(file, " 3 %d %d %d", corner, corner + 1, corner + 2) == 3;
    }
    if (file)
        fclose(file);
    return whole;
}

/* Whether the hierarchy was written to a file. */
static int save(const pw_hierarchy *hierarchy, const char *path)
{
    size_t size = 0;
    uint8_t *bytes = NULL;
    FILE *file = fopen(path, "wb");
    int whole = file && pw_hierarchy_save(NULL, hierarchy, NULL, 0, &size) == PW_OK && (bytes = malloc(size)) != NULL &&
                pw_hierarchy_save(NULL, hierarchy, bytes, size, &size) == PW_OK && fwrite(bytes, 1, size, file) == size;
    if (file && fclose(file))
        whole = 0;
    free(bytes);
    if (!whole)
        fprintf(stderr, "%s: can't be written. %s\n", path, pw_error_message());
    return whole;
}

int main(int count, char **arguments)
{
    double *vertices = NULL;
    int32_t *triangles = NULL, *stops = NULL;
    size_t vertex_count, triangle_count, stop_count, start, i;
    pw_mesh_view mesh = PW_MESH_VIEW_INIT;
    pw_hierarchy *hierarchy = NULL;
    int result = EXIT_FAILURE;

    if (count != 3 && count != 4) {
        fprintf(stderr, "usage: %s MODEL.off FACE [SAVED]\n", arguments[0]);
        return 2;
    }
    const size_t face = strtoul(arguments[2], NULL, 10);
    if (!read_off(arguments[1], &vertices, &vertex_count, &triangles, &triangle_count)) {
        fprintf(stderr, "%s: not an OFF file of triangles\n", arguments[1]);
        goto end;
    }
    mesh.vertices = vertices;
    mesh.vertex_count = vertex_count;
    mesh.triangles = triangles;
    mesh.triangle_count = triangle_count;
    if (pw_build(NULL, &mesh, NULL, &hierarchy))
        refused(arguments[1]);
    /* Asked twice: how many stops there are, then for them. */
    else if (pw_hierarchy_wheel(hierarchy, face, 0, NULL, 0, &stop_count, &start))
        refused(arguments[2]);
    else if ((stops = malloc(stop_count * sizeof *stops)) == NULL ||
             pw_hierarchy_wheel(hierarchy, face, 0, stops, stop_count, &stop_count, &start))
        refused(arguments[2]);
    else {
        for (i = 0; i < stop_count; i++) {
            const int32_t *faces;
            size_t face_count;
            if (pw_hierarchy_faces(hierarchy, (size_t)stops[i], &faces, &face_count))
                break;
            printf("node %d: %zu faces%s\n", stops[i], face_count, i == start ? " *" : "");
        }
        result = i == stop_count ? EXIT_SUCCESS : refused("a stop");
        if (count == 4 && !save(hierarchy, arguments[3]))
            result = EXIT_FAILURE;
    }
end:
    pw_hierarchy_free(hierarchy);
    free(stops);
    free(triangles);
    free(vertices);
    return result;
}
