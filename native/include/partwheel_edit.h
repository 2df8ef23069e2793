/* The C API for editing a mesh by its parts: borders in creases, seams, deformation, fairing, checks of polygons, ray
 * casting, convex parts, and spatial queries on the hierarchy. The conventions are those of partwheel.h.
 *
 * Triangles are adjacent if they share vertex indices. Weld coincident vertices first, as the Python package does
 * (partwheel.weld); otherwise a surface that is split at UV or normal seams falls apart there.
 *
 * Experimental: a minor version may change or remove functions of this header, also after 1.0. The library's soname
 * contains the minor version only until 1.0, so these functions have a version of their own. A program that is not
 * built together with the library compares it once, before it calls any of them:
 *
 *     if (pw_edit_api_version() != PW_EDIT_API_VERSION) ... the library has another version of these functions
 */
#ifndef PARTWHEEL_EDIT_H
#define PARTWHEEL_EDIT_H

#include "partwheel.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Grows whenever a function of this header changes or is removed. */
#define PW_EDIT_API_VERSION 1

/* PW_EDIT_API_VERSION of the loaded library. */
PW_API int32_t pw_edit_api_version(void);

/* ---- Borders -------------------------------------------------------------------------------------------------- */

/* Border snapping: moves the border of a part to creases nearby, where people would end the part, by a minimum cut in a
 * band around the border (Katz, Tal, "Hierarchical Mesh Decomposition Using Fuzzy Clustering and Cuts", 2003). The
 * border runs along edges between faces. An edge costs its length times a weight after Golovinskiy, Funkhouser,
 * "Randomized Cuts for 3D Mesh Analysis" (2008): 1 where the surface is flat, somewhat less at sharp convex edges, and
 * much less at concave ones. Edges cost up to half more with their distance from the given border. The sum is minimal,
 * so the sum of length times weight never grows.
 *
 * On either side, the band is as wide as a fifth of the square root of the area of the part or of the rest, whichever
 * is smaller. It has at most 12,000 faces, and never covers a whole connected component. So no component vanishes or is
 * divided, and faces stay whole. Apart from ties between equal costs or distances, which rounding decides, the result
 * depends neither on the order of vertices, triangles and faces nor on the unit.
 *
 * pw_creases_create computes once what the borders of all parts need. The handle is immutable, so any number of threads
 * may use it at the same time. Free it with pw_creases_free.
 *
 * mesh    is copied. Any surface is allowed: open, non-manifold, with triangles without area, or closed and oriented
 *         inward. A face without triangles stays on its side.
 * creases receives the new handle.
 *
 * PW_ERROR_EMPTY: no faces. PW_ERROR_INDEX, PW_ERROR_NOT_FINITE, PW_ERROR_ARGUMENT: as in pw_build. */
typedef struct pw_creases pw_creases;

PW_API pw_status pw_creases_create(pw_context *context, const pw_mesh_view *mesh, pw_creases **creases);
PW_API void pw_creases_free(pw_creases *creases);

/* Moves the border of a part. For 100,000 faces, pw_creases_create takes about 35 ms, and this about 15 ms.
 *
 * inside  face_count bytes, one for each face of the mesh: not 0 for faces of the part.
 * result  receives face_count bytes: 1 for the faces of the part with its new border, else 0. It may be the same array
 *         as inside.
 *
 * PW_ERROR_EMPTY: the part has no faces. PW_ERROR_ARGUMENT: face_count is not that of the mesh. */
PW_API pw_status pw_creases_snap(const pw_creases *creases, const uint8_t *inside, size_t face_count, uint8_t *result);

/* ---- Parts made by hand --------------------------------------------------------------------------------------- */

/* Makes a hierarchy in which the given source faces are a node with score 1, so that the wheel stops there. Free it
 * with pw_hierarchy_free.
 *
 * The smallest cluster that contains the faces becomes the union of the part and of the rest of that cluster. Clusters
 * below it that contain faces of both are divided, and each piece has the score of the whole times its share of the
 * area. All other clusters keep their tetrahedra, faces, scores and concavities, and so do the wheel stops within the
 * part, within the rest, and around both. Faces that share a tetrahedron stay together, on the side of most of their
 * area.
 *
 * faces   face_count indices of source faces, in any order.
 * result  receives the new hierarchy. If the part is a node already, only the score of that node changes.
 *
 * PW_ERROR_EMPTY: no tetrahedron has most of its area in the part. PW_ERROR_ARGUMENT: a face does not exist, the mode
 * is PW_MODE_PAPER, or the part contains a piece of one shell and faces of another. Whole shells can form a part. */
PW_API pw_status pw_hierarchy_with_part(pw_context *context, const pw_hierarchy *hierarchy, const int32_t *faces,
                                        size_t face_count, pw_hierarchy **result);

/* ---- Seams ---------------------------------------------------------------------------------------------------- */

/* Seams for unwrapping: along the borders of parts, snapped to creases unless keep_borders is 1. Cut open there, the
 * surface becomes patches that are topological disks. More cuts, preferably in creases, divide patches until no
 * conformal map overlaps itself or exceeds max_distortion, as far as cuts can help. Work that might grow with the
 * square of a part is bounded. docs/seams.md explains the method. Results are the same on every machine, bit for bit.
 *
 * mesh            the mesh of the hierarchy, with the same faces. Coincident vertices are not welded.
 * labels          face_count numbers from 0 to face_count - 1: the part of each face.
 * keep_borders    0: borders of the labels are snapped to creases nearby. 1: they stay, for labels that somebody chose.
 * max_distortion  the mean factor by which areas within a patch may differ, more than 1; 1.09 is usual.
 * is_seam         receives 3 * triangle_count bytes. At 3 t + k: 1 if the side of triangle t from corner k to the next
 *                 one is on a seam, else 0. Both sides of an edge have the same value. An edge with one triangle is not
 *                 a seam; an edge with more than two always is.
 *
 * PW_ERROR_ARGUMENT: face_count, a label or max_distortion is not allowed. Other errors: as in pw_creases_create. */
PW_API pw_status pw_hierarchy_seams(pw_context *context, const pw_hierarchy *hierarchy, const pw_mesh_view *mesh,
                                    const int32_t *labels, int32_t keep_borders, double max_distortion,
                                    uint8_t *is_seam);

/* Where the solver of an unwrapping failed, an island has far more area distortion than predicted: divides each such
 * island once, along the tree.
 *
 * mesh, max_distortion  as above.
 * uvs                   6 * triangle_count numbers: u and v of each corner of each triangle, unwrapped along the seams.
 * is_seam               the seams, as above; receives the refined seams. They are the same if no island failed or none
 *                       can be divided. After an error the array is unchanged. */
PW_API pw_status pw_hierarchy_refine_seams(pw_context *context, const pw_hierarchy *hierarchy, const pw_mesh_view *mesh,
                                           const double *uvs, double max_distortion, uint8_t *is_seam);

/* ---- Deformation ---------------------------------------------------------------------------------------------- */

/* The role of a vertex in a deformation, unless it follows a handle (0, 1, 2 ...). */
#define PW_VERTEX_FREE (-1)  /* is deformed */
#define PW_VERTEX_FIXED (-2) /* does not move */

/* A surface whose free vertices follow handles as rigidly as possible: Sorkine, Alexa, "As-Rigid-As-Possible Surface
 * Modeling" (2007), which the paper uses in its section 4.1, with the energy called "spokes and rims" (Chao, Pinkall,
 * Sanan, Schroeder, "A Simple Geometric Model for Elastic Deformations", 2010):
 *
 *   E = sum over vertices i, triangles t at i, edges e of t:  cot(t, e) |e' - R_i e|^2
 *
 * cot(t, e): the cotangent of t's angle opposite e; e, e': the edge at rest and deformed; R_i: the best rotation.
 *
 * One thread at a time may use a deformation; several deformations are independent of each other. The same calls give
 * the same bits on every machine. */
typedef struct pw_deformation pw_deformation;

/* Prepares a deformation and factorizes its system, once for all moves.
 *
 * mesh            at rest; its faces are ignored. Any surface is allowed: open, non-manifold, or with triangles without
 *                 area (they count as thicker than they are). Only what is near free vertices matters, so the part that
 *                 deforms and a ring of triangles around it are enough. The ring makes the transition smooth.
 * roles           vertex_count numbers: PW_VERTEX_FREE, PW_VERTEX_FIXED or the number of the handle that the vertex
 *                 follows. Handles are numbered from 0 without a gap. Free vertices that no triangles connect with a
 *                 fixed vertex or a handle don't move.
 * threads         0: as many threads as help. 1 or more: at most this many. The result is the same, bit for bit.
 * deformation     receives a new handle, to be freed with pw_deformation_free.
 *
 * PW_ERROR_EMPTY: no vertices or triangles. PW_ERROR_INDEX, PW_ERROR_NOT_FINITE: as in pw_build. PW_ERROR_ARGUMENT:
 * a role does not exist, handles have a gap, or no connected vertex is free. PW_ERROR_DEGENERATE: triangles are so thin
 * that the system can't be solved. Takes about 0.1 s for 20,000 vertices, 0.6 s for 100,000. */
PW_API pw_status pw_deformation_create(pw_context *context, const pw_mesh_view *mesh, const int32_t *roles,
                                       int32_t threads, pw_deformation **deformation);

PW_API void pw_deformation_free(pw_deformation *deformation);

/* Moves a handle: each of its vertices to matrix times its position at rest. Free vertices move part of the way, as an
 * initial guess; call pw_deformation_iterate afterward.
 *
 * matrix          12 doubles, the rows of a 3 x 4 matrix (A | b), which takes x to A x + b. It may rotate, move, scale
 *                 and mirror.
 *
 * PW_ERROR_ARGUMENT: the handle does not exist. PW_ERROR_NOT_FINITE: an entry is NaN, infinite or too large. */
PW_API pw_status pw_deformation_move(pw_deformation *deformation, size_t handle, const double *matrix);

/* Improves the positions of free vertices. Each iteration lowers E, unless it is minimal. A canceled call keeps the
 * result of the iterations that were completed. */
PW_API pw_status pw_deformation_iterate(pw_context *context, pw_deformation *deformation, size_t iterations);

/* E of the current positions, in the unit of the coordinates squared. */
PW_API pw_status pw_deformation_energy(pw_deformation *deformation, double *energy);

/* The current positions of all vertices, in the mesh's order. positions: receives vertex_count x 3; vertex_count must
 * be that of the mesh. */
PW_API pw_status pw_deformation_positions(const pw_deformation *deformation, double *positions, size_t vertex_count);

/* Moves all vertices back to their positions at rest. */
PW_API pw_status pw_deformation_reset(pw_deformation *deformation);

/* Vertex normals, for shading: the sum over the vertex's triangles of (a x b) / (|a|^2 |b|^2), with a and b the sides
 * that meet at the vertex (Max, "Weights for Computing Vertex Normals from Facet Normals", 1999), normalized; 0, 0, 0
 * if the sum is 0. The unit of the coordinates does not matter.
 *
 * mesh     as in pw_deformation_create, with the same errors.
 * normals  receives vertex_count x 3. */
PW_API pw_status pw_vertex_normals(const pw_mesh_view *mesh, double *normals);

/* The distance along the surface from each vertex to the nearest start vertex; infinity if none is connected to it.
 * Paths run along edges, and straight across an edge to the opposite corner, so they are a few percent too long.
 *
 * mesh      as in pw_deformation_create, with the same errors.
 * start     vertex_count bytes: not 0 for start vertices.
 * distance  receives vertex_count doubles, in the unit of the coordinates. */
PW_API pw_status pw_surface_distances(pw_context *context, const pw_mesh_view *mesh, const uint8_t *start,
                                      double *distance);

/* ---- Duplicate faces ------------------------------------------------------------------------------------------ */

/* Finds duplicate faces, which pw_build counts once: faces with the same outline, with vertices at the same positions,
 * wherever it starts and whichever way it winds; and a flat polygon together with the smaller faces that it consists
 * of. If two tessellations cover one flat region, with the same outline, the one with fewer faces counts.
 *
 * mesh       as in pw_build.
 * original   receives face_count source faces: for each face the one that it is a duplicate of, or itself. */
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

/* Fairing: moves free vertices to where the surface is smoothest. It minimizes the sum over all vertices of area times
 * squared umbrella vector, the discrete bending energy of a thin plate, so the surface continues the fixed part
 * smoothly (Kobbelt, Campagna, Vorsatz, Seidel, "Interactive Multi-Resolution Modeling on Arbitrary Meshes", 1998).
 * Umbrella vectors have the weights 1 / length (Desbrun, Meyer, Schroeder, Barr, "Implicit Fairing of Irregular
 * Meshes", 1999), which tolerate slivers. They need edges only, so polygons may have any number of corners.
 *
 * edges   edge_count x 2 vertices.
 * free    vertex_count bytes: not 0 for vertices that may move. Free vertices that are not connected with a fixed one
 *         through free ones don't move.
 * result  receives vertex_count x 3; it may be the same array as vertices.
 *
 * PW_ERROR_INDEX, PW_ERROR_NOT_FINITE; PW_ERROR_INTERNAL: the system has no solution in doubles. */
PW_API pw_status pw_fair_vertices(pw_context *context, const double *vertices, size_t vertex_count,
                                  const int32_t *edges, size_t edge_count, const uint8_t *free, double *result);

/* ---- Symmetry ------------------------------------------------------------------------------------------------- */

/* Symmetry planes: the mirror image of at least 95 % of the surface's area lies on the surface, to 1 % of the bounding
 * box's diagonal. The plane with the largest such share comes first, then those perpendicular to it and to each other.
 *
 * mesh    any surface; its faces are ignored.
 * planes  receives at most 12 doubles, 4 for each plane: a unit normal n and the offset d, for points with n * x = d.
 * count   receives the number of planes, at most 3. */
PW_API pw_status pw_mirror_planes(pw_context *context, const pw_mesh_view *mesh, double *planes, size_t *count);

/* ---- Rays ----------------------------------------------------------------------------------------------------- */

/* A surface for ray casting, for example to find what is under the mouse. Creating it takes about 0.2 s for a million
 * triangles, a ray about 10 microseconds. It is immutable, so any number of threads may use it at the same time. */
typedef struct pw_ray_target pw_ray_target;

/* mesh    is copied; its faces are ignored. Any surface is allowed, also an empty one.
 * target  receives the new handle, to be freed with pw_ray_target_free. */
PW_API pw_status pw_ray_target_create(pw_context *context, const pw_mesh_view *mesh, pw_ray_target **target);
PW_API void pw_ray_target_free(pw_ray_target *target);

/* The first triangle that the ray hits, from either side; in a tie the lowest one. No ray passes between triangles that
 * share an edge, or that fill the space around a vertex.
 *
 * origin, direction        3 doubles each.
 * min_distance, distance   in lengths of the direction: only hits farther than min_distance count.
 * triangle                 receives its index, or -1 if the ray hits none.
 *
 * PW_ERROR_NOT_FINITE: a number is NaN or infinite, or the direction is 0, 0, 0. */
PW_API pw_status pw_ray_target_first(const pw_ray_target *target, const double *origin, const double *direction,
                                     double min_distance, int32_t *triangle, double *distance);

/* ---- Convex parts --------------------------------------------------------------------------------------------- */

/* The number of hulls, and their kind. Either hulls or error is more than 0, and the other is 0. */
typedef struct pw_convex_options {
    size_t struct_size; /* sizeof(pw_convex_options) */
    /* The number of hulls, 1 to 4096. There are fewer if more would gain nothing. */
    size_t hulls;
    /* The largest distance of a hull's surface from the solid, in the caller's unit, with as few hulls as possible.
     * Points inside the solid have no distance. There are at most 4096 hulls; if more are needed, their errors are
     * larger. */
    double error;
    /* The largest number of vertices of a hull, 8 or more; 0: any number. A hull with more vertices is replaced by a
     * convex polytope that contains it and is slightly larger. */
    size_t max_vertices;
    /* The radius of a ball that shall pass the openings of the hulls wherever it passes those of the solid: its center
     * is never inside a hull whose error is at most this. If hulls is set, this comes before a small volume. */
    double keep_open;
    /* Only this part of the solid: slice_count x (first, last), disjoint slices of its tetrahedra; null: all. Errors
     * are still distances from the whole solid. */
    const int32_t *slices;
    size_t slice_count;
    /* 0: as many threads as help. 1 or more: at most this many. The result is the same, bit for bit. */
    size_t threads;
} pw_convex_options;

/* pw_convex_options options = PW_CONVEX_OPTIONS_INIT; then set hulls or error. */
#define PW_CONVEX_OPTIONS_INIT {sizeof(pw_convex_options), 0, 0, 0, 0, 0, 0, 0}

typedef struct pw_convex_parts pw_convex_parts;

/* Convex decomposition: hulls that together contain the solid of a hierarchy, with little excess volume.
 *
 * Planes divide the solid: first along its flat walls, then where one plane, or two together, reduce the sum of the
 * hulls' volumes most. Then pieces are merged where the sum grows least. The search is greedy, so the result is good
 * but not optimal. It is independent of the hierarchy's parts and mode. The search runs on a coarse copy of the solid;
 * the hulls are those of the solid itself. The directions of planes are those of walls, of a lattice, and the principal
 * directions of pieces. So the result depends slightly on the model's orientation, but not on its unit, the number of
 * threads, or the order of the input.
 *
 * parts    receives the hulls, to be freed with pw_convex_parts_free. They don't refer to the hierarchy.
 *
 * PW_ERROR_ARGUMENT: an option is not allowed. Takes about 0.1 to 1 s. */
PW_API pw_status pw_hierarchy_convex_parts(pw_context *context, const pw_hierarchy *hierarchy,
                                           const pw_convex_options *options, pw_convex_parts **parts);
PW_API void pw_convex_parts_free(pw_convex_parts *parts);

PW_API pw_status pw_convex_parts_count(const pw_convex_parts *parts, size_t *count);

/* Hull number index, 0 to count - 1, the largest first.
 *
 * vertices   vertex_count x 3, the extreme points up to rounding. Owned by parts, as are the triangles.
 * triangles  triangle_count x 3 indices into them: closed, convex, outward.
 * volume     of the part of the solid that the hull covers. The sum over all hulls is the volume of the solid.
 * error      the largest distance of its surface from the solid; it may be too large by 1/100 of the options' error or
 *            keep_open. If it is above keep_open, the hull may cover an opening. Negative if both options are 0. */
PW_API pw_status pw_convex_parts_hull(const pw_convex_parts *parts, size_t index, const double **vertices,
                                      size_t *vertex_count, const int32_t **triangles, size_t *triangle_count,
                                      double *volume, double *error);

/* ---- Spatial index -------------------------------------------------------------------------------------------- */

/* A spatial index (the paper, section 4): which part contains a point, which one a ray hits first, which one is
 * nearest, and whether two hierarchies intersect. Create it once, and query it for arrays of points, rays and
 * transforms. It has one of two resolutions:
 *
 *   exact   its parts are the tetrahedra. So answers refer to the solid of the hierarchy: that of the caller's surface
 *           if it was used as it is, else the solid that replaced it. Tetrahedron t is leaf t: pw_arrays.parent leads
 *           to the nodes that contain it, and it is in part k of a cut if bounds[k] <= t < bounds[k + 1].
 *   hulls   its parts are the convex hulls of the parts of a cut: fewer, larger, and they may overlap.
 *
 * Whether a point is in a part, and whether facets intersect, is decided exactly for the given coordinates; boundaries
 * belong to parts. Distances and points are rounded. The result does not depend on the number of threads.
 *
 * The index has the structure of the tree: bounding boxes of the nodes' surfaces, and, to separate parts that are
 * close, convex hulls of the parts of the cut, or of the last eight parts, and of all nodes above. It also works for a
 * loaded hierarchy, and doesn't refer to the hierarchy. It is immutable, so any number of threads may query it at the
 * same time. */
typedef struct pw_index pw_index;

/* bounds   bound_count bounds of a cut, see pw_hierarchy_cut_height: the index has the hulls of its parts. Null and 0:
 * exact. threads  of each query. 0: as many threads as help. 1 or more: at most this many.
 * index    receives the new index, to be freed with pw_index_free. Takes about 0.1 s for 50,000 tetrahedra.
 *
 * PW_ERROR_ARGUMENT: the bounds are not those of a cut of this hierarchy. PW_ERROR_NO_VOLUME: no hull has a volume. */
PW_API pw_status pw_index_create(pw_context *context, const pw_hierarchy *hierarchy, const int32_t *bounds,
                                 size_t bound_count, int32_t threads, pw_index **index);
PW_API void pw_index_free(pw_index *index);

/* Below, PW_ERROR_NOT_FINITE: a coordinate is NaN or above 1e100 in size, or a ray has no direction. A canceled call
 * may have written some of its results. */

/* The part that contains each point; of several the lowest.
 *
 * points  count x 3.
 * parts   receives count numbers: -1 for a point outside. */
PW_API pw_status pw_index_locate(pw_context *context, const pw_index *index, const double *points, size_t count,
                                 int32_t *parts);

/* The part that each ray hits first: on the surface (exact) or on those of the hulls, from either side, so a ray that
 * starts inside hits where it leaves. In a tie the lowest part. No ray passes between triangles that share an edge.
 *
 * origins, directions  count x 3 each.
 * parts                receives count numbers: the part whose facet is hit; -1: none.
 * distances            receives count numbers, in lengths of the ray's direction; 0 if nothing is hit. */
PW_API pw_status pw_index_first_hits(pw_context *context, const pw_index *index, const double *origins,
                                     const double *directions, size_t count, int32_t *parts, double *distances);

/* The part nearest to each point: the part that contains it, as in pw_index_locate, at distance 0; else the part with
 * the nearest facet.
 *
 * points     count x 3.
 * parts      receives count numbers.
 * distances  receives count distances.
 * nearest    receives count x 3: the nearest point of that part; inside, the point itself. */
PW_API pw_status pw_index_nearest(pw_context *context, const pw_index *index, const double *points, size_t count,
                                  int32_t *parts, double *distances, double *nearest);

/* For each of several transforms of the other index: whether the two have a point in common, also if one is inside the
 * other. The other's vertices are transformed in doubles, as ((m0 x + m1 y) + m2 z) + m3 and so on; for these
 * coordinates the answer is exact.
 *
 * other     may be index itself.
 * matrices  count x 12: the rows of 3 x 4 matrices, which take the other's coordinates to those of index.
 * parts     receives count x 2 numbers: a part of index and a part of other that intersect; -1 and -1: none do. Of
 *           several pairs any, but the same one on each run.
 * points    receives count x 3: a common point, in the coordinates of index; 0, 0, 0 if there is none.
 *
 * PW_ERROR_NOT_FINITE: a matrix has an entry that is NaN or above 1e100, or scales the other index to zero volume. */
PW_API pw_status pw_index_intersects(pw_context *context, const pw_index *index, const pw_index *other,
                                     const double *matrices, size_t count, int32_t *parts, double *points);

#ifdef __cplusplus
}
#endif

#endif
