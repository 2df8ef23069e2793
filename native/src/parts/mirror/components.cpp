// Tetrahedra that hang together, by union-find; ways between them, breadth first.
#include "parts/mirror/components.h"

#include "base/adjacency.h"

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
            int32_t& best = largest[idx(part[t])];
            if (best < 0 || static_cast<float>(size[t]) > static_cast<float>(size[idx(best)])) best = static_cast<int32_t>(t);
        }
    }

    void join_around(const TetMesh& mesh, const std::vector<int32_t>& part, size_t t) {
        for (const int32_t n : mesh.neighbors[t])
            if (n >= 0 && part[t] >= 0 && part[idx(n)] == part[t]) sets.join(t, idx(n));
    }

    UnionFind sets;
    std::vector<double> size;      // of the first of each piece: its volume
    std::vector<int32_t> largest;  // of each part: the first of its largest piece
};

}  // namespace

void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& part) {
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
                for (const int32_t n : mesh.neighbors[idx(t)]) {
                    if (n < 0) continue;
                    if (part[idx(n)] == p && pieces.sets.find(idx(n)) != pieces.sets.find(piece)) {
                        for (int32_t step = t;; step = from[idx(step)]) {
                            const bool there = part[idx(step)] == p;
                            part[idx(step)] = p;
                            pieces.join_around(mesh, part, idx(step));
                            if (there) return;
                        }
                    }
                    if (part[idx(n)] != unassigned || reached[idx(n)] == searches) continue;
                    reached[idx(n)] = searches;
                    from[idx(n)] = t;
                    next.push_back(n);
                }
            layer.swap(next);
        }
    };
    for (int most = 1; most <= longest_way; ++most)
        for (size_t t = 0; t < part.size(); ++t)
            if (!of[t].empty() && pieces.sets.find(idx(pieces.largest[idx(part[t])])) != pieces.sets.find(t)) connect(t, most);
}

void keep_largest_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& part) {
    Pieces pieces(mesh, count, part);
    for (size_t t = 0; t < part.size(); ++t)
        if (part[t] >= 0 && idx(pieces.largest[idx(part[t])]) != pieces.sets.find(t)) part[t] = unassigned;
}

}  // namespace partwheel
