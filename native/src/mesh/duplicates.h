// Faces that are there several times: with the same corners, or a polygon and the smaller faces that it is made of.
#pragma once

#include "mesh/surface.h"

#include <string>

namespace partwheel {

// Of each source face the one that it is a duplicate of, or itself. Duplicates have the same outline, wherever it
// starts and whichever way it winds, with vertices at the same places; or are flat, and together they have the outline
// of one. Of equals the lowest is the original; of a polygon and smaller faces the polygon. Where two tessellations
// cover one flat region, the faces of one are duplicates of the nearest faces of the other.
std::vector<int32_t> find_duplicates(const Surface& source);

size_t count_duplicates(std::span<const int32_t> original);

// Adds a sentence to the notes for each count that is not 0.
void add_face_notes(const FaceCounts& counts, std::string& notes);

// The surface without them. Vertices of a duplicate and of its original that are at one place become one.
Surface without_duplicates(const Surface& source, std::span<const int32_t> original);

}  // namespace partwheel
