/* Partwheel's C API: it turns a triangle mesh into a hierarchy of nearly convex parts. Functions that edit a mesh with
 * such parts are in partwheel_edit.h.
 *
 * The method is "Hierarchical Convex Approximation of 3D Shapes for Fast Region Selection" (Attene, Mortara,
 * Spagnuolo, Falcidieno 2008), called "the paper" below.
 *
 * Conventions of all functions, unless a function's comment says otherwise:
 *  - It returns a pw_status, and writes results through pointers, only if it returns PW_OK. The one exception is the
 *    count of PW_ERROR_CAPACITY.
 *  - After any other status, pw_error_message() in the same thread says what went wrong and what to do about it.
 *  - It lets no C++ exception escape, and calls neither exit() nor abort().
 *  - Handles are opaque. One function creates a handle, and the matching _free frees it; _free(NULL) does nothing.
 *  - Lengths are in the unit of the caller's coordinates, volumes in that unit cubed. Coordinates are doubles.
 *  - A pw_hierarchy is immutable, so any number of threads may query it at the same time.
 *  - It only reads the caller's input buffers, and only during the call.
 *  - A function that can take more than 100 ms for 350,000 triangles takes a pw_context, which may be null.
 *  - An array may be null if its count is 0. More than PW_MAX_COUNT vertices, triangles and so on are refused with
 *    PW_ERROR_ARGUMENT before anything is read; only the capacity of an array to be filled may be any number.
 *  - Every struct begins with struct_size. Later versions may add members at its end. The caller sets struct_size to
 *    the struct's sizeof before the call, also if the call fills the struct. So program and library may be of different
 *    versions. In an older program, new options are 0, the default, and new results are left out. With an older
 *    library, new options must be 0 (else PW_ERROR_ARGUMENT), and new results become 0.
 */
#ifndef PARTWHEEL_H
#define PARTWHEEL_H

#include "partwheel_types.h"

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(PW_BUILDING)
#define PW_API __declspec(dllexport)
#else
#define PW_API __declspec(dllimport)
#endif
#else
#define PW_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header: as text, and as numbers for the preprocessor, of which PW_VERSION_NUMBER only grows. */
#define PW_VERSION "0.1.0"
#define PW_VERSION_MAJOR 0
#define PW_VERSION_MINOR 1
#define PW_VERSION_PATCH 0
#define PW_VERSION_NUMBER (PW_VERSION_MAJOR * 10000 + PW_VERSION_MINOR * 100 + PW_VERSION_PATCH)

/* The version of the loaded library, "major.minor.patch". Never null; owned by the library. */
PW_API const char *pw_version(void);

/* A status in one or two words, lower case, stable ("self-intersection"). Never null; owned by the library. */
PW_API const char *pw_status_name(pw_status status);

/* The name of a stage ("tetrahedra"). Never null; owned by the library. */
PW_API const char *pw_stage_name(pw_stage stage);

/* The error of the calling thread's last call that did not return PW_OK: sentences that say what to do, UTF-8. Never
 * null ("" if there was none). Owned by the library, valid until the thread's next call that fails. */
PW_API const char *pw_error_message(void);

/* Where in the caller's mesh that error is, so that a program can select the place. */
typedef struct pw_error_info {
    size_t struct_size;  /* sizeof(pw_error_info), set by the caller */
    int64_t faces[2];    /* source faces: the first one that is wrong; both that intersect. -1: none */
    int64_t vertices[2]; /* a vertex that is wrong, or both ends of an edge. -1: none */
    int64_t triangle;    /* a triangle that refers to a vertex or a face that does not exist. -1: none */
} pw_error_info;

/* pw_error_info info = PW_ERROR_INFO_INIT; ready to be filled. */
#define PW_ERROR_INFO_INIT {sizeof(pw_error_info), {-1, -1}, {-1, -1}, -1}

/* Its indices refer to the arrays that the caller passed to the failed call. Doesn't change pw_error_message(), unless
 * it fails itself. */
PW_API pw_status pw_error_details(pw_error_info *info);

/* ---- Meshes --------------------------------------------------------------------------------------------------- */

/* A triangle mesh in the caller's memory. Initialize it with PW_MESH_VIEW_INIT, then set the pointers and counts.
 *
 * vertices      vertex_count x 3 coordinates of vertex_type, at most 1e100 in size.
 * triangles     triangle_count x 3 vertex indices of index_type, counter-clockwise seen from outside.
 * faces         triangle_count indices of index_type, or null. Of each triangle: the polygon (source face) that it
 *               belongs to, 0 <= index < face_count. Null: every triangle is a face of its own, and face_count is
 *               triangle_count or 0.
 * ..._stride    bytes from one vertex, triangle or face to the next. 0: they are packed.
 *
 * Packed doubles and int32 are read in place. Any other layout is copied first. Coordinates of type float give the
 * result that the same numbers as doubles give. */
typedef struct pw_mesh_view {
    size_t struct_size; /* sizeof(pw_mesh_view) */
    const void *vertices;
    size_t vertex_count;
    size_t vertex_stride;
    const void *triangles;
    size_t triangle_count;
    size_t triangle_stride;
    const void *faces;
    size_t face_count;
    size_t face_stride;
    int32_t vertex_type; /* a pw_vertex_type */
    int32_t index_type;  /* a pw_index_type */
} pw_mesh_view;

/* pw_mesh_view mesh = PW_MESH_VIEW_INIT; an empty mesh of packed doubles and int32. */
#define PW_MESH_VIEW_INIT {sizeof(pw_mesh_view), 0, 0, 0, 0, 0, 0, 0, 0, 0, PW_DOUBLE, PW_INT32}

/* ---- Context: watching and stopping a long call --------------------------------------------------------------- */

/* Progress, cancellation and timing of one call at a time: a build, or any other function that takes a context. All
 * pw_context functions except pw_context_free may be called from any thread while that call runs. */
typedef struct pw_context pw_context;

PW_API pw_status pw_context_create(pw_context **context);
PW_API void pw_context_free(pw_context *context);

/* Asks the running call (or, if none runs, the next one) to stop with PW_ERROR_CANCELED. A build stops within 100 ms;
 * beyond some 200,000 faces, within a time proportional to them, since sorting an array is one step. Other calls
 * stop between their steps, the longest of which is the factorization of pw_deformation_create and pw_fair_vertices. */
PW_API pw_status pw_context_cancel(pw_context *context);

/* fraction: 0..1 of the whole call, monotone. stage: the build's current stage; meaningless for other calls. Either may
 * be null. */
PW_API pw_status pw_context_progress(const pw_context *context, double *fraction, pw_stage *stage);

/* The fill method that the running build tries, or the last build tried last, for any shell; PW_FILL_EXACT before the
 * first build. */
PW_API pw_status pw_context_fill_method(const pw_context *context, pw_fill_method *fill_method);

/* Wall-clock seconds that each stage of the last build took, a failed stage included, 0 for stages not reached; the sum
 * over the shells, which are built in several threads.
 * seconds: PW_STAGE_COUNT doubles. */
PW_API pw_status pw_context_seconds(const pw_context *context, double *seconds);

/* ---- Building ------------------------------------------------------------------------------------------------- */

/* Which tree is built. */
typedef enum pw_mode {
    PW_MODE_LEARNED = 0, /* the paper's tree below about 600 parts; a network merges these as people would */
    PW_MODE_PAPER = 1    /* the paper's tree */
} pw_mode;

/* docs/how.md says how PW_MODE_LEARNED, the default, differs from the paper, and why. */

/* Marked edges of one kind: something besides the shape divides the surface there, such as a border of materials. */
typedef struct pw_marks {
    size_t struct_size; /* sizeof(pw_marks) */
    const char *name;   /* of the kind, a plural in printable ASCII, for pw_hierarchy_notes(): "seams". Null: "marks" */
    /* edge_count x 2 vertices. A pair that is not an edge between two faces marks nothing. Where vertices coincide, as
     * at a UV seam, those of either side will do. */
    const int32_t *edges;
    /* edge_count numbers from 0 to 1; null: all are 1. 1: drawn on purpose, no part crosses the edge. Less: a hint that
     * the shape may overrule. Less than 0.5: nothing. */
    const float *strengths;
    size_t edge_count;
    /* 1: somebody chose these borders for this model, such as labels to make parts of, so they count however many they
     * are. 0: a kind that a machine made is ignored, see pw_build_options. */
    int32_t chosen;
    int32_t reserved; /* 0 */
} pw_marks;

/* pw_marks marks = PW_MARKS_INIT; then set the pointers and the count. */
#define PW_MARKS_INIT {sizeof(pw_marks), 0, 0, 0, 0, 0, 0}

typedef struct pw_build_options {
    size_t struct_size; /* sizeof(pw_build_options) */
    /* 0: no points are added inside the solid (the paper's choice; TetGen may still need a few to mesh it at all).
     * 1.1 or more: points are added inside until every tetrahedron's circumradius is at most this many times its
     * shortest edge, away from the surface, which never changes (the paper's Figure 9). 1.4 is usual. The points don't
     * change the parts, except in PW_MODE_PAPER. */
    double quality;
    /* The fill methods allowed: a sum of pw_fill_method; 0 means all. With PW_FILL_EXACT alone nothing is repaired, and
     * the status names what is wrong with the surface. */
    uint32_t fill_methods;
    /* 0: an open surface that is not meant as a solid (plane, cloth, leaf) is filled as a thin solid. 1: a mesh of
     * nothing but such sheets is refused with PW_ERROR_NOT_SOLID. */
    int32_t refuse_sheets;
    /* 0: as many threads as help. 1 or more: at most this many. One thread clusters; independent work, such as several
     * shells, is shared. The result is bit for bit the same for any number, also if the system starts no thread. */
    int32_t threads;
    /* A pw_mode; the first, 0, is the default. */
    int32_t mode;
    /* A mesh with more triangles than this is large: its parts are found on a proxy, a copy with a quarter of this
     * number of triangles, whose vertices are vertices of the mesh; each face gets the nearest part, see
     * pw_summary.proxy_triangles. This takes a fraction of the time and memory, and people agree with the parts as
     * much, because parts are features of the shape, not of its millionth face. A proxy has at least 100 triangles, and
     * more than a quarter if its topology needs them. 0: 200,000. With more than about 14,000 triangles around one
     * vertex (100 million + 32 n log2(n) pairs of triangles with a common vertex, n being the number of triangles) a
     * mesh is large, too. Negative: no mesh is large. The same holds for PW_MODE_PAPER, and for PW_FILL_EXACT alone. */
    int64_t exact_triangles;
    /* 0: if a shell has a double wall (an inner wall close behind the outer one, as generated meshes and hollow prints
     * have, perhaps with leaks between them), parts are found on the outer wall, and each inner face gets the part of
     * the outer face in front of it. 1: all walls count, as always in PW_MODE_PAPER. */
    int32_t keep_inner_walls;
    int32_t reserved; /* 0 */
    /* mark_count kinds of marked edges, one struct after the other; read during the call. Faces that are connected
     * without crossing a marked edge form a patch. A tetrahedron behind several patches is divided at its centroid, and
     * parts end at marks where the shape allows it. By marks of strength 1 alone: every patch is a wheel stop, and
     * every node lies within one patch or consists of whole ones. A kind that cuts the surface into small pieces all
     * over, as machines do (the islands of an atlas, all edges of triangulated CAD), is ignored unless it was chosen.
     * pw_hierarchy_notes() reports each kind. Marks that enclose no patch change nothing. PW_MODE_PAPER ignores all. */
    const pw_marks *marks;
    size_t mark_count;
} pw_build_options;

/* pw_build_options options = PW_BUILD_OPTIONS_INIT; the defaults. */
#define PW_BUILD_OPTIONS_INIT {sizeof(pw_build_options), 0, 0, 0, 0, PW_MODE_LEARNED, 0, 0, 0, 0, 0}

typedef struct pw_hierarchy pw_hierarchy;

/* Builds the hierarchy of a surface.
 *
 * context         may be null.
 * mesh            The longest side of its bounding box must be at least 1e-80. Vertices that no triangle uses are
 *                 allowed. A surface whose triangles are all oriented inward is turned around. Each source face must
 *                 have at least one triangle.
 * options         null: defaults.
 * hierarchy       receives a new handle, to be freed with pw_hierarchy_free.
 *
 * The mesh may be an assembly of shells: its connected components, after welding border edges that coincide, as
 * importers leave them at UV seams. A closed shell inside another one and oriented the other way is a cavity of it.
 * Every shell is filled on its own and is a subtree of the hierarchy; above, shells are joined by contact, small ones
 * first. No union is computed, so shells may intersect, touch or contain each other. A shell that is a copy of another
 * counts once, and one without area goes with what is nearest. More than 20,000 shells are refused with
 * PW_ERROR_NOT_SOLID. PW_MODE_PAPER takes any mesh as a whole.
 *
 * A shell that is closed, manifold, consistently oriented and free of self-intersection is used as it is: no vertex is
 * moved or added (PW_FILL_EXACT). It may have any number of cavities; a region is solid where the winding number of the
 * surface is not 0. For any other shell, the first of these works, as far as options->fill_methods allows: repair
 * (vertices that only touch are separated, noise is smoothed until it no longer intersects itself); tetrahedra of
 * points on the surface, of which those with a winding number above one half are kept, with their boundary as the
 * surface; for a sheet, a thickness of 1/200 of its diagonal, or less where it bends sharply. A shell that these points
 * leave by more than 0.03 of its diagonal, because part of it encloses nothing, counts as a sheet.
 * Duplicate faces count once and share a part, see pw_duplicate_faces. Walls inside a closed surface divide it into
 * cells. Faces that enclose nothing (walls with a hole, fins) are left out. Every source face gets the part of the
 * nearest point of the surface that was used: pw_summary and pw_hierarchy_notes() say what was done. The caller's mesh
 * never changes.
 *
 * The result does not depend on the order of the vertices or triangles, nor on the corner a triangle starts with. Any
 * number of threads may build at the same time.
 *
 * TetGen and CGAL have bugs, so a broken mesh may cause a crash or an endless loop. A program with unsaved work should
 * run builds in another process. */
PW_API pw_status pw_build(pw_context *context, const pw_mesh_view *mesh, const pw_build_options *options,
                          pw_hierarchy **hierarchy);

PW_API void pw_hierarchy_free(pw_hierarchy *hierarchy);

/* ---- The hierarchy's arrays ----------------------------------------------------------------------------------- */

/* The dendrogram (the tree pruned by the paper's Listing 2: see pw_mode) as flat arrays. All pointers belong to the
 * hierarchy and live as long as it does.
 *
 * Tetrahedra are in the depth-first order of the tree, and source faces are sorted by tetrahedron. So the tetrahedra of
 * a node, and its faces, are one contiguous slice of one array. A face belongs to the tetrahedron behind it, a polygon
 * to the one behind most of its area.
 *
 * Nodes: the leaves come first, and leaf i is tetrahedron i. Then come the other nodes, each after its children; the
 * root is the last. */
typedef struct pw_arrays {
    size_t struct_size;       /* sizeof(pw_arrays), set by the caller */
    size_t face_count;        /* F, source faces */
    size_t node_count;        /* N, nodes of the dendrogram */
    size_t tetrahedron_count; /* T, leaves */
    size_t vertex_count;      /* V, vertices of the tetrahedra */

    const int32_t *order;      /* (F,)   source faces, sorted by tetrahedron */
    const int32_t *leaf;       /* (F,)   the leaf of each source face */
    const int32_t *parent;     /* (N,)   -1 at the root */
    const int32_t *first;      /* (N,)   node n holds the faces order[first[n] : last[n]], possibly none */
    const int32_t *last;       /* (N,)   */
    const int32_t *tet_first;  /* (N,)   node n holds tetrahedra[tet_first[n] : tet_last[n]], at least one */
    const int32_t *tet_last;   /* (N,)   */
    const uint8_t *cost_class; /* (N,)   Eq. 3 of the paper: 0 convex, 1 not; 0 for leaves */
    const double *cost;        /* (N,)   Eq. 3: C2 (Eq. 2) in class 0, the concavity (Eq. 1) in class 1; 0 for leaves */
    const double *height;      /* (N,)   the node's place in the dendrogram: its concavity, 0 in class 0; of a scored
                                *         node at least that of its children. It never falls from child to parent; in
                                *         PW_MODE_PAPER (cost_class, cost) grows */
    const double *volume;      /* (N,)   of the node's tetrahedra */
    const double *area;        /* (N,)   of the node's source faces, duplicates once */
    const double *vertices;    /* (V,3)  the surface's, in a canonical order; then points that were added inside */
    const int32_t *source;     /* (V,)   the source vertex that each vertex is, unchanged; -1 for all others */
    const int32_t *tetrahedra; /* (T,4)  positively oriented: vertex 3 sees 0, 1, 2 counter-clockwise */
    const int32_t *merges;     /* (T-1,2) the unpruned binary tree, in the order of merging: merge m joins the two
                                *         clusters named, i < T being leaf i and T + j what merge j made */
    const double *score;       /* (N,)   the overlap expected with what people would take, 0..1; 0 below the parts that
                                *         merge by the policy, and for all nodes of PW_MODE_PAPER */
} pw_arrays;

/* pw_arrays arrays = PW_ARRAYS_INIT; ready to be filled. */
#define PW_ARRAYS_INIT {sizeof(pw_arrays), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}

PW_API pw_status pw_hierarchy_arrays(const pw_hierarchy *hierarchy, pw_arrays *arrays);

typedef struct pw_summary {
    size_t struct_size;    /* sizeof(pw_summary), set by the caller */
    size_t components;     /* parts of the solid that share no facet with each other */
    size_t cavities;       /* regions enclosed by the solid that are not part of it */
    size_t added_vertices; /* points that the mesher added inside */
    double volume;         /* of the solid */
    double hull_volume;    /* of its convex hull */
    pw_fill_method fill_method; /* how the surface was filled: the highest method of any shell; of a large mesh, how its
                              proxy was */
    double deviation;      /* the largest distance from the caller's surface to the one used, relative to the diagonal
                              of the caller's bounding box: 0 if it was used as it is, else measured at points of every
                              triangle about 1/100 of the diagonal apart, further if there were millions of them; of a
                              large mesh at its vertices. Parts of the caller's surface that lie inside the solid, such
                              as the back of an eye, count as well */
    size_t proxy_triangles; /* 0: the parts are those of the mesh itself. Else it is large, and they are those of a
                              proxy with so many triangles: see pw_build_options.exact_triangles */
    size_t shells;         /* of an assembly: connected components of the caller's mesh, with cavities, after welding
                              coincident border edges; each is a subtree. 1 in PW_MODE_PAPER */
    size_t sheets;         /* shells that were filled as thin solids */
} pw_summary;

/* pw_summary summary = PW_SUMMARY_INIT; ready to be filled. */
#define PW_SUMMARY_INIT {sizeof(pw_summary), 0, 0, 0, 0, 0, PW_FILL_EXACT, 0, 0, 0, 0}

PW_API pw_status pw_hierarchy_summary(const pw_hierarchy *hierarchy, pw_summary *summary);

/* Sentences (ASCII) on what was done to the surface and with marks; "" if nothing was. Owned by the hierarchy; "" if
 * that is null. */
PW_API const char *pw_hierarchy_notes(const pw_hierarchy *hierarchy);

/* ---- Queries -------------------------------------------------------------------------------------------------- */

/* Functions that fill an array of the caller take its capacity in elements, and set *count to the number required. If
 * the array is null and its capacity 0, they set *count alone and return PW_OK. If the array is too small, they return
 * PW_ERROR_CAPACITY, and set *count alone. */

/* The path of a source face: the nodes that contain it, from its leaf to the root. */
PW_API pw_status pw_hierarchy_path(const pw_hierarchy *hierarchy, size_t face, int32_t *nodes, size_t capacity,
                                   size_t *count);

/* The stops of the mouse wheel after a click on a source face: nodes of its path, growing, the last one the root.
 *
 * view: the length that fits into the smaller side of the view at the depth of the face. 0 or less, NaN or infinite:
 * not known.
 *
 * Each stop contains the face. The stop before it has at most 85 % of its area (of source faces), except before the
 * root; below the scored parts, at most half. In an assembly the face's shell is always a stop.
 *
 * start: index into nodes of the part that a click alone takes: the shell if it has less than a tenth of the whole
 * area, else the best score within the shell. In an assembly, that is a stop with at most half of the whole area, if
 * such a stop within the shell has at least 0.3 of the best score there; or a part made by hand. If the view is known:
 * of these stops, with at least 0.3 of their best score, the one with the largest
 *
 *     score - 0.6 (ln(extent / view) - ln 0.5)^2    (extent: the diagonal of its bounding box)
 *
 * because a part that someone means usually fills a tenth to a half of the view; the score of a small shell is 1. The
 * stops don't depend on the view. docs/decisions/fitted.md says how the constants were chosen.
 *
 * In PW_MODE_PAPER (the paper, section 4) the stops are the whole path, also nodes that add only tetrahedra inside,
 * with no face; and start is 0, whatever the view: the click takes the tetrahedron. */
PW_API pw_status pw_hierarchy_wheel(const pw_hierarchy *hierarchy, size_t face, double view, int32_t *nodes,
                                    size_t capacity, size_t *count, size_t *start);

/* A node's source faces: a slice of pw_arrays.order, owned by the hierarchy. */
PW_API pw_status pw_hierarchy_faces(const pw_hierarchy *hierarchy, size_t node, const int32_t **faces, size_t *count);

/* A cut divides the tetrahedra into parts, each a slice of pw_arrays.tetrahedra: part k holds
 * tetrahedra[bounds[k] : bounds[k+1]], bounds[0] = 0 and bounds[parts] = T. Below, bounds has room for capacity
 * elements and *count becomes parts + 1. */

/* The dendrogram cut by a horizontal line: the largest nodes of at most this height (the paper, section 3.2.3, where
 * the line is at a cost of 1 + height). A height of 0 gives the convex parts, an infinite one the whole. height: a
 * number >= 0. */
PW_API pw_status pw_hierarchy_cut_height(const pw_hierarchy *hierarchy, double height, int32_t *bounds,
                                         size_t capacity, size_t *count);

/* The cut of the unpruned tree into this many parts: the last parts - 1 merges undone. 1 <= parts <= min(T, 4096). */
PW_API pw_status pw_hierarchy_cut_parts(const pw_hierarchy *hierarchy, size_t parts, int32_t *bounds, size_t capacity,
                                        size_t *count);

/* The cut of the unpruned tree into this many parts whose total concavity is least: the best one for an approximation
 * by convex hulls. It goes beyond the paper, and is meant for the tree of PW_MODE_PAPER, which merges by concavity;
 * it takes O(T parts) time, and up to T parts / 12 + 100 T bytes of memory. 1 <= parts <= min(T, 4096). */
PW_API pw_status pw_hierarchy_cut_least_concavity(pw_context *context, const pw_hierarchy *hierarchy, size_t parts,
                                                  int32_t *bounds, size_t capacity, size_t *count);

/* The automatic segmentation: the cut of the dendrogram that maximizes the sum over all parts of area * score, minus
 * 0.5 % of the whole area for each part, which avoids tiny parts. In PW_MODE_PAPER, the cut at a height of 3 % of the
 * hull's volume, since the paper leaves the height to the user. */
PW_API pw_status pw_hierarchy_cut_automatic(const pw_hierarchy *hierarchy, int32_t *bounds, size_t capacity,
                                            size_t *count);

/* A triangle mesh that the library created. */
typedef struct pw_mesh pw_mesh;

/* The convex hull of tetrahedra[tet_first : tet_last], for a node or a part of a cut: closed, convex, outward. Its
 * vertices are exactly the extreme points. Free it with pw_mesh_free. */
PW_API pw_status pw_hierarchy_hull(pw_context *context, const pw_hierarchy *hierarchy, size_t tet_first,
                                   size_t tet_last, pw_mesh **mesh);

PW_API void pw_mesh_free(pw_mesh *mesh);

/* vertices: vertex_count x 3. triangles: triangle_count x 3 indices into them. All owned by the mesh. */
PW_API pw_status pw_mesh_arrays(const pw_mesh *mesh, const double **vertices, size_t *vertex_count,
                                const int32_t **triangles, size_t *triangle_count);

/* ---- Solids --------------------------------------------------------------------------------------------------- */

/* The closed surface around tetrahedra[tet_first : tet_last], a node or a part of a cut (the paper, section 4.2). It
 * consists of source triangles, and of caps, the facets between the part and the rest. It is closed, manifold and
 * oriented outward, and may have several components and cavities. Free it with pw_mesh_free.
 *
 * Polygons: a tetrahedron that has triangles of one polygon only goes with that polygon, as in pw_hierarchy_faces. So
 * polygons stay whole, and the solids of a cut contain each tetrahedron exactly once. If two polygons of different
 * parts share a tetrahedron, one of them is cut: each part gets the triangles of its own tetrahedra. If all polygons
 * are triangles, the volume is that of the slice's tetrahedra.
 *
 * Manifold: where tetrahedra of the part only touch, at a vertex or an edge, the surface is separated there: several of
 * its vertices have the same position. If they touch along an edge and are connected around both of its ends, the
 * triangles that face each other across the gap between them are joined there instead. No triangle is ever divided, so
 * the caps of a cut's solids match exactly.
 *
 * If the surface was not used as it is, this is the solid that replaced it, and caps have no face.
 * A wall between two cells is a triangle of both cells. In the cell that the wall's face is oriented away from, the
 * triangle has that face; in the other cell it has none.
 *
 * All tetrahedra except tetrahedra[a : b] are the slice that wraps around: tet_first = b, tet_last = a.
 * PW_ERROR_EMPTY: no tetrahedron is left, as of a part without faces. */
PW_API pw_status pw_hierarchy_solid(pw_context *context, const pw_hierarchy *hierarchy, size_t tet_first,
                                    size_t tet_last, pw_mesh **mesh);

/* The same around several disjoint slices, for parts that the user has merged. slices: slice_count x 2, the first
 * tetrahedron of each slice and the one after its last. Pieces that only touch are separate components. */
PW_API pw_status pw_hierarchy_solid_of_slices(pw_context *context, const pw_hierarchy *hierarchy,
                                              const int32_t *slices, size_t slice_count, pw_mesh **mesh);

/* The same for a part whose border was moved, as by pw_creases_snap. A tetrahedron behind the surface goes to the side
 * that has most of its source area; polygons that this divides are cut, as above. For tetrahedra deeper inside, near
 * those that change sides, a minimum cut decides, so that the caps have the least area.
 *
 * This never adds components: tetrahedra that would touch their new side only at a vertex or an edge stay on the old
 * side. So some faces near the border may be on the other side than inside says. If that were more area than without
 * the move, the border stays where it was.
 *
 * inside  face_count bytes, one for each source face: not 0 for faces of the part, also if the slice is all but the
 *         part. The solid of the other slice, with the same inside, is exactly the rest. */
PW_API pw_status pw_hierarchy_solid_of_faces(pw_context *context, const pw_hierarchy *hierarchy, size_t tet_first,
                                             size_t tet_last, const uint8_t *inside, size_t face_count,
                                             pw_mesh **mesh);

/* Where a solid's vertices and triangles come from; all owned by the mesh.
 *
 * vertices       vertex_count: the vertex of the hierarchy (pw_arrays.vertices).
 * faces          triangle_count: the source face of the triangle, or the nearest one if the surface was not used as it
 *                is; -1: none.
 * neighbor_tets  triangle_count: for a cap the tetrahedron on its other side; -1: a triangle of the surface. The solids
 *                on both sides have the cap with the same coordinates and opposite orientation. */
PW_API pw_status pw_mesh_origins(const pw_mesh *mesh, const int32_t **vertices, const int32_t **faces,
                                 const int32_t **neighbor_tets);

/* ---- Saving --------------------------------------------------------------------------------------------------- */

/* The hierarchy as bytes, the same on every machine. For capacity and *count, in bytes, see Queries. */
PW_API pw_status pw_hierarchy_save(pw_context *context, const pw_hierarchy *hierarchy, uint8_t *bytes,
                                   size_t capacity, size_t *count);

/* The number of the format that this library writes. It can't read later ones. */
PW_API int32_t pw_saved_format(void);

/* Loads a saved hierarchy. All bytes are checked. If they are damaged, truncated or not a saved hierarchy, or have a
 * newer format or one before 5, this returns PW_ERROR_DATA, and the message says which. Build the hierarchy again from
 * the mesh then. Later versions of the library will read formats 5 to 7. */
PW_API pw_status pw_hierarchy_load(pw_context *context, const uint8_t *bytes, size_t count, pw_hierarchy **hierarchy);

#ifdef __cplusplus
}
#endif

#endif
