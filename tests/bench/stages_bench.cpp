// Seconds of each stage of a build on real models, and their ratio to TetGen's in the same run.
//
//   cmake --preset bench && cmake --build --preset bench
//   build/bench/stages_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true
//
// Counters, per model: seconds of the stages by their names, `ratio` of clustering and dendrogram to the mesher, `tets`.
#include "hierarchy.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <fstream>
#include <string>
#include <vector>

namespace {

using namespace partwheel;

struct Model {
    std::vector<double> vertices;
    std::vector<int32_t> triangles;
};

// An OFF file of triangles.
Model read_off(const std::string& path) {
    std::ifstream in(path);
    std::string word;
    size_t vertices = 0, triangles = 0, edges = 0;
    in >> word >> vertices >> triangles >> edges;
    Model model;
    model.vertices.resize(3 * vertices);
    for (double& c : model.vertices) in >> c;
    for (size_t t = 0; t < triangles; ++t) {
        int corners = 0;
        int32_t a = 0, b = 0, c = 0;
        in >> corners >> a >> b >> c;
        std::getline(in, word);  // colours, in some files
        if (corners == 3) model.triangles.insert(model.triangles.end(), {a, b, c});
    }
    return model;
}

void build(benchmark::State& state, const std::string& name) {
    const Model model = read_off(std::string(PARTWHEEL_MESHES) + "/" + name + ".off");
    if (model.triangles.empty()) {
        state.SkipWithError("the model is not there");
        return;
    }
    const MeshView view{model.vertices.data(), model.vertices.size() / 3, model.triangles.data(),
                        model.triangles.size() / 3, nullptr, model.triangles.size() / 3};
    for (auto _ : state) {
        Progress progress;
        using Clock = std::chrono::steady_clock;
        auto then = Clock::now();
        const auto lap = [&] {
            const auto now = Clock::now();
            const double seconds = std::chrono::duration<double>(now - then).count();
            then = now;
            return seconds;
        };
        const Surface surface = check_surface(view, progress);
        const double surface_seconds = lap();
        const TetMesh mesh = tetrahedralize(surface, 0, progress);
        const double tetrahedra_seconds = lap();
        const BinaryTree tree = cluster(mesh, progress);
        const double cluster_seconds = lap();
        const std::vector<uint8_t> kept = prune(tree.merges);
        const double dendrogram_seconds = lap();
        const Hierarchy hierarchy(surface, mesh, tree, kept, model.vertices.data());
        benchmark::DoNotOptimize(hierarchy.save());
        const double hierarchy_seconds = lap();
        state.counters["surface"] = surface_seconds;
        state.counters["tetrahedra"] = tetrahedra_seconds;
        state.counters["cluster"] = cluster_seconds;
        state.counters["dendrogram"] = dendrogram_seconds;
        state.counters["hierarchy"] = hierarchy_seconds;
        state.counters["ratio"] = (cluster_seconds + dendrogram_seconds) / tetrahedra_seconds;
        state.counters["tets"] = static_cast<double>(mesh.tetrahedra.size());
    }
}

BENCHMARK_CAPTURE(build, hand, "hand")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, elephant, "elephant")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, refined_elephant, "refined_elephant")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, fandisk, "fandisk")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, turbine, "turbine")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, bear, "bear")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, armadillo, "armadillo")->Unit(benchmark::kMillisecond);

}  // namespace
