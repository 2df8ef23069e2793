// Finds components by union-find, and paths between them by breadth-first search.
#include "parts/mirror/components.h"

#include "base/adjacency.h"

namespace partwheel {

namespace {

constexpr int max_path_length = 12;  // in tetrahedra

// A component is identified by its root in `sets`, the lowest of its tetrahedra.
struct Components {
    Components(const TetMesh& mesh, size_t count, const std::vector<int32_t>& label)
        : sets(label.size()), component_volume(label.size(), 0), largest(count, -1) {
        for (size_t t = 0; t < label.size(); ++t) unite_with_neighbors(mesh, label, t);
        for (size_t t = 0; t < label.size(); ++t) component_volume[sets.find(t)] += volume(mesh, t);
        for (size_t t = 0; t < label.size(); ++t) {
            if (label[t] < 0 || sets.find(t) != t) continue;
            int32_t& best = largest[idx(label[t])];
            // As floats, so that volumes that differ by rounding are equal; the lowest root wins.
            if (best < 0 || static_cast<float>(component_volume[t]) > static_cast<float>(component_volume[idx(best)]))
                best = static_cast<int32_t>(t);
        }
    }

    void unite_with_neighbors(const TetMesh& mesh, const std::vector<int32_t>& label, size_t t) {
        for (const int32_t n : mesh.neighbors[t])
            if (n >= 0 && label[t] >= 0 && label[idx(n)] == label[t]) sets.unite(t, idx(n));
    }

    UnionFind sets;
    std::vector<double> component_volume;  // indexed by root
    std::vector<int32_t> largest;          // indexed by part: the root of its largest component
};

}  // namespace

void connect_components(const TetMesh& mesh, size_t count, std::vector<int32_t>& label) {
    Components components(mesh, count, label);
    std::vector<std::vector<int32_t>> members(label.size());  // indexed by root: the component's tetrahedra
    for (size_t t = 0; t < label.size(); ++t)
        if (label[t] >= 0) members[components.sets.find(t)].push_back(static_cast<int32_t>(t));
    // For each tetrahedron: the last search that reached it, and the one before it on that search's path.
    std::vector<int32_t> last_search(label.size(), -1), predecessor(label.size(), -1);
    int32_t search = 0;

    // Searches from a component through unlabeled tetrahedra for another component of the same part, and adds the
    // path to the part.
    const auto connect = [&](size_t root, int max_length) {
        ++search;
        const int32_t part = label[root];
        std::vector<int32_t> layer = members[root], next;
        for (int length = 0; length <= max_length && !layer.empty(); ++length) {
            next.clear();
            for (const int32_t t : layer)
                for (const int32_t n : mesh.neighbors[idx(t)]) {
                    if (n < 0) continue;
                    if (label[idx(n)] == part && components.sets.find(idx(n)) != components.sets.find(root)) {
                        for (int32_t on_path = t;; on_path = predecessor[idx(on_path)]) {
                            const bool is_start = label[idx(on_path)] == part;
                            label[idx(on_path)] = part;
                            components.unite_with_neighbors(mesh, label, idx(on_path));
                            if (is_start) return;
                        }
                    }
                    if (label[idx(n)] != unlabeled || last_search[idx(n)] == search) continue;
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
        if (label[t] >= 0 && idx(components.largest[idx(label[t])]) != components.sets.find(t)) label[t] = unlabeled;
}

}  // namespace partwheel
