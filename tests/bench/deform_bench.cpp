// What a mouse move costs while a part is deformed, through the C API, as JSON.
//
//   deform_bench MODEL.off SHARE MOVES ITERATIONS
//
// The part is what lies in the upper SHARE (0..1) of the model's longest side; its handle is the topmost tenth of it.
// The handle turns a little at each move, as under a mouse, and each move iterates so often. `create`: seconds,
// [wall, cpu]. `move`: the median and the longest, in seconds; `free`: how many vertices the system has.
#include "measured.h"
#include "partwheel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>

namespace {

using namespace partwheel::bench;

void require_ok(pw_status status) {
    if (status != PW_OK) throw std::runtime_error(pw_error_message());
}

// The model's vertices as fixed, free, and handle 0, by their place along its longest side.
std::vector<int32_t> roles(const Model& model, double share) {
    double low[3], high[3];
    for (size_t k = 0; k < 3; ++k) low[k] = high[k] = model.vertices[k];
    for (size_t i = 0; i < model.vertices.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], model.vertices[i]);
        high[i % 3] = std::max(high[i % 3], model.vertices[i]);
    }
    size_t axis = 0;
    for (size_t k = 1; k < 3; ++k)
        if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
    std::vector<int32_t> found;
    for (size_t v = 0; v < model.vertex_count(); ++v) {
        const double place = (high[axis] - model.vertices[3 * v + axis]) / (high[axis] - low[axis]);
        found.push_back(place > share ? PW_VERTEX_FIXED : place > share / 10 ? PW_VERTEX_FREE : 0);
    }
    return found;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 5) throw std::runtime_error("usage: deform_bench MODEL.off SHARE MOVES ITERATIONS");
        const Model model = read_off(argv[1]);
        const std::vector<int32_t> role = roles(model, std::stod(argv[2]));
        const size_t moves = std::stoul(argv[3]), iterations = std::stoul(argv[4]);
        Stopwatch watch;
        pw_deformation* made = nullptr;
        require_ok(pw_deformation_create(model.vertices.data(), model.vertex_count(), model.triangles.data(),
                                         model.triangle_count(), role.data(), &made));
        const std::unique_ptr<pw_deformation, void (*)(pw_deformation*)> deformation(made, pw_deformation_free);
        const Seconds create = watch.lap();
        std::vector<double> wall, cpu, positions(model.vertices.size());
        for (size_t i = 1; i <= moves; ++i) {
            const double angle = 0.5 * static_cast<double>(i) / static_cast<double>(moves);
            const double c = std::cos(angle), s = std::sin(angle);
            const double matrix[12] = {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0};
            watch.lap();
            require_ok(pw_deformation_move(made, 0, matrix));
            require_ok(pw_deformation_iterate(made, iterations));
            require_ok(pw_deformation_positions(made, positions.data(), model.vertex_count()));
            const Seconds seconds = watch.lap();
            wall.push_back(seconds.wall);
            cpu.push_back(seconds.cpu);
        }
        std::sort(wall.begin(), wall.end());
        std::sort(cpu.begin(), cpu.end());
        std::printf("{\"vertices\": %zu, \"free\": %zu, \"create\": [%.4f, %.4f], \"move\": {\"median\": %.5f, "
                    "\"longest\": %.5f, \"median_cpu\": %.5f}}\n",
                    model.vertex_count(), static_cast<size_t>(std::count(role.begin(), role.end(), PW_VERTEX_FREE)),
                    create.wall, create.cpu, wall[wall.size() / 2], wall.back(), cpu[cpu.size() / 2]);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
