// Time and memory of each stage of a build, and of TetGen by itself, as JSON.
//
//   stages_bench MODEL.off [QUALITY]
//
// One line for a first run, and then one for each line that it is sent: so programs may take turns. A run takes every
// stage of pw_build from the model's arrays to the saved bytes in one thread, `solid` being the checks of the surface
// and its filling by TetGen, `hierarchy` with the paper's tree; then, beside that, it applies the merge policy, which
// the other mode of pw_build does. Seconds are [wall, cpu]. The first line has them as `first`, beside the model's
// sizes; its `peak` is the most memory in bytes that the process held during each stage, `start` what it held before.
// In the other runs memory is used again, so that they tell the program's time and not what the system takes to provide
// memory.
#include "cluster/cluster.h"
#include "fill/fill_solid.h"
#include "measured.h"
#include "tree/dendrogram.h"
#include "tree/hierarchy.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace partwheel;
using namespace partwheel::bench;

struct Stage {
    const char* name;
    Seconds seconds;
    size_t peak;
};

struct Run {
    std::vector<Stage> stages;
    TetgenWatch tetgen;
    size_t tets = 0, bytes = 0;
};

Run run(const Model& model, double quality) {
    const std::span vertices(reinterpret_cast<const Point*>(model.vertices.data()), model.vertex_count());
    const std::span triangles(reinterpret_cast<const Triangle*>(model.triangles.data()), model.triangle_count());
    const MeshView view{vertices, triangles, {}, model.triangle_count()};
    Run r;
    Progress progress;
    tetgen_watch() = {};
    const auto staged = [&](const char* name, auto stage) {
        reset_peak_memory();
        Stopwatch watch;
        auto result = stage();
        const Seconds seconds = watch.lap();
        r.stages.push_back({name, seconds, peak_memory()});
        return result;
    };
    const FillOptions options{.quality = quality, .fill_methods = PW_FILL_EXACT, .on_attempt = {}};
    const Solid solid = staged("solid", [&] { return fill_solid(view, options, progress); });
    const TetMesh& mesh = solid.mesh;
    const BinaryTree tree = staged("cluster", [&] { return cluster(mesh, progress, 1); });
    staged("dendrogram", [&] { return prune(tree.merges); });  // as Hierarchy does, once more
    const auto saved = staged("hierarchy", [&] {
        return Hierarchy(solid.surface, mesh, ScoredTree{tree, {}}, vertices).save();
    });
    staged("merge_policy", [&] { return merge_parts(mesh, tree, {}, progress); });
    r.tetgen = tetgen_watch();
    r.tets = mesh.tetrahedra.size();
    r.bytes = saved.size();
    return r;
}

void print(const Seconds& s) { std::printf("[%.6f, %.6f]", s.wall, s.cpu); }

void print(const Run& r) {
    std::printf("{\"tetgen\": ");
    print(r.tetgen.seconds);
    for (const Stage& stage : r.stages) {
        std::printf(", \"%s\": ", stage.name);
        print(stage.seconds);
    }
    std::printf("}");
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc < 2) throw std::runtime_error("usage: stages_bench MODEL.off [QUALITY]");
        const Model model = read_off(argv[1]);
        const double quality = argc > 2 ? std::stod(argv[2]) : 0;
        const size_t start = peak_memory();
        const Run first = run(model, quality);
        std::printf("{\"faces\": %zu, \"tets\": %zu, \"saved\": %zu, \"tetgen_calls\": %zu, "
                    "\"peak\": {\"start\": %zu, \"tetgen\": %zu",
                    model.triangle_count(), first.tets, first.bytes, first.tetgen.calls, start, first.tetgen.peak_memory);
        for (const Stage& stage : first.stages) std::printf(", \"%s\": %zu", stage.name, stage.peak);
        std::printf("}, \"first\": ");
        print(first);
        std::printf("}\n");
        keep_memory();
        for (std::string line; std::fflush(stdout), std::getline(std::cin, line);) {
            print(run(model, quality));
            std::printf("\n");
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
