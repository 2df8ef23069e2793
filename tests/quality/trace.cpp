// What fit.py fits to: the measures of all pairs and nodes that merge_parts() meets in saved hierarchies of mode paper.
//
//   quality_trace NUMBERS OUT_DIR HIERARCHY...
//
// NUMBERS: a text file of the pair cost's numbers to use instead of the library's own, or "-". Writes
// OUT_DIR/<name>.trace for each file <name>.hierarchy: five int32 counts (faces, parts, pairs, merges, nodes); then the
// part of each source face (int32), the pairs and the merges (two int32 each), the measures of the pairs and those of
// the nodes (float64).
#include "tree/hierarchy.h"
#include "parts/merge/merge_policy.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

using namespace partwheel;

namespace {

// A saved hierarchy as the build had it. Its tree is the paper's but for the order of the tetrahedra.
struct Built {
    TetMesh mesh;
    BinaryTree tree;
};

Built built(const Hierarchy& hierarchy) {
    const pw_arrays a = hierarchy.arrays();
    Built b;
    const auto* points = reinterpret_cast<const Point*>(a.vertices);
    const Frame frame = Frame::around({points, a.vertex_count});
    for (size_t v = 0; v < a.vertex_count; ++v) b.mesh.vertices.push_back(frame.to_working(points[v]));
    const auto* tetrahedra = reinterpret_cast<const Tetrahedron*>(a.tetrahedra);
    b.mesh.tetrahedra.assign(tetrahedra, tetrahedra + a.tetrahedron_count);
    b.tree.components = hierarchy.summary().components;
    b.tree.merges.assign(hierarchy.merges().begin(), hierarchy.merges().end());
    const double unit = frame.volume_to_caller(1);
    for (Merge& m : b.tree.merges) {
        m.concavity /= unit;
        m.hull_volume /= unit;
    }

    struct Side {
        Triangle corners;
        size_t tetrahedron, opposite;
    };
    std::vector<Side> sides;
    for (size_t t = 0; t < a.tetrahedron_count; ++t)
        for (size_t k = 0; k < 4; ++k) {
            Triangle corners{};
            for (size_t i = 0, n = 0; i < 4; ++i)
                if (i != k) corners[n++] = tetrahedra[t][i];
            std::sort(corners.begin(), corners.end());
            sides.push_back({corners, t, k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
        return std::tie(x.corners, x.tetrahedron) < std::tie(y.corners, y.tetrahedron);
    });
    b.mesh.neighbors.assign(a.tetrahedron_count, {-1, -1, -1, -1});
    for (size_t i = 0; i + 1 < sides.size(); ++i) {
        const Side &x = sides[i], &y = sides[i + 1];
        if (x.corners != y.corners) continue;
        b.mesh.neighbors[x.tetrahedron][x.opposite] = static_cast<int32_t>(y.tetrahedron);
        b.mesh.neighbors[y.tetrahedron][y.opposite] = static_cast<int32_t>(x.tetrahedron);
    }
    return b;
}

template <class T>
void put(std::ofstream& out, const T* values, size_t count) {
    out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

void trace(const std::filesystem::path& path, const std::vector<double>& numbers,
           const std::filesystem::path& out_dir) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const Hierarchy hierarchy = Hierarchy::load({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    const Built b = built(hierarchy);
    Progress progress;
    progress.begin();
    MergeTrace merge_trace;
    merge_parts(b.mesh, b.tree, {}, progress, numbers, &merge_trace);
    const pw_arrays a = hierarchy.arrays();
    const std::array<int32_t, 4> counts = {
        static_cast<int32_t>(a.face_count), static_cast<int32_t>(merge_trace.first.count),
        static_cast<int32_t>(merge_trace.last.count), static_cast<int32_t>(merge_trace.pairs.size())};
    std::ofstream out(out_dir / path.stem().concat(".trace"), std::ios::binary);
    put(out, counts.data(), counts.size());
    for (const PartTree* tree : {&merge_trace.first, &merge_trace.last}) {
        std::vector<int32_t> part_of_face;
        for (size_t f = 0; f < a.face_count; ++f)
            part_of_face.push_back(tree->label[static_cast<size_t>(a.leaf[f])]);
        put(out, part_of_face.data(), part_of_face.size());
        put(out, tree->children.data(), tree->children.size());
    }
    for (const auto& pair : merge_trace.pairs) put(out, std::array{pair.a, pair.b}.data(), 2);
    for (const auto& pair : merge_trace.pairs) put(out, pair.features.data(), pair.features.size());
    put(out, merge_trace.nodes.data(), merge_trace.nodes.size());
    if (!out.flush()) throw std::runtime_error("can't write to " + out_dir.string());
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 3) throw std::runtime_error("usage: quality_trace NUMBERS|- OUT_DIR HIERARCHY...");
        std::vector<double> numbers;
        if (std::string(argv[1]) != "-") {
            std::ifstream in(argv[1]);
            numbers.assign(std::istream_iterator<double>(in), {});
            if (numbers.size() % (pair_feature_count + 2) != 1)
                throw std::runtime_error(std::string(argv[1]) + " does not hold the numbers of a pair cost");
        }
        for (int i = 3; i < argc; ++i) trace(argv[i], numbers, argv[2]);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
