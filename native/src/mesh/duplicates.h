// Faces that are there several times: with the same corners, or a polygon and the smaller faces that it is made of.
#pragma once

#include "mesh/surface.h"

namespace partwheel {

// For each source face the face that it is a duplicate of, or itself. Faces are duplicates if their outlines have the
// same positions in the same cyclic order, in either direction; the lowest one is the original. Flat faces that together
// have the outline of a polygon are duplicates of that polygon. Where two tessellations cover one flat region, the faces
// of one are duplicates of the nearest faces of the other.
std::vector<int32_t> find_duplicates(const Surface& source);

size_t count_duplicates(std::span<const int32_t> original);

// Adds a sentence to the notes for each count that is not 0.
void add_face_notes(const FaceCounts& counts, std::string& notes);

// The surface without duplicates. Coincident vertices of a duplicate and its original are merged.
Surface without_duplicates(const Surface& source, std::span<const int32_t> original);

}  // namespace partwheel
