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

/* How many hulls, and of what kind. Either hulls or error is more than 0, and the other is 0. */
typedef struct pw_convex_options {
    size_t struct_size; /* sizeof(pw_convex_options) */
    /* So many hulls, 1 to 4096; fewer where more would gain nothing. */
    size_t hulls;
    /* As few hulls as are found of which no point of the surface is farther than this from the solid, in the caller's unit;
     * points in the solid have no distance. At most 4096: where more were needed, the errors that are told say so. */
    double error;
    /* At most so many vertices a hull, 8 or more; 0: any number. Of a hull that has more, a convex polytope around it is
     * taken: it contains all that the hull did, and a little more. */
    size_t max_vertices;
} pw_convex_options;

typedef struct pw_convex_parts pw_convex_parts;

/* Convex hulls that together contain the solid of a hierarchy, with little volume besides.
 *
 * The solid is divided by planes, where the sum of the hulls' volumes falls most, into more pieces than are wanted; these
 * are joined again where it grows least; two neighbours together are divided anew by the plane that is best for both; and
 * at last one is divided and two others are joined while that gains. So parts are none of the hierarchy's, whose mode
 * doesn't matter. Each step takes the least sum: the result is a good one, not the best. The search works on a coarse copy of
 * the solid, the hulls are those of the solid itself. Directions of planes are those of a lattice and the pieces' own, so the
 * result depends a little on how the model is turned, but not on its unit, threads, or the order of what was given.
 *
 * context  may be null; else pw_context_progress() tells the fraction, the stage means nothing, and pw_context_cancel()
 *          ends the call. One call at a time may have it.
 * parts    receives the hulls, to be freed with pw_convex_parts_free. They keep nothing of the hierarchy.
 *
 * PW_ERROR_ARGUMENT: options that are none; PW_ERROR_CANCELLED. It takes some 0.1 to 1 s. */
PW_API pw_status pw_hierarchy_convex_parts(pw_context *context, const pw_hierarchy *hierarchy,
                                           const pw_convex_options *options, pw_convex_parts **parts);
PW_API void pw_convex_parts_free(pw_convex_parts *parts);

PW_API pw_status pw_convex_parts_count(const pw_convex_parts *parts, size_t *count);

/* One of them, 0 to count - 1, the largest first.
 *
 * vertices   vertex_count x 3; owned by parts, as are the triangles.
 * triangles  triangle_count x 3 indices into them: closed, convex, outward. Vertices are the extreme points, to rounding.
 * volume     of the part of the solid that this hull is for. These add up to the solid's.
 * error      the largest distance of its surface from the solid, or up to 1/100 of the error asked for too much; a negative
 *            number if none was. */
PW_API pw_status pw_convex_parts_hull(const pw_convex_parts *parts, size_t index, const double **vertices,
                                      size_t *vertex_count, const int32_t **triangles, size_t *triangle_count,
                                      double *volume, double *error);

#ifdef __cplusplus
}
#endif

#endif
