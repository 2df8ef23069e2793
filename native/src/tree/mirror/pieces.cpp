// Tetrahedra that hang together, by union-find; ways between them, breadth first.
#include "tree/mirror/pieces.h"

#include "base/groups.h"

#include <algorithm>

namespace partwheel {

namespace {

constexpr int longest_way = 12;  // tetrahedra between two pieces

struct Pieces {
    Pieces(const TetMesh& mesh, size_t count, const std::vector<int32_t>& part)
        : sets(part.size()), size(part.size(), 0), largest(count, -1) {
        for (size_t t = 0; t < part.size(); ++t) join_around(mesh, part, t);
        for (size_t t = 0; t < part.size(); ++t) size[sets.find(t)] += volume(mesh, t);
        for (size_t t = 0; t < part.size(); ++t) {
            if (part[t] < 0 || sets.find(t) != t) continue;
            int32_t& best = largest[at(part[t])];
            if (best < 0 || static_cast<float>(size[t]) > static_cast<float>(size[at(best)])) best = static_cast<int32_t>(t);
        }
    }

    void join_around(const TetMesh& mesh, const std::vector<int32_t>& part, size_t t) {
        for (const int32_t n : mesh.neighbours[t])
            if (n >= 0 && part[t] >= 0 && part[at(n)] == part[t]) sets.join(t, at(n));
    }

    Joined sets;
    std::vector<double> size;      // of the first of each piece: its volume
    std::vector<int32_t> largest;  // of each part: the first of its largest piece
};

}  // namespace

void connect_pieces(const TetMesh& mesh, size_t count, std::vector<int32_t>& part) {
    Pieces pieces(mesh, count, part);
    std::vector<std::vector<int32_t>> of(part.size());
    for (size_t t = 0; t < part.size(); ++t)
        if (part[t] >= 0) of[pieces.sets.find(t)].push_back(static_cast<int32_t>(t));
    std::vector<int32_t> reached(part.size(), -1), from(part.size(), -1);  // in which search; from where
    int32_t searches = 0;
    const auto connect = [&](size_t piece, int most) {
        ++searches;
        const int32_t p = part[piece];
        std::vector<int32_t> layer = of[piece], next;
        for (int length = 0; length <= most && !layer.empty(); ++length) {
            next.clear();
            for (const int32_t t : layer)
                for (const int32_t n : mesh.neighbours[at(t)]) {
                    if (n < 0) continue;
                    if (part[at(n)] == p && pieces.sets.find(at(n)) != pieces.sets.find(piece)) {
                        for (int32_t step = t;; step = from[at(step)]) {
                            const bool there = part[at(step)] == p;
                            part[at(step)] = p;
                            pieces.join_around(mesh, part, at(step));
                            if (there) return;
                        }
                    }
                    if (part[at(n)] != unsettled || reached[at(n)] == searches) continue;
                    reached[at(n)] = searches;
                    from[at(n)] = t;
                    next.push_back(n);
                }
            layer.swap(next);
        }
    };
    for (int most = 1; most <= longest_way; ++most)
        for (size_t t = 0; t < part.size(); ++t)
            if (!of[t].empty() && pieces.sets.find(at(pieces.largest[at(part[t])])) != pieces.sets.find(t)) connect(t, most);
}

void keep_largest_pieces(const TetMesh& mesh, size_t count, std::vector<int32_t>& part) {
    Pieces pieces(mesh, count, part);
    for (size_t t = 0; t < part.size(); ++t)
        if (part[t] >= 0 && at(pieces.largest[at(part[t])]) != pieces.sets.find(t)) part[t] = unsettled;
}

}  // namespace partwheel
