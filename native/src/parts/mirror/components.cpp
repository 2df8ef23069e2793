// Components by union-find; paths between them by breadth-first search.
#include "parts/mirror/components.h"

#include "base/adjacency.h"

#include <algorithm>

namespace partwheel {

namespace {

constexpr int max_path_length = 12;  // tetrahedra between two components

// Each component is known by the lowest of its tetrahedra, its root.
struct Components {
    Components(const TetMesh& mesh, size_t count, const std::vector<int32_t>& label)
        : sets(label.size()), size(label.size(), 0), largest(count, -1) {
        for (size_t t = 0; t < label.size(); ++t) unite_with_neighbors(mesh, label, t);
        for (size_t t = 0; t < label.size(); ++t) size[sets.find(t)] += volume(mesh, t);
        for (size_t t = 0; t < label.size(); ++t) {
            if (label[t] < 0 || sets.find(t) != t) continue;
            int32_t& best = largest[idx(label[t])];
            if (best < 0 || static_cast<float>(size[t]) > static_cast<float>(size[idx(best)]))
                best = static_cast<int32_t>(t);
        }
    }

    void unite_with_neighbors(const TetMesh& mesh, const std::vector<int32_t>& label, size_t t) {
        for (const int32_t n : mesh.neighbors[t])
            if (n >= 0 && label[t] >= 0 && label[idx(n)] == label[t]) sets.unite(t, idx(n));
    }

    UnionFind sets;
    std::vector<double> size;      // volume, at the root of each component
    std::vector<int32_t> largest;  // the root of the largest component of each part
};

}  // namespace

void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label) {
    Components components(mesh, count, label);
    std::vector<std::vector<int32_t>> members(label.size());  // of each component, at its root
    for (size_t t = 0; t < label.size(); ++t)
        if (label[t] >= 0) members[components.sets.find(t)].push_back(static_cast<int32_t>(t));
    std::vector<int32_t> last_search(label.size(), -1), predecessor(label.size(), -1);  // that reached the tetrahedron
    int32_t search = 0;
    const auto connect = [&](size_t root, int max_length) {
        ++search;
        const int32_t p = label[root];
        std::vector<int32_t> layer = members[root], next;
        for (int length = 0; length <= max_length && !layer.empty(); ++length) {
            next.clear();
            for (const int32_t t : layer)
                for (const int32_t n : mesh.neighbors[idx(t)]) {
                    if (n < 0) continue;
                    if (label[idx(n)] == p && components.sets.find(idx(n)) != components.sets.find(root)) {
                        for (int32_t step = t;; step = predecessor[idx(step)]) {
                            const bool is_start = label[idx(step)] == p;
                            label[idx(step)] = p;
                            components.unite_with_neighbors(mesh, label, idx(step));
                            if (is_start) return;
                        }
                    }
                    if (label[idx(n)] != unassigned || last_search[idx(n)] == search) continue;
                    last_search[idx(n)] = search;
                    predecessor[idx(n)] = t;
                    next.push_back(n);
                }
            layer.swap(next);
        }
    };
    for (int max_length = 1; max_length <= max_path_length; ++max_length)
        for (size_t t = 0; t < label.size(); ++t)
            if (!members[t].empty() &&
                components.sets.find(idx(components.largest[idx(label[t])])) != components.sets.find(t))
                connect(t, max_length);
}

void keep_largest_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label) {
    Components components(mesh, count, label);
    for (size_t t = 0; t < label.size(); ++t)
        if (label[t] >= 0 && idx(components.largest[idx(label[t])]) != components.sets.find(t)) label[t] = unassigned;
}

}  // namespace partwheel
