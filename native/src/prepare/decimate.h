// Decimation of large surfaces: parts are features of the shape, not of its millionth face.
//
// Collapses edges, each into one of its ends, the cheapest first. The cost is the quadric error of Garland and Heckbert
// (1997), plus a little for the length of the edge, so that flat regions keep an even density. No collapse changes the
// topology or turns a triangle over. If too few triangles share edges to reach the target, as in a triangle soup, all
// vertices in each cell of a grid are merged first (vertex clustering). The vertices of the coarse surface are vertices
// of the source.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// The coarse surface: about `target` triangles, or more if its topology needs them. Triangle t of it is its face t.
struct Decimated {
    Surface surface;
    std::vector<FaceSample> samples;  // the source's, each with the nearest triangle of the coarse surface
    size_t face_count = 0;      // the source's
    double diagonal = 0;        // the source's
    double deviation = 0;       // see pw_summary; measured at the source's vertices
};

Decimated decimate(Surface source, size_t target, size_t threads, Progress& progress);

// `surface` was made from the coarse surface: replaces the triangles of the latter, which are its faces, by the
// source's faces, and adds a note.
void restore_source_faces(Decimated&& coarse, Surface& surface);

}  // namespace partwheel
