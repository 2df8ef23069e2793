/* The C API for convex parts: few convex hulls that cover a solid and little else, as physics engines take them. The
 * habits are those of partwheel.h.
 *
 * Experimental: a function here may get other parameters, or go, whenever the minor version grows, also after 1.0.
 */
#ifndef PARTWHEEL_CONVEX_H
#define PARTWHEEL_CONVEX_H

#include "partwheel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* How many hulls, and of what kind. At least one of hulls and error is given. */
typedef struct pw_convex_options {
    size_t struct_size; /* sizeof(pw_convex_options) */
    /* So many hulls, 1 to 4096; fewer where more would be no better. 0: as many as the error needs. */
    size_t hulls;
    /* The largest distance that any point of a hull's surface may have from the solid, in the caller's unit; points in the
     * solid have none. 0: any. With hulls as well, there are at most so many, and the error is kept where it can be:
     * pw_convex_parts_hull() says which. */
    double error;
    /* At most so many vertices a hull: 8 or more, or 0 for any number. */
    size_t max_vertices;
    /* Of a hull that has more vertices than that: 0, one around it (all of its part is inside, to rounding), whose planes
     * are some of its own and of a box's; 1, the hull of some of its own vertices, which leaves out little. */
    int32_t approximate;
    int32_t reserved; /* 0 */
} pw_convex_options;

typedef struct pw_convex_parts pw_convex_parts;

/* Hulls that together contain the solid of a hierarchy, with little volume besides.
 *
 * They start as the hulls of pw_hierarchy_cut_least_concavity(): the paper's parts, so PW_MODE_PAPER is the mode that suits
 * best. These are divided by planes, where the volume falls most, into about twice as many; joined again where it grows
 * least; two neighbours together are divided anew by the plane that is best for both; and at last one part is divided
 * and two others are joined while that gains. Planes go through tetrahedra, so parts are no longer slices of
 * pw_arrays.tetrahedra. Each step takes the least sum of volumes: the result is a good one, not the best.
 *
 * Planes are tried in 16 directions or fewer: those of the axes, and the part's own. So the result depends a little on how
 * the model is turned, but not on its unit or place, threads, or the order of what was given.
 *
 * parts  receives the hulls, to be freed with pw_convex_parts_free. They keep nothing of the hierarchy.
 *
 * PW_ERROR_ARGUMENT: options that are none. It takes some 0.1 to 1 s for 20,000 faces. */
PW_API pw_status pw_hierarchy_convex_parts(const pw_hierarchy *hierarchy, const pw_convex_options *options,
                                           pw_convex_parts **parts);
PW_API void pw_convex_parts_free(pw_convex_parts *parts);

PW_API pw_status pw_convex_parts_count(const pw_convex_parts *parts, size_t *count);

/* One of them, 0 to count - 1, the largest first.
 *
 * vertices   vertex_count x 3; owned by parts, as are the triangles.
 * triangles  triangle_count x 3 indices into them: closed, convex, outward. Vertices are the extreme points, to rounding.
 * volume     of the part of the solid that this hull is for. These add up to the solid's.
 * error      the largest distance of its surface from the solid, at most: within 2 % of the solid's longest side, or of
 *            options.error if that is less; a negative number if no error was asked for. */
PW_API pw_status pw_convex_parts_hull(const pw_convex_parts *parts, size_t index, const double **vertices,
                                      size_t *vertex_count, const int32_t **triangles, size_t *triangle_count,
                                      double *volume, double *error);

#ifdef __cplusplus
}
#endif

#endif
