/* The C API for editing a mesh by its parts: borders in creases, deforming, fairing, checks of polygons, what is under the
 * mouse; convex parts; and the hierarchy as an index. The habits are those of partwheel.h.
 *
 * Triangles are neighbors where they share indices. Weld coincident vertices first, as the Python package does
 * (partwheel.weld), or a surface that is split at UV or normal seams falls apart there.
 *
 * Experimental: a function here may get other parameters, or go, whenever the minor version grows, also after 1.0. The
 * library's soname has the minor version only until 1.0, and says nothing about these functions afterwards. So they have a
 * version of their own. A program that is not built together with the library compares it once, before it calls any:
 *
 *     if (pw_edit_api_version() != PW_EDIT_API_VERSION) ... another library than this program is for
 */
#ifndef PARTWHEEL_EDIT_H
#define PARTWHEEL_EDIT_H

#include "partwheel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Grows whenever a function of this header changes or goes. */
#define PW_EDIT_API_VERSION 1

/* PW_EDIT_API_VERSION of the library that is there. */
PW_API int32_t pw_edit_api_version(void);

/* ---- Borders -------------------------------------------------------------------------------------------------- */

/* A part of a surface with its border moved to the creases nearby, where people would end the part: a minimum cut in a
 * band around the border (Katz, Tal, "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts", 2003). The border
 * goes along edges between faces. Each costs its length, times a weight after Golovinskiy, Funkhouser, "Randomized Cuts
 * for 3D Mesh Analysis" (2008), which is 1 where the surface is flat, falls a little towards sharp convex edges and
 * steeply towards concave ones; and up to half more the farther it is from the border as given. The sum is least, so
 * length times weight never adds up to more than before.
 *
 * The band reaches to both sides, by a fifth of the square root of the area of the part or of the rest, whichever is
 * less; less far where it would have more than 12,000 faces; and never over all of a connected piece. So nothing
 * vanishes, nothing falls into more pieces, and a face stays whole. The result depends neither on the order of vertices,
 * triangles and faces nor on the unit, but for what rounding does to costs and distances that are equal.
 *
 * What all parts of a surface need is made once, by pw_creases_create; the caller frees it with pw_creases_free. It
 * never changes: any number of threads may ask it.
 *
 * mesh    is copied. Any surface: open, non-manifold, with triangles of no area; a closed one that winds the other way is
 *         taken as it was meant. A face without triangles stays where it is.
 * creases receives the new surface.
 *
 * PW_ERROR_EMPTY: no faces. PW_ERROR_INDEX, PW_ERROR_NOT_FINITE, PW_ERROR_ARGUMENT: as in pw_build. */
typedef struct pw_creases pw_creases;

PW_API pw_status pw_creases_create(pw_context *context, const pw_mesh_view *mesh, pw_creases **creases);
PW_API void pw_creases_free(pw_creases *creases);

/* A part with its border moved. Making the surface takes some 35 ms for 100,000 faces, a part 15.
 *
 * inside  face_count bytes, as many as the surface has faces: not 0 for those of the part.
 * result  receives face_count bytes: 1 for the faces of the part with its new border, else 0. It may be inside itself.
 *
 * PW_ERROR_EMPTY: no face is in the part. PW_ERROR_ARGUMENT: another face_count. */
PW_API pw_status pw_creases_snap(const pw_creases *creases, const uint8_t *inside, size_t face_count, uint8_t *result);

/* ---- Parts made by hand --------------------------------------------------------------------------------------- */

/* A hierarchy in which some source faces are a node with score 1, so that the wheel stops there. The caller frees it with
 * pw_hierarchy_free.
 *
 * The smallest cluster around the faces becomes the union of two: the part, and the rest. Clusters in between that have faces of
 * both are divided, and their pieces score less, by their share of the area. All others stay as they are: their tetrahedra, faces,
 * scores and concavities, and so the stops of the wheel that lie within the part, within the rest, or around both. Faces that
 * share a tetrahedron go together, with most of their area.
 *
 * faces   face_count indices of source faces, in any order.
 * result  receives the new hierarchy; of a part that is a node already, the same but for its score.
 *
 * PW_ERROR_EMPTY: no tetrahedron has most of its area in the part. PW_ERROR_ARGUMENT: there is no such face; the hierarchy is of
 * PW_MODE_PAPER; or the part is made of a piece of one shell and something of another. Whole shells can be one part. */
PW_API pw_status pw_hierarchy_with_part(pw_context *context, const pw_hierarchy *hierarchy, const int32_t *faces,
                                        size_t face_count, pw_hierarchy **result);

/* ---- Seams ---------------------------------------------------------------------------------------------------- */

/* Seams for unwrapping: along the borders of parts, snapped to creases unless they are to be kept. Cut open there, the surface becomes patches that
 * are disks. More cuts, preferably in creases, divide patches until the conformal map of none overlaps itself or exceeds
 * the area distortion, as far as cuts can help. Work that might grow with the square of a part is bounded. docs/seams.md
 * has the method. The same call gives the same bits on every machine.
 *
 * mesh            the surface of the hierarchy: as many faces. Coincident vertices are not welded.
 * labels          face_count numbers from 0 to face_count - 1: the part of each face.
 * keep_borders    0: the borders of the labels are snapped to creases nearby. 1: they stay, for labels that somebody chose.
 * max_distortion  mean factor by which areas of a patch may differ, more than 1; 1.09 is usual.
 * is_seam         receives 3 * triangle_count bytes: 1 if the side of triangle t from corner k to the next one, at 3 t + k,
 *                 is on a seam, else 0. Both sides of an edge are the same. An edge with one triangle is no seam, one with
 *                 more than two always is.
 *
 * PW_ERROR_ARGUMENT: another face_count, label, or max_distortion. Other errors: as in pw_creases_create. */
PW_API pw_status pw_hierarchy_seams(pw_context *context, const pw_hierarchy *hierarchy, const pw_mesh_view *mesh,
                                    const int32_t *labels, int32_t keep_borders, double max_distortion, uint8_t *is_seam);

/* Divides the islands of an unwrapping whose area distortion is far above the prediction, because the solver failed, once,
 * along the tree.
 *
 * mesh, max_distortion  as above.
 * uvs                   of the corners of each triangle, 6 * triangle_count numbers, unwrapped along the seams.
 * is_seam               the seams, as above; receives the refined ones; the same if no island failed or none can be
 *                       divided. After an error it is unchanged. */
PW_API pw_status pw_hierarchy_refine_seams(pw_context *context, const pw_hierarchy *hierarchy, const pw_mesh_view *mesh,
                                           const double *uvs, double max_distortion, uint8_t *is_seam);

/* ---- Deformation ---------------------------------------------------------------------------------------------- */

/* What a vertex does in a deformation, if it does not follow a handle (0, 1, 2 ...). */
#define PW_VERTEX_FREE (-1)  /* goes where the deformation takes it */
#define PW_VERTEX_FIXED (-2) /* stays */

/* A surface whose free vertices follow handles as rigidly as possible: Sorkine, Alexa, "As-Rigid-As-Possible Surface
 * Modeling" (2007), which the paper uses in its section 4.1, with the energy called "spokes and rims" (Chao, Pinkall,
 * Sanan, Schroeder, "A Simple Geometric Model for Elastic Deformations", 2010):
 *
 *   E = sum over vertices i, triangles t at i, edges e of t:  cot(t, e) |e' - R_i e|^2
 *
 * cot(t, e): cotangent of t's angle opposite e; e, e': the edge at rest and now; R_i: the rotation that fits best.
 *
 * One thread at a time may use a deformation; several deformations are independent of each other. The same calls give
 * the same bits on every machine. */
typedef struct pw_deformation pw_deformation;

/* Prepares a deformation and factorizes its system, once for all moves.
 *
 * mesh            at rest; its faces do not matter. Any surface: open, non-manifold, with triangles of no area (they
 *                 count as thicker than they are). Only what is near free vertices matters, so the part that deforms and
 *                 a ring of triangles around it will do; that ring makes the join smooth.
 * roles           vertex_count numbers: PW_VERTEX_FREE, PW_VERTEX_FIXED or the number of the handle that the vertex
 *                 follows. Handles are numbered from 0 without a gap. Free vertices that no triangles connect with a
 *                 fixed vertex or a handle stay.
 * threads         0: as many as help. 1 or more: at most so many. The result is the same, bit for bit.
 * deformation     receives a new handle, to be freed with pw_deformation_free.
 *
 * PW_ERROR_EMPTY: no vertices or triangles. PW_ERROR_INDEX, PW_ERROR_NOT_FINITE: as in pw_build. PW_ERROR_ARGUMENT:
 * a role that is none, a gap between handles, or no vertex left that is free and not on its own. PW_ERROR_DEGENERATE:
 * triangles so thin that the system can't be solved. Takes some 0.1 s for 20,000 vertices, 0.6 s for 100,000. */
PW_API pw_status pw_deformation_create(pw_context *context, const pw_mesh_view *mesh, const int32_t *roles,
                                       int32_t threads, pw_deformation **deformation);

PW_API void pw_deformation_free(pw_deformation *deformation);

/* Takes a handle to a new place: each of its vertices to matrix times its place at rest. Free vertices go some of the
 * way, as a first guess; pw_deformation_iterate does the rest.
 *
 * matrix          12 doubles, the rows of a 3 x 4 matrix: x goes to its first three columns times x, plus the fourth.
 *                 Turn, move, scale, mirror: any.
 *
 * PW_ERROR_ARGUMENT: no such handle. PW_ERROR_NOT_FINITE: an entry is infinite, too large, or not a number. */
PW_API pw_status pw_deformation_move(pw_deformation *deformation, size_t handle, const double *matrix);

/* Improves the free vertices' places: each iteration lowers E, or leaves it where it is least. A canceled call leaves
 * those of the iterations that were done. */
PW_API pw_status pw_deformation_iterate(pw_context *context, pw_deformation *deformation, size_t iterations);

/* E for the present places, in the unit of the coordinates squared. */
PW_API pw_status pw_deformation_energy(pw_deformation *deformation, double *energy);

/* The present places of all vertices, in the order given. positions: vertex_count x 3; vertex_count must be the
 * deformation's. */
PW_API pw_status pw_deformation_positions(const pw_deformation *deformation, double *positions, size_t vertex_count);

/* Everything back to rest. */
PW_API pw_status pw_deformation_reset(pw_deformation *deformation);

/* Normals of vertices, for shading: of each the sum over its triangles of (a x b) / (|a|^2 |b|^2), with a and b the sides
 * that meet there (Max, "Weights for Computing Vertex Normals from Facet Normals", 1999), made of length 1; 0, 0, 0 where
 * that is nothing. The unit of the coordinates does not matter.
 *
 * mesh     as in pw_deformation_create, with the same errors.
 * normals  receives vertex_count x 3. */
PW_API pw_status pw_vertex_normals(const pw_mesh_view *mesh, double *normals);

/* How far each vertex is from the nearest start along the surface: infinity where no way leads. The ways go along edges
 * and straight over an edge to the corner beyond, so they are a few percent too long.
 *
 * mesh      as in pw_deformation_create, with the same errors.
 * start     vertex_count bytes: not 0 at the vertices from which is measured.
 * distance  receives vertex_count doubles, in the unit of the coordinates. */
PW_API pw_status pw_surface_distances(pw_context *context, const pw_mesh_view *mesh, const uint8_t *start,
                                      double *distance);

/* ---- Duplicate faces ------------------------------------------------------------------------------------------ */

/* Which faces pw_build counts once: those with the same outline, wherever it starts and whichever way it winds, with
 * vertices at the same places; and flat polygons with the smaller faces that they are made of. Of two tessellations of one flat
 * region, that is of different faces with one outline in all, the one with fewer faces counts.
 *
 * mesh       as pw_build takes it.
 * original   receives face_count source faces: of each the one that it is a duplicate of, or itself. */
PW_API pw_status pw_duplicate_faces(pw_context *context, const pw_mesh_view *mesh, int32_t *original);

/* ---- Polygons ------------------------------------------------------------------------------------------------- */

/* Counts what keeps polygons from being a closed, manifold, oriented surface; all three are 0 for such a surface.
 *
 * corners  corner_count vertices, polygon after polygon. begin  polygon_count: the first corner of each polygon.
 * non_manifold_edges: without exactly two polygons. inconsistent_edges: both polygons run along them the same way.
 * non_manifold_vertices: of vertex_count, with no polygon or several fans of polygons; not counted (0) unless the
 * other two are 0. */
PW_API pw_status pw_polygon_faults(const int32_t *corners, size_t corner_count, const int32_t *begin,
                                   size_t polygon_count, size_t vertex_count, size_t *non_manifold_edges,
                                   size_t *inconsistent_edges, size_t *non_manifold_vertices);

/* The places of a surface's vertices when the free ones lie as smoothly as their surroundings let them: the sum over
 * all vertices of area times squared umbrella is least, the discrete form of a thin plate's bending, so the surface
 * leaves the fixed part as it arrives there (Kobbelt, Campagna, Vorsatz, Seidel, "Interactive Multi-Resolution Modeling
 * on Arbitrary Meshes", 1998). Umbrellas have the weights 1 / length (Desbrun, Meyer, Schroeder, Barr, "Implicit Fairing
 * of Irregular Meshes", 1999), which slivers do not harm, and know edges only: polygons may have any number of corners.
 *
 * edges   edge_count x 2 vertices.
 * free    vertex_count bytes: not 0 at the vertices that may move. Those from which no way of free ones leads to a
 *         fixed one stay.
 * result  receives vertex_count x 3; it may be vertices itself.
 *
 * PW_ERROR_INDEX, PW_ERROR_NOT_FINITE; PW_ERROR_INTERNAL: the system has no solution in doubles. */
PW_API pw_status pw_fair_vertices(pw_context *context, const double *vertices, size_t vertex_count, const int32_t *edges,
                           size_t edge_count, const uint8_t *free, double *result);

/* ---- Symmetry ------------------------------------------------------------------------------------------------- */

/* The planes in which a surface is its own mirror image: at least 95 % of its area have theirs on it, to 1 % of
 * the bounding box's diagonal. The one in which most has comes first, then those perpendicular to it and each other.
 *
 * mesh    any surface; its faces do not matter.
 * planes  receives 12 doubles at most, 4 a plane: a normal of length 1, and the offset of the plane's points along it.
 * count   receives how many planes there are, 3 at most. */
PW_API pw_status pw_mirror_planes(pw_context *context, const pw_mesh_view *mesh, double *planes, size_t *count);

/* ---- Rays ----------------------------------------------------------------------------------------------------- */

/* A surface that rays can be sent at, to find what is under the mouse. Making it takes some 0.2 s for a million
 * triangles, a ray some 10 microseconds. It never changes: any number of threads may ask it. */
typedef struct pw_ray_target pw_ray_target;

/* mesh    is copied; its faces do not matter. It may be any surface, and empty.
 * target  receives the new target, to be freed with pw_ray_target_free. */
PW_API pw_status pw_ray_target_create(pw_context *context, const pw_mesh_view *mesh, pw_ray_target **target);
PW_API void pw_ray_target_free(pw_ray_target *target);

/* The nearest triangle that the ray meets, from whichever side, and of several as near the lowest. No ray passes between
 * triangles that share an edge, or that fill the space about a vertex.
 *
 * origin, direction    3 doubles each.
 * beyond, distance     in lengths of the direction: only hits farther than beyond count.
 * triangle             receives its index, -1 if there is none.
 *
 * PW_ERROR_NOT_FINITE: a number is infinite or none, or the direction is 0, 0, 0. */
PW_API pw_status pw_ray_target_first(const pw_ray_target *target, const double *origin, const double *direction,
                                     double beyond, int32_t *triangle, double *distance);

/* ---- Convex parts --------------------------------------------------------------------------------------------- */

/* How many hulls, and of what kind. Either hulls or error is more than 0, and the other is 0; 0 also for the rest. */
typedef struct pw_convex_options {
    size_t struct_size; /* sizeof(pw_convex_options) */
    /* So many hulls, 1 to 4096; fewer where more would gain nothing. */
    size_t hulls;
    /* As few hulls as are found of which no point of the surface is farther than this from the solid, in the caller's unit;
     * points in the solid have no distance. At most 4096: if more are needed, the reported errors show it. */
    double error;
    /* At most so many vertices a hull, 8 or more; 0: any number. Of a hull that has more, a convex polytope around it is
     * taken: it contains all that the hull did, and a little more. */
    size_t max_vertices;
    /* The radius of a ball. It passes the hulls' openings wherever it passes the solid's: its center is never in a hull that
     * has no larger error than this. With hulls, these hulls go first where they keep openings free. */
    double keep_open;
    /* Only this part of the solid: slice_count x (first, last) of disjoint slices of its tetrahedra; null: all. Errors are
     * still distances from the whole solid. */
    const int32_t *slices;
    size_t slice_count;
    /* 0: as many threads as help; 1 or more: at most so many. The result is the same, bit for bit. */
    size_t threads;
} pw_convex_options;

/* pw_convex_options options = PW_CONVEX_OPTIONS_INIT; then set hulls or error. */
#define PW_CONVEX_OPTIONS_INIT {sizeof(pw_convex_options), 0, 0, 0, 0, 0, 0, 0}

typedef struct pw_convex_parts pw_convex_parts;

/* Convex hulls that together contain the solid of a hierarchy, with little volume besides.
 *
 * Planes divide the solid, first along its flat walls, then where the sum of the hulls' volumes falls most, or where two
 * planes together make it fall. Pieces are merged again where it grows least. So parts are none of the hierarchy's, whose mode
 * doesn't matter. Each step takes the least sum: the result is a good one, not the best. The search works on a coarse copy of
 * the solid, the hulls are those of the solid itself. Directions of planes are those of walls, of a lattice and the pieces'
 * own, so the result depends a little on how the model is turned, but not on its unit, threads, or the order of what was given.
 *
 * context  may be null; else pw_context_progress() tells the fraction, the stage means nothing, and pw_context_cancel()
 *          ends the call. One call at a time may have it.
 * parts    receives the hulls, to be freed with pw_convex_parts_free. They keep nothing of the hierarchy.
 *
 * PW_ERROR_ARGUMENT: options that are none; PW_ERROR_CANCELED. It takes some 0.1 to 1 s. */
PW_API pw_status pw_hierarchy_convex_parts(pw_context *context, const pw_hierarchy *hierarchy,
                                           const pw_convex_options *options, pw_convex_parts **parts);
PW_API void pw_convex_parts_free(pw_convex_parts *parts);

PW_API pw_status pw_convex_parts_count(const pw_convex_parts *parts, size_t *count);

/* One of them, 0 to count - 1, the largest first.
 *
 * vertices   vertex_count x 3; owned by parts, as are the triangles.
 * triangles  triangle_count x 3 indices into them: closed, convex, outward. Vertices are the extreme points, to rounding.
 * volume     of the part of the solid that this hull is for. These add up to the solid's.
 * error      the largest distance of its surface from the solid, or up to 1/100 of error or keep_open too much; if it is above
 *            keep_open, the hull may cover an opening. Negative if neither was asked for. */
PW_API pw_status pw_convex_parts_hull(const pw_convex_parts *parts, size_t index, const double **vertices,
                                      size_t *vertex_count, const int32_t **triangles, size_t *triangle_count,
                                      double *volume, double *error);

/* ---- The hierarchy as an index -------------------------------------------------------------------------------- */

/* A hierarchy to be asked where things are (the paper, section 4): which part holds a point, which one a ray meets first,
 * which is nearest, and where two hierarchies touch. Made once, asked about arrays of points, rays and places. It has one of
 * two resolutions, and so have all answers:
 *
 *   exact   its parts are the tetrahedra. So the answers are those of the solid that the hierarchy is of: the caller's
 *           own if it was used as it is, else the one that was made of that. Tetrahedron t is leaf t: pw_arrays.parent leads to the nodes
 *           that hold it, and it is in part k of a cut if bounds[k] <= t < bounds[k + 1]. pw_arrays has its source faces.
 *   hulls   its parts are the convex hulls of a cut's parts: fewer, larger, and they may overlap.
 *
 * Whether a point is in a part, and whether facets meet, is decided exactly, on the coordinates as they are; what lies in a
 * boundary is in. Distances and places are rounded. The result does not depend on threads.
 *
 * The index is the tree itself: boxes about the nodes' surfaces, and hulls about those of the last eight parts and all above, or
 * of the parts of the cut, by which two that are near each other are distinguished. It is made of what pw_hierarchy_save() keeps, so also
 * after pw_hierarchy_load(); it keeps nothing of the hierarchy. It never changes: any number of threads may ask it. */
typedef struct pw_index pw_index;

/* bounds   bound_count of a cut, see pw_hierarchy_cut_height: the index has the hulls of its parts. Null, and 0: exact.
 * threads  0: as many as help answer one call; 1 or more: at most so many.
 * index    receives the new index, to be freed with pw_index_free. It takes some 0.1 s for 50,000 tetrahedra.
 *
 * PW_ERROR_ARGUMENT: bounds that no cut of this hierarchy has. PW_ERROR_NO_VOLUME: no part has a hull with a volume. */
PW_API pw_status pw_index_create(pw_context *context, const pw_hierarchy *hierarchy, const int32_t *bounds,
                                 size_t bound_count, int32_t threads, pw_index **index);
PW_API void pw_index_free(pw_index *index);

/* Below, coordinates of points are at most 1e100 in size; else, or where a ray has no direction: PW_ERROR_NOT_FINITE. A
 * canceled call may have written some of the answers. */

/* The part that holds each point; of several the lowest.
 *
 * points  count x 3.
 * parts   receives count numbers: -1 for a point that is outside. */
PW_API pw_status pw_index_locate(pw_context *context, const pw_index *index, const double *points, size_t count,
                                  int32_t *parts);

/* What each ray meets first of the surface (exact) or of the hulls' surfaces, from whichever side: so a ray that begins inside meets
 * where it comes out. Of several as near the lowest part. No ray passes between triangles that share an edge.
 *
 * origins, directions  count x 3 each.
 * parts                receives count numbers: the part whose facet that is; -1: none.
 * distances            receives count lengths, each in lengths of its ray's direction; 0 where there is none. */
PW_API pw_status pw_index_first_hits(pw_context *context, const pw_index *index, const double *origins,
                                     const double *directions, size_t count, int32_t *parts, double *distances);

/* What is nearest to each point: the part that holds it, as pw_index_locate has it, at a distance of 0; else the one whose
 * facet is nearest.
 *
 * points     count x 3.
 * parts      receives count numbers.
 * distances  receives count lengths.
 * nearest    receives count x 3: the part's point that is nearest, the point itself inside. */
PW_API pw_status pw_index_nearest(pw_context *context, const pw_index *index, const double *points, size_t count,
                                  int32_t *parts, double *distances, double *nearest);

/* Whether index and other touch, for each of several places of the other: whether they have a point in common, also where one is
 * all inside the other. Its vertices are where ((m0 x + m1 y) + m2 z) + m3 and so on comes to in doubles; on those
 * coordinates the answer is exact.
 *
 * other     may be index itself.
 * matrices  count x 12: for each place the rows of a 3 x 4 matrix, which takes the other's coordinates to the index's.
 * parts     receives count x 2 numbers: a part of the index and one of the other that touch, -1 and -1 if none do. Of several
 *           such pairs any, but the same one on each run.
 * points    receives count x 3: a point of both, in the index's coordinates; 0, 0, 0 if there is none.
 *
 * PW_ERROR_NOT_FINITE: a matrix that has an entry above 1e100, or that leaves the other no volume. */
PW_API pw_status pw_index_intersects(pw_context *context, const pw_index *index, const pw_index *other,
                                   const double *matrices, size_t count, int32_t *parts, double *points);

#ifdef __cplusplus
}
#endif

#endif
