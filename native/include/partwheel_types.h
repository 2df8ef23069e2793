/* Statuses, stages and fill methods, for partwheel.h and all source files of the library. A header of its own, so that a
 * new function in partwheel.h doesn't recompile everything. Include partwheel.h. */
#ifndef PARTWHEEL_TYPES_H
#define PARTWHEEL_TYPES_H

/* Largest number of vertices, triangles, faces, edges or tetrahedra in one call or hierarchy: an int32_t can number four
 * things of each, as a tetrahedron's corners. A mesh that takes more than 2^29 - 16 tetrahedra is refused with
 * PW_ERROR_MEMORY. */
#define PW_MAX_COUNT 500000000

typedef enum pw_status {
    PW_OK = 0,
    PW_ERROR_ARGUMENT = 1,          /* a null pointer, a size or an option outside what the function documents */
    PW_ERROR_EMPTY = 2,             /* no vertices or no triangles */
    PW_ERROR_NOT_FINITE = 3,        /* a coordinate is NaN or infinite, or the model too large or small to be measured */
    PW_ERROR_INDEX = 4,             /* a triangle refers to a vertex or a face that does not exist */
    PW_ERROR_DEGENERATE = 5,        /* a triangle without area: repeated corners, or corners on one line */
    PW_ERROR_OPEN = 6,              /* an edge with a triangle on one side only: the surface encloses nothing */
    PW_ERROR_NON_MANIFOLD = 7,      /* an edge of three or more triangles, or a vertex where sheets only touch */
    PW_ERROR_ORIENTATION = 8,       /* two neighboring triangles wind against each other */
    PW_ERROR_SELF_INTERSECTION = 9, /* triangles meet elsewhere than at the vertices and edges they share */
    PW_ERROR_NO_VOLUME = 10,        /* the surface is closed but encloses no volume */
    PW_ERROR_TETRAHEDRA = 11,       /* the mesher failed on a surface that passed every check */
    PW_ERROR_CANCELED = 12,         /* pw_context_cancel() was called */
    PW_ERROR_MEMORY = 13,           /* out of memory */
    PW_ERROR_DATA = 14,             /* bytes that are not a saved hierarchy, or a damaged or newer one */
    PW_ERROR_INTERNAL = 15,         /* a bug of ours, please report it */
    PW_ERROR_NOT_SOLID = 16,        /* a sheet, not a solid: plane, cloth, car door; see pw_build_options */
    PW_ERROR_CAPACITY = 17          /* the array to fill is too small; the count needed has been written */
} pw_status;

/* The types of a mesh's numbers: see pw_mesh_view. */
typedef enum pw_vertex_type { PW_DOUBLE = 0, PW_FLOAT = 1 } pw_vertex_type;
typedef enum pw_index_type { PW_INT32 = 0, PW_UINT32 = 1, PW_INT64 = 2 } pw_index_type;

/* The stages of a build, in their order. */
typedef enum pw_stage {
    PW_STAGE_SURFACE = 0,    /* checks of the input; of a large mesh also its proxy */
    PW_STAGE_REPAIR = 1,     /* repair; skipped in no time if the surface is clean */
    PW_STAGE_TETRAHEDRA = 2, /* TetGen, or Delaunay tetrahedra and winding numbers; a second time without noise or
                              * added points, if the parts are found there */
    PW_STAGE_CLUSTER = 3,    /* Listing 1 of the paper */
    PW_STAGE_DENDROGRAM = 4, /* but for PW_MODE_PAPER: symmetry, the networks that join parts, borders moved to creases;
                              * and a second clustering, if the parts were found in other tetrahedra */
    PW_STAGE_HIERARCHY = 5,  /* Listing 2 of the paper, flat arrays */
    PW_STAGE_COUNT = 6
} pw_stage;

/* How a surface is filled with tetrahedra, from the best way down. A build takes the first that works. */
typedef enum pw_fill_method {
    PW_FILL_EXACT = 1,    /* the surface as it is: closed, manifold, oriented, free of self-intersection */
    PW_FILL_REPAIRED = 2, /* stitched, oriented, holes filled, overlaps united; most vertices are the caller's */
    PW_FILL_POINTS = 4,   /* Delaunay tetrahedra of points on the surface, those that it winds around */
    PW_FILL_SHEET = 8     /* a sheet (plane, cloth, leaf) as a thin solid: a prism behind each triangle */
} pw_fill_method;

#endif
