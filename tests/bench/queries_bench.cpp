// What a user waits for on a finished hierarchy, through the C API, as JSON.
//
//   queries_bench MODEL.off CLICKS
//
// `path`, `wheel` (what a click needs) and `faces` (of a node that the wheel stops at): the median and the longest
// processor time of so many clicks on faces drawn at random. `build`, `save`, `load`: seconds, [wall, cpu].
#include "measured.h"
#include "partwheel.h"
#include "support/mesh_view.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <random>
#include <stdexcept>

namespace {

using namespace partwheel::bench;

void require_ok(pw_status status) {
    if (status != PW_OK) throw std::runtime_error(pw_error_message());
}

using Handle = std::unique_ptr<pw_hierarchy, void (*)(pw_hierarchy*)>;

Handle build(const Model& model) {
    pw_hierarchy* made = nullptr;
    const pw_mesh_view mesh = partwheel::test::mesh_view(model.vertices.data(), model.vertex_count(),
                                                         model.triangles.data(), model.triangle_count());
    require_ok(pw_build(nullptr, &mesh, nullptr, &made));
    return {made, pw_hierarchy_free};
}

std::vector<uint8_t> save(const Handle& hierarchy) {
    size_t count = 0;
    require_ok(pw_hierarchy_save(nullptr, hierarchy.get(), nullptr, 0, &count));
    std::vector<uint8_t> bytes(count);
    require_ok(pw_hierarchy_save(nullptr, hierarchy.get(), bytes.data(), count, &count));
    return bytes;
}

Handle load(const std::vector<uint8_t>& bytes) {
    pw_hierarchy* made = nullptr;
    require_ok(pw_hierarchy_load(nullptr, bytes.data(), bytes.size(), &made));
    return {made, pw_hierarchy_free};
}

void print(const char* name, const Seconds& s) { std::printf(", \"%s\": [%.6f, %.6f]", name, s.wall, s.cpu); }

void print(const char* name, std::vector<double> seconds) {
    std::sort(seconds.begin(), seconds.end());
    std::printf(", \"%s\": {\"median\": %.9f, \"longest\": %.9f}", name, seconds[seconds.size() / 2], seconds.back());
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 3) throw std::runtime_error("usage: queries_bench MODEL.off CLICKS");
        const Model model = read_off(argv[1]);
        const auto clicks = std::stoul(argv[2]);
        Stopwatch watch;
        Handle hierarchy = build(model);
        const Seconds build_seconds = watch.lap();
        const std::vector<uint8_t> bytes = save(hierarchy);
        const Seconds save_seconds = watch.lap();
        hierarchy.reset();
        watch.lap();
        hierarchy = load(bytes);
        const Seconds load_seconds = watch.lap();

        std::mt19937_64 random(1);
        std::vector<double> path_seconds, wheel_seconds, faces_seconds;
        std::vector<int32_t> nodes;
        for (size_t i = 0; i < clicks; ++i) {
            const size_t face = random() % model.triangle_count();
            size_t count = 0, start = 0;
            Stopwatch query;
            require_ok(pw_hierarchy_path(hierarchy.get(), face, nullptr, 0, &count));
            nodes.resize(count);
            require_ok(pw_hierarchy_path(hierarchy.get(), face, nodes.data(), count, &count));
            path_seconds.push_back(query.lap().cpu);
            require_ok(pw_hierarchy_wheel(hierarchy.get(), face, 0, nodes.data(), nodes.size(), &count, &start));
            wheel_seconds.push_back(query.lap().cpu);
            if (count > nodes.size()) throw std::runtime_error("a wheel with more stops than the path has nodes");
            const auto node = static_cast<size_t>(nodes[random() % count]);
            const int32_t* faces = nullptr;
            query.lap();
            require_ok(pw_hierarchy_faces(hierarchy.get(), node, &faces, &count));
            faces_seconds.push_back(query.lap().cpu);
        }
        std::printf("{\"faces\": %zu, \"saved\": %zu", model.triangle_count(), bytes.size());
        print("build", build_seconds);
        print("save", save_seconds);
        print("load", load_seconds);
        print("path", path_seconds);
        print("wheel", wheel_seconds);
        print("node_faces", faces_seconds);
        std::printf("}\n");
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
