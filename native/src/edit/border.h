// A part of a surface -> the same part with its border in the creases nearby: a minimum cut in a band around it.
#pragma once

#include "base/adjacency.h"
#include "mesh/surface.h"
#include "parts/snap/minimum_cut.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// A surface as its borders need it: its faces, and the edges between them. Made once, asked about any number of parts.
class Creases {
public:
    // face runs along the edge from begin to end; so does the face on its other side, if against.
    struct Neighbor {
        int32_t face, begin, end;
        bool against;
    };

    // Throws an Error.
    explicit Creases(const MeshView& mesh, Progress& progress = unwatched());

    size_t count() const { return center_.size(); }
    double area(size_t face) const { return area_[face]; }
    std::span<const Neighbor> around(size_t face) const { return neighbors_.with(face); }

    // The faces there alone: what goes over all of a surface is done in half the time.
    std::span<const int32_t> beside(size_t face) const { return beside_.with(face); }

    // From the middle of the edge to the centre of the face on either side.
    double to_middle(size_t face, const Neighbor& edge) const;

    // What the border costs along the edge.
    double cost(size_t face, const Neighbor& edge) const;

private:
    void measure(const MeshView& mesh);
    void join(const MeshView& mesh, Progress& progress);

    std::vector<Point> points_, center_, normal_;
    std::vector<double> area_;
    double volume_ = 0;
    bool inside_out_ = false;  // a closed surface that winds the wrong way
    CsrArray<Neighbor> neighbors_;
    CsrArray<int32_t> beside_;  // their faces
};

// The faces around a part's border that may change sides. All others keep theirs, and hold the band's together: every
// connected piece of the part, and of the rest, has some, and those are connected without the band's.
struct BorderBand : Cut {
    std::vector<int32_t> faces;  // the cut's nodes
};

// inside: of each face, not 0 if it is in the part. Throws an Error.
BorderBand border_band(const Creases& faces, std::span<const uint8_t> inside);

// As pw_creases_snap. Throws an Error.
void snapped_border(const Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result);

}  // namespace partwheel
