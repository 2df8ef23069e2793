// A large surface made coarser, for parts are features of the shape and not of its millionth face.
//
// Edges are collapsed, each into one of its ends, cheapest first: by the quadrics of Garland and Heckbert (1997), which
// tell how far from the surface a vertex would be, and a little by the way that it goes, so that what is flat stays evenly
// covered. What is closed stays closed: no collapse changes what is joined with what, or turns a triangle over. Where so
// little is joined that this comes to no end, as in a soup of triangles, the vertices in each cell of a grid are united
// first. Vertices stay where they are: those of the coarse surface are the source's.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// A copy of some `target` triangles, or more where its topology needs so many. Its pieces are those of an exact surface
// whose faces are its triangles.
struct Decimated {
    Surface surface;
    std::vector<Piece> pieces;  // the source's, with the triangle of the copy that each is near
    size_t face_count = 0;      // the source's
    double diagonal = 0;        // likewise
    double deviation = 0;       // see pw_summary; at the source's vertices
};

Decimated decimate(Surface source, size_t target, size_t threads, Progress& progress);

// Gives a surface that was made from the copy the source's faces in place of the copy's triangles, and the account.
void restore_source_faces(Decimated&& coarse, Surface& surface);

}  // namespace partwheel
