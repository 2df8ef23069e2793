// A part of a surface -> the same part with its border in the creases nearby: a minimum cut in a band around it.
#pragma once

#include "base/groups.h"
#include "surface/surface.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace partwheel {

// A surface as its borders need it: its faces, and the edges between them. Made once, asked about any number of parts.
class Creases {
public:
    // face runs along the edge from begin to end; so does the face on its other side, if against.
    struct Neighbour {
        int32_t face, begin, end;
        bool against;
    };

    // Throws an Error.
    explicit Creases(const MeshView& mesh);

    size_t count() const { return centre_.size(); }
    double area(size_t face) const { return area_[face]; }
    std::span<const Neighbour> around(size_t face) const { return neighbours_.with(face); }

    // The faces there alone: what goes over all of a surface is done in half the time.
    std::span<const int32_t> beside(size_t face) const { return beside_.with(face); }

    // From the middle of the edge to the centre of the face on either side.
    double to_middle(size_t face, const Neighbour& edge) const;

    // What the border costs along the edge.
    double cost(size_t face, const Neighbour& edge) const;

private:
    void measure(const MeshView& mesh);
    void join(const MeshView& mesh);

    std::vector<Point> points_, centre_, normal_;
    std::vector<double> area_;
    double volume_ = 0;
    bool inside_out_ = false;  // a closed surface that winds the wrong way
    Grouped<Neighbour> neighbours_;
    Grouped<int32_t> beside_;  // their faces
};

// Two faces of the band share an edge; what it costs to have the border there.
struct BandEdge {
    int32_t one, other;  // indices into BorderBand::faces
    int64_t cost;        // > 0
};

// The faces around a part's border that may change sides. All others keep theirs, and hold the band's together: every
// connected piece of the part, and of the rest, has some, and those are connected without the band's.
struct BorderBand {
    std::vector<int32_t> faces;
    std::vector<BandEdge> edges;
    std::vector<int64_t> to_part, to_rest;  // of each face: the cost of its edges with what stays in the part, the rest
};

// inside: of each face, not 0 if it is in the part. Throws an Error.
BorderBand border_band(const Creases& faces, std::span<const uint8_t> inside);

// Of each face of the band 1 if it belongs to the part, 0 to the rest, such that the sum of the costs between the two
// is least; of several such parts the smallest, which is one whatever the order of faces and edges.
std::vector<uint8_t> minimum_cut(const BorderBand& band);

// As pw_creases_snap. Throws an Error.
void snapped_border(const Creases& creases, std::span<const uint8_t> inside, std::span<uint8_t> result);

}  // namespace partwheel
