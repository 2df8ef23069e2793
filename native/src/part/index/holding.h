// Which body of an index holds a point: by the exact side-of-plane test.
#pragma once

#include "base/predicates.h"
#include "part/index/part_index.h"

#include <algorithm>

namespace partwheel {

// Calls visit for each side, outwards, until one says no; whether none did.
template <class Visit>
bool PartIndex::sides_of(int32_t body, const Visit& visit) const {
    if (tetrahedra_.empty())
        return std::all_of(sides_.begin() + side_begin_[at(body)], sides_.begin() + side_begin_[at(body + 1)], visit);
    for (size_t k = 0; k < 4; ++k)
        if (!visit(facet(tetrahedra_[at(body)], k))) return false;
    return true;
}

// near: what p is in, in the frame. place: of a vertex, where p is given. turned: places are mirrored.
template <class Place>
int32_t PartIndex::holding(const Point& p, const Box& near, bool turned, const Place& place) const {
    int32_t lowest = -1;
    const auto look = [&](const auto& self, int32_t child, int32_t count) -> void {
        if (count > 0) {
            for (auto i = at(child); i < at(child + count); ++i) {
                const int32_t body = bodies_.order[i];
                if (lowest >= 0 && lowest < body) continue;
                const bool inside = sides_of(body, [&](const Triangle& t) {
                    const int side = orientation(place(t[0]), place(t[1]), place(t[2]), p);
                    return turned ? side >= 0 : side <= 0;
                });
                if (inside) lowest = body;
            }
            return;
        }
        const index::Node& node = bodies_.nodes[at(child)];
        for (size_t side = 0; side < 2; ++side) {
            bool in = true;
            for (size_t k = 0; k < 3; ++k) in &= node.low[k][side] <= near.high[k] && near.low[k] <= node.high[k][side];
            if (in) self(self, node.child[side], node.count[side]);
        }
    };
    const Box& all = bodies_.root.box;
    for (size_t k = 0; k < 3; ++k)
        if (near.low[k] > all.high[k] || near.high[k] < all.low[k]) return -1;
    look(look, bodies_.root.child, bodies_.root.count);
    return lowest;
}

}  // namespace partwheel
