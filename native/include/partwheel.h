/* Partwheel's C API: a triangle mesh in, a hierarchy of its nearly convex parts out. What edits a mesh with such parts is
 * in partwheel_edit.h.
 *
 * The method is "Hierarchical Convex Approximation of 3D Shapes for Fast Region Selection" (Attene, Mortara,
 * Spagnuolo, Falcidieno 2008), called "the paper" below.
 *
 * Habits, true of every function unless its own comment says otherwise:
 *  - It returns a pw_status; results come through pointers, which are written only when it returns PW_OK. The one
 *    exception is the count of PW_ERROR_CAPACITY.
 *  - On any other status pw_error_message() says, to the calling thread, what went wrong and what to do about it.
 *  - No C++ exception, exit() or abort() of ours leaves it.
 *  - Handles are opaque, made by one function and ended by the matching _free; _free(NULL) does nothing.
 *  - Lengths are in the unit of the caller's coordinates, volumes in that unit cubed. Coordinates are doubles (x, y, z).
 *  - A pw_hierarchy never changes once made: any number of threads may ask it questions at the same time.
 *  - Buffers handed in are only read, and only during the call.
 *  - A function that can take more than 100 ms for a mesh of some 350,000 triangles takes a pw_context, which may be null.
 *  - A null array goes with a count of 0. More than PW_MAX_COUNT vertices, triangles and the like are refused with
 *    PW_ERROR_ARGUMENT before anything is read; only the capacity of an array to be filled may be any number.
 *  - Every struct begins with struct_size, and may get more members at its end in later versions. The caller sets
 *    struct_size to the struct's sizeof before the call, also where the call fills the struct. So program and library may
 *    be of different versions: an option that an older program does not know is 0, its default, and a result is left
 *    out; an option that is newer than the library must be 0, else PW_ERROR_ARGUMENT, and a result becomes 0.
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

/* The version that a program is compiled for; and as a number that grows, to be compared by the preprocessor. */
#define PW_VERSION "0.1.0"
#define PW_VERSION_MAJOR 0
#define PW_VERSION_MINOR 1
#define PW_VERSION_PATCH 0
#define PW_VERSION_NUMBER (PW_VERSION_MAJOR * 10000 + PW_VERSION_MINOR * 100 + PW_VERSION_PATCH)

/* The version of the library that is there, "major.minor.patch". Never null; owned by the library. */
PW_API const char *pw_version(void);

/* The same as PW_VERSION_NUMBER counts. */
PW_API int32_t pw_version_number(void);

/* A status in one or two words, lower case, stable ("self-intersection"). Never null; owned by the library. */
PW_API const char *pw_status_name(pw_status status);

/* The name of a stage ("tetrahedra"). Never null; owned by the library. */
PW_API const char *pw_stage_name(pw_stage stage);

/* What went wrong in the calling thread's last call that did not return PW_OK: sentences a user can act on, UTF-8.
 * Never null ("" if nothing did); owned by the library, valid until the thread's next failing call. */
PW_API const char *pw_error_message(void);

/* Where in the caller's mesh the same call found what it refused, so that a program can select it. */
typedef struct pw_error_info {
    size_t struct_size;  /* sizeof(pw_error_info), set by the caller */
    int64_t faces[2];    /* source faces: the first one that is wrong; both that intersect. -1: none */
    int64_t vertices[2]; /* a vertex that is wrong, or both ends of an edge. -1: none */
    int64_t triangle;    /* a triangle that names a vertex or a face that does not exist. -1: none */
} pw_error_info;

/* pw_error_info info = PW_ERROR_INFO_INIT; ready to be filled. */
#define PW_ERROR_INFO_INIT {sizeof(pw_error_info), {-1, -1}, {-1, -1}, -1}

/* Indices are those of the arrays that the call was given. Leaves what pw_error_message() says as it is, unless it fails
 * itself. */
PW_API pw_status pw_error_details(pw_error_info *info);

/* ---- Meshes --------------------------------------------------------------------------------------------------- */

/* A triangle mesh in the caller's memory. Initialize it with PW_MESH_VIEW_INIT, then set the pointers and counts.
 *
 * vertices      vertex_count x 3 coordinates of vertex_type, at most 1e100 in size.
 * triangles     triangle_count x 3 vertex indices of index_type, counter-clockwise seen from outside.
 * faces         triangle_count indices of index_type, or null. The triangles of a polygon (a source face) carry its
 *               index, 0 <= index < face_count. Null: every triangle is a face of its own, and face_count is
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

/* Progress, cancellation and timing of one call at a time: of a build, or of any other function that takes one. Every
 * pw_context function may be called from any thread while that call runs, except pw_context_free. */
typedef struct pw_context pw_context;

PW_API pw_status pw_context_create(pw_context **context);
PW_API void pw_context_free(pw_context *context);

/* Asks the running call (or, if none runs, the next one) to stop with PW_ERROR_CANCELED. A build honors it within
 * 100 ms in every stage; beyond some 200,000 faces within a time in proportion, as arrays are sorted whole. Other calls
 * honor it between their steps, the longest of which is the factorization of pw_deformation_create and pw_fair_vertices. */
PW_API pw_status pw_context_cancel(pw_context *context);

/* fraction: 0..1 of the whole call, never falling during it. stage: where a build is; of other calls it means nothing.
 * Either may be null. */
PW_API pw_status pw_context_progress(const pw_context *context, double *fraction, pw_stage *stage);

/* The fill method that the running build tries, or that the last one tried last; PW_FILL_EXACT before the first. */
PW_API pw_status pw_context_fill_method(const pw_context *context, pw_fill_method *fill_method);

/* Wall-clock seconds that each stage of the last build took, a failed stage included, 0 for stages not reached.
 * seconds: PW_STAGE_COUNT doubles. */
PW_API pw_status pw_context_seconds(const pw_context *context, double *seconds);

/* ---- Building ------------------------------------------------------------------------------------------------- */

/* Which tree is built. */
typedef enum pw_mode {
    PW_MODE_LEARNED = 0, /* the paper's below some 600 parts, which are joined by what people take for one part */
    PW_MODE_PAPER = 1      /* the paper's in every step */
} pw_mode;

/* What the default, PW_MODE_LEARNED, does otherwise than the paper, and why:
 *  - The top of the tree joins parts in the order that people would, and each of its nodes has a score: concavity alone
 *    joins a leg's halves late and a cup's handle early.
 *  - The borders of parts lie in the creases of the surface nearby, where people end a part.
 *  - What is its own mirror image (95 % of the surface, to 1 % of its size) has the same parts on both sides, those of
 *    the side where they score better. Rounding coordinates may then change which of two triangles is the other's image.
 *  - Listing 2 prunes below that by concavity alone. By Eq. 3 convex nodes within convex nodes stay, since C2 grows;
 *    but where C2 has them divided is no feature of the shape. The nodes of the top all stay.
 *  - A click takes the path's best score, and the wheel stops only where more can be seen. The paper's click takes the
 *    tetrahedron, and each notch the next node of the path.
 *  - Points that were added inside, and noise, leave the parts as they are without. */

/* Marked edges of one kind: something besides the shape divides the surface there, such as a border of materials. */
typedef struct pw_marks {
    size_t struct_size; /* sizeof(pw_marks) */
    const char *name;   /* of the kind, a plural in printable ASCII, for pw_hierarchy_notes(): "seams". Null: "marks" */
    /* edge_count x 2 vertices. A pair that is not an edge between two faces marks nothing. Where vertices coincide, as at
     * a UV seam, those of either side will do. */
    const int32_t *edges;
    /* edge_count numbers from 0 to 1; null: all are 1. 1: drawn on purpose, no part crosses the edge. Less: a hint that the
     * shape may overrule. Less than 0.5: nothing. */
    const float *strengths;
    size_t edge_count;
} pw_marks;

typedef struct pw_build_options {
    size_t struct_size; /* sizeof(pw_build_options) */
    /* 0: no points are added inside the solid (the paper's choice; TetGen may still need a few to mesh it at all).
     * 1.1 or more: points are added inside until every tetrahedron's circumradius is at most this many times its
     * shortest edge, away from the surface, which never changes (the paper's Figure 9). 1.4 is usual. But for
     * PW_MODE_PAPER the parts are those that the solid has without such points. */
    double quality;
    /* The fill methods allowed: a sum of pw_fill_method; 0 means all. With PW_FILL_EXACT alone nothing is repaired, and
     * the status names what is wrong with the surface. */
    uint32_t fill_methods;
    /* 0: an open surface that is not meant as a solid (plane, cloth, leaf) is filled as a thin solid. 1: a mesh of nothing
     * but such sheets is refused with PW_ERROR_NOT_SOLID. */
    int32_t refuse_sheets;
    /* 0: as many threads as help. 1 or more: at most so many. One clusters; others share only what falls into pieces that
     * have nothing to do with each other. The result is the same, bit for bit, also where the system starts none. */
    int32_t threads;
    /* A pw_mode; the first, 0, is the default. */
    int32_t mode;
    /* A mesh of more triangles than this is large: its parts are found on a copy with a quarter of this number, a proxy,
     * whose vertices are vertices of the mesh, and each face goes with the part that it is near: see
     * pw_summary.proxy_triangles. Parts are features of the shape and not of its millionth face, so people agree with them
     * as well; it takes a fraction of the time and memory. A proxy has at least 100 triangles, and more than a quarter
     * where its topology needs them. 0: 200,000.
     * Negative: no mesh is large, all are used exactly; so it is with PW_MODE_PAPER, and with PW_FILL_EXACT alone. */
    int64_t exact_triangles;
    /* 0: if a shell has a double wall (an inner wall close behind the outer one, as generated meshes and hollow prints have,
     * perhaps with leaks between them), parts are found on the outer wall, and each inner face goes with the outer face in
     * front of it. 1: all walls count. So it is in PW_MODE_PAPER. */
    int32_t keep_inner_walls;
    int32_t reserved; /* 0 */
    /* mark_count kinds of marked edges, one struct after the other; read during the call. Faces that are connected without
     * crossing a marked edge form a patch. A tetrahedron behind several patches is divided at its centroid, and parts end at
     * marks where the shape allows it. By marks of strength 1 alone: every patch is a wheel stop, and every node lies within
     * one patch or consists of whole ones. A kind that cuts the surface into small pieces all over, as machines do (the
     * islands of an atlas, all edges of triangulated CAD), is ignored. pw_hierarchy_notes() reports each kind. Marks that
     * enclose no patch change nothing. PW_MODE_PAPER ignores all. */
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
 *                 allowed. A surface whose triangles all wind the other way is accepted and taken as it was meant. Each
 *                 source face must have at least one triangle.
 * options         null: defaults.
 * hierarchy       receives a new handle, to be freed with pw_hierarchy_free.
 *
 * The mesh may be an assembly of shells: its connected components, after welding border edges that coincide, as importers
 * leave them at UV seams. A closed shell inside another one and oriented the other way is a cavity of it. Every shell is
 * filled on its own and is a subtree of the hierarchy; above, shells are joined by contact, small ones first. No union is
 * computed, so shells may intersect, touch or contain each other. A shell that is a copy of another counts once, and one
 * without area goes with what is nearest. More than 20,000 shells are refused with PW_ERROR_NOT_SOLID. PW_MODE_PAPER takes
 * any mesh as a whole.
 *
 * A shell that is closed, manifold, consistently oriented and free of self-intersection is used as it is: no vertex
 * is moved and none is added to it (PW_FILL_EXACT). Any number of cavities is fine; a region is solid
 * where the winding number of the surface about it is not 0. Any other shell is repaired (where only vertices touch,
 * these are set apart; where it is rough all over, as with noise, it is smoothed until it no longer passes through
 * itself); or else tetrahedra are made of points on it, and those kept that it winds around, whose boundary is then the
 * surface used; or else, if it is a sheet, it gets a thickness of 1/200 of its diagonal, or less where it bends more
 * sharply: as options->fill_methods allows. Faces that are duplicates of others count once and go with them, see
 * pw_duplicate_faces; walls inside a closed surface cut it apart into cells; of its faces, those that enclose nothing
 * (walls with a hole, fins) are left out. Every source face goes with the part of the surface used that is nearest to
 * it: pw_summary and pw_hierarchy_notes() say what was done. The caller's mesh is never changed.
 *
 * The result does not depend on the order of the vertices or triangles, nor on the corner a triangle starts with. Any
 * thread may build; several at once take turns in TetGen, which keeps global state.
 *
 * TetGen and CGAL have bugs of their own, that a broken mesh may find: a crash or a loop without end can't be excluded.
 * Whoever has unsaved work in memory runs builds in another process. */
PW_API pw_status pw_build(pw_context *context, const pw_mesh_view *mesh, const pw_build_options *options,
                          pw_hierarchy **hierarchy);

PW_API void pw_hierarchy_free(pw_hierarchy *hierarchy);

/* ---- The hierarchy's arrays ----------------------------------------------------------------------------------- */

/* The dendrogram (the tree pruned by the paper's Listing 2: see pw_mode) as flat arrays. All pointers belong to the
 * hierarchy and live as long as it does.
 *
 * Tetrahedra stand in the depth-first order of the tree, source faces sorted by their tetrahedron; so every node's
 * tetrahedra, and its faces, are one contiguous slice of one array. A face belongs to the tetrahedron behind it; a
 * polygon whose triangles have different tetrahedra to the one behind most of its area.
 *
 * Nodes: the leaves come first, leaf i being tetrahedron i; then the others, each after its children; the root is
 * the last. */
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
    pw_fill_method fill_method; /* how the surface was filled, of an assembly the last method that a shell took; of a large
                              mesh its proxy */
    double deviation;      /* the largest distance from the caller's surface to the one used, relative to the diagonal
                              of the caller's bounding box: 0 if it was used as it is, else measured at points of every
                              triangle about 1/100 of the diagonal apart, further if there were millions of them; of a
                              large mesh at its vertices. Parts of the caller's surface that lie inside the solid, such as
                              the back of an eye, count as well */
    size_t proxy_triangles; /* 0: the parts are those of the mesh itself. Else it is large, and they are those of a
                              proxy with so many triangles: see pw_build_options.exact_triangles */
    size_t shells;         /* of an assembly: connected components of the caller's mesh, with cavities, after welding
                              coincident border edges; each is a subtree. 1 in PW_MODE_PAPER */
    size_t sheets;         /* shells that were filled as thin solids */
} pw_summary;

/* pw_summary summary = PW_SUMMARY_INIT; ready to be filled. */
#define PW_SUMMARY_INIT {sizeof(pw_summary), 0, 0, 0, 0, 0, PW_FILL_EXACT, 0, 0, 0, 0}

PW_API pw_status pw_hierarchy_summary(const pw_hierarchy *hierarchy, pw_summary *summary);

/* What was done to the surface and with marks, in sentences (ASCII); "" if nothing was. Owned by the hierarchy; "" if that is
 * null. */
PW_API const char *pw_hierarchy_notes(const pw_hierarchy *hierarchy);

/* ---- Questions ------------------------------------------------------------------------------------------------ */

/* Functions that fill a caller's array take its capacity in elements and set *count to the number needed. A null array
 * with a capacity of 0 asks for *count alone and gives PW_OK. An array that is too small gives PW_ERROR_CAPACITY: *count
 * is set, and nothing else is written. */

/* The nodes that hold a source face, from its leaf up to the root. */
PW_API pw_status pw_hierarchy_path(const pw_hierarchy *hierarchy, size_t face, int32_t *nodes, size_t capacity,
                                   size_t *count);

/* The stops of the mouse wheel after a click on a source face: nodes of its path, growing, the last one the root.
 *
 * view: how much of the model the user sees, a length: what fits into the smaller side of the view at the depth of the
 * face. 0 or less, NaN or infinite: not known.
 *
 * Each stop holds the face, and the one before has at most 85 % of its area (of source faces), the last perhaps more; below
 * the parts that are scored at most half. In an assembly the face's shell is always a stop.
 * start: index into nodes of the part that a click alone takes: the shell if it has less than a tenth of the whole area,
 * else the best score within the shell. If the view is known, the stop within the shell with the largest
 *
 *     score - 0.6 (ln(extent / view) - ln 0.5)^2    (extent: the diagonal of its bounding box)
 *
 * because a part that someone means usually fills a tenth to a half of the view; the score of a small shell is 1. The
 * stops don't depend on the view. docs/selection.md says how the constants were chosen.
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

/* Of all cuts of the unpruned tree into this many parts the one whose parts have the least concavity in total: what
 * suits approximation by convex hulls. Beyond the paper, and meant for the tree of PW_MODE_PAPER, which is made for
 * convexity; it takes O(T parts) time, and up to T parts / 12 + 100 T bytes of memory. 1 <= parts <= min(T, 4096). */
PW_API pw_status pw_hierarchy_cut_least_concavity(pw_context *context, const pw_hierarchy *hierarchy, size_t parts,
                                                  int32_t *bounds, size_t capacity, size_t *count);

/* The parts that people would most likely divide the whole into: the cut of the dendrogram with the largest sum of area
 * times score, less half a hundredth of the whole area for each part, so that there are no scraps between them; or, in
 * PW_MODE_PAPER, that at a height of 3 % of the hull's volume: the paper leaves the height to the user. */
PW_API pw_status pw_hierarchy_cut_automatic(const pw_hierarchy *hierarchy, int32_t *bounds, size_t capacity,
                                            size_t *count);

/* A triangle mesh that the library made. */
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

/* The closed surface around tetrahedra[tet_first : tet_last], for a node or a part of a cut (the paper, section 4.2):
 * triangles of the source, and caps, the facets inside the solid that divide the part from the rest. Closed, manifold
 * and outward; it may have several components and cavities. Free it with pw_mesh_free.
 *
 * Polygons: where a tetrahedron has nothing on the surface but triangles of one polygon, it goes with that polygon,
 * as pw_hierarchy_faces does; so polygons stay whole, and the solids of a cut have each tetrahedron exactly once. Where
 * two polygons of different parts have one tetrahedron behind them, one of them is cut: each part has the triangles of
 * its own tetrahedra. Where all polygons are triangles, the volume is that of the slice's tetrahedra.
 *
 * Manifold: where tetrahedra of the part only touch, at a vertex or an edge, the surface is cut apart there, so that
 * several of its vertices stand at one place. Where they touch along an edge and are joined about both of its ends,
 * no such cut is possible: two edges run beside each other, and one of them has a vertex in its middle.
 *
 * If the surface was not used as it is, this is the solid that was made from it, and caps have no face.
 * A wall between two cells is a triangle of the surface on both sides: on the side that the wall's face looks away from it
 * has that face, on the other none.
 *
 * middles  middle_count x 2, or null: edges, as two vertices of the hierarchy, that get a vertex in the middle wherever
 *          they are on the surface. The solids of a cut whose caps are to match exactly are made twice: the second time
 *          with all edges in whose middle any of them had a vertex the first time, see pw_mesh_origins.
 *
 * The rest without tetrahedra[a : b] is the slice that goes on at the start: tet_first = b, tet_last = a.
 * PW_ERROR_EMPTY: no tetrahedron is left, which happens to a part that has no faces. */
PW_API pw_status pw_hierarchy_solid(pw_context *context, const pw_hierarchy *hierarchy, size_t tet_first,
                                    size_t tet_last, const int32_t *middles, size_t middle_count, pw_mesh **mesh);

/* The same around several slices together, for parts that were joined by hand: slice_count x 2 tetrahedra, the first of
 * each slice and the one after its last, none within another. Pieces that only touch are several components. */
PW_API pw_status pw_hierarchy_solid_of_slices(pw_context *context, const pw_hierarchy *hierarchy,
                                              const int32_t *slices, size_t slice_count, const int32_t *middles,
                                              size_t middle_count, pw_mesh **mesh);

/* The same for a part whose faces are others than its own, as after pw_creases_snap. Tetrahedra behind the surface go
 * with the faces that most of their area there is of: the others of such a face are cut, as above. Which of those inside
 * go with them, near the ones that change sides, is decided by a minimum cut, so that the caps have the least area.
 *
 * Nothing falls into more pieces by that: what would only touch the others, at a vertex or an edge, stays with them, and
 * some faces near the border may so be on the other side than inside says; fewer of the area than without, or the part is
 * its own.
 *
 * inside  face_count bytes, one for each source face: not 0 for those of the part, also where the slice is the rest.
 *         With the two exchanged, the rest is all that the part leaves. */
PW_API pw_status pw_hierarchy_solid_of_faces(pw_context *context, const pw_hierarchy *hierarchy, size_t tet_first,
                                             size_t tet_last, const uint8_t *inside, size_t face_count,
                                             pw_mesh **mesh);

/* Where a solid's vertices and triangles come from; all owned by the mesh.
 *
 * ends    vertex_count x 2: the vertex of the hierarchy (pw_arrays.vertices) that each vertex is, twice; or, for one in
 *         the middle of an edge, the ends of the edge.
 * faces   triangle_count: the source face that the triangle is a triangle of, or if the surface was not used as it is, that
 *         is nearest to it; -1: none.
 * beyond  triangle_count: for a cap the tetrahedron on its other side; -1: a triangle of the surface. The solids on
 *         both sides of a cap have it with the same coordinates, turned; one may have it cut at an edge's middle,
 *         unless both were given the same middles. */
PW_API pw_status pw_mesh_origins(const pw_mesh *mesh, const int32_t **ends, const int32_t **faces,
                                 const int32_t **beyond);

/* ---- Saving --------------------------------------------------------------------------------------------------- */

/* The hierarchy as bytes, the same on every machine. The same rule for capacity and *count (bytes here) as above. */
PW_API pw_status pw_hierarchy_save(pw_context *context, const pw_hierarchy *hierarchy, uint8_t *bytes,
                                   size_t capacity, size_t *count);

/* A hierarchy from such bytes. Nothing in them is trusted: whatever is damaged, cut short or foreign gives
 * PW_ERROR_DATA; so do bytes of a newer format, or of one before format 5, and the message says which: build again from
 * the mesh then. Later versions of the library read this version's format, 7, and 5 and 6. */
PW_API pw_status pw_hierarchy_load(pw_context *context, const uint8_t *bytes, size_t count, pw_hierarchy **hierarchy);

#ifdef __cplusplus
}
#endif

#endif
