/* What partwheel.h's functions and all the source files behind them share: statuses, stages, rungs. A header of its own
 * so that a new function does not have everything compiled again; include partwheel.h. */
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
    PW_ERROR_INDEX = 4,             /* a triangle names a vertex or a face that does not exist */
    PW_ERROR_DEGENERATE = 5,        /* a triangle without area: repeated corners, or corners on one line */
    PW_ERROR_OPEN = 6,              /* an edge with a triangle on one side only: the surface encloses nothing */
    PW_ERROR_NON_MANIFOLD = 7,      /* an edge of three or more triangles, or a vertex where sheets only touch */
    PW_ERROR_ORIENTATION = 8,       /* two neighbouring triangles wind against each other */
    PW_ERROR_SELF_INTERSECTION = 9, /* triangles meet elsewhere than at the vertices and edges they share */
    PW_ERROR_NO_VOLUME = 10,        /* the surface is closed but encloses no volume */
    PW_ERROR_TETRAHEDRA = 11,       /* the mesher failed on a surface that passed every check */
    PW_ERROR_CANCELLED = 12,        /* pw_context_cancel() was called */
    PW_ERROR_MEMORY = 13,           /* out of memory */
    PW_ERROR_DATA = 14,             /* bytes that are not a saved hierarchy, or a damaged or newer one */
    PW_ERROR_INTERNAL = 15,         /* a bug of ours, please report it */
    PW_ERROR_NOT_SOLID = 16         /* a sheet, not a solid: plane, cloth, car door; see pw_build_options */
} pw_status;

/* The stages of a build, in their order; each is a source file of the library. */
typedef enum pw_stage {
    PW_STAGE_SURFACE = 0,    /* checks of the input */
    PW_STAGE_REPAIR = 1,     /* mending or repairing it; passed over in no time if it is clean */
    PW_STAGE_TETRAHEDRA = 2, /* TetGen */
    PW_STAGE_CLUSTER = 3,    /* Listing 1 of the paper */
    PW_STAGE_DENDROGRAM = 4, /* Listing 2 of the paper */
    PW_STAGE_HIERARCHY = 5,  /* flat arrays */
    PW_STAGE_COUNT = 6
} pw_stage;

/* The ways to a surface that can be filled, from the best one down. A build takes the first that works. */
typedef enum pw_rung {
    PW_RUNG_EXACT = 1,    /* the caller's surface as it is: closed, manifold, oriented, free of self-intersection */
    PW_RUNG_REPAIRED = 2, /* stitched, oriented, holes filled, overlaps united; most vertices are the caller's */
    PW_RUNG_POINTS = 4,   /* not at all: filled from points on it, inside where it winds around them */
    PW_RUNG_COARSE = 8    /* a coarser copy of a large mesh: one of the above, see pw_build_options.exact_triangles */
} pw_rung;

#endif
