// What a mouse move costs while a part is deformed, through the C API, as JSON.
//
//   deform_bench MODEL.off AXIS COUNT MOVES ITERATIONS
//
// The part is the COUNT vertices that lie highest along AXIS (0, 1, 2), its handle the highest tenth of them; all
// others stay. The handle turns a little at each move, as under a mouse, and each move iterates so often. `create`:
// seconds, [wall, cpu]. `move`: the median and the longest, in seconds of wall clock, and the median of processor time.
#include "measured.h"
#include "partwheel_edit.h"
#include "support/mesh_view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace {

using namespace partwheel::bench;

void require_ok(pw_status status) {
    if (status != PW_OK) throw std::runtime_error(pw_error_message());
}

// The model's vertices as fixed, free, and handle 0, by their place along an axis.
std::vector<int32_t> roles(const Model& model, size_t axis, size_t count) {
    std::vector<size_t> order(model.vertex_count());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
        return model.vertices[3 * a + axis] > model.vertices[3 * b + axis];
    });
    std::vector<int32_t> found(order.size());
    for (size_t i = 0; i < order.size(); ++i)
        found[order[i]] = i < count / 10 ? 0 : i < count ? PW_VERTEX_FREE : PW_VERTEX_FIXED;
    return found;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 6) throw std::runtime_error("usage: deform_bench MODEL.off AXIS COUNT MOVES ITERATIONS");
        const Model model = read_off(argv[1]);
        const size_t axis = std::stoul(argv[2]), count = std::stoul(argv[3]);
        if (axis > 2) throw std::runtime_error("AXIS must be 0, 1 or 2");
        const std::vector<int32_t> role = roles(model, axis, count);
        const size_t moves = std::stoul(argv[4]), iterations = std::stoul(argv[5]);
        Stopwatch watch;
        pw_deformation* made = nullptr;
        const pw_mesh_view mesh = partwheel::test::mesh_view(model.vertices.data(), model.vertex_count(),
                                                             model.triangles.data(), model.triangle_count());
        require_ok(pw_deformation_create(nullptr, &mesh, role.data(), 0, &made));
        const std::unique_ptr<pw_deformation, void (*)(pw_deformation*)> deformation(made, pw_deformation_free);
        const Seconds create = watch.lap();
        std::vector<double> wall, cpu, positions(model.vertices.size());
        for (size_t i = 1; i <= moves; ++i) {
            const double angle = 0.5 * static_cast<double>(i) / static_cast<double>(moves);
            const double c = std::cos(angle), s = std::sin(angle);
            const double matrix[12] = {c, -s, 0, 0, s, c, 0, 0, 0, 0, 1, 0};
            watch.lap();
            require_ok(pw_deformation_move(made, 0, matrix));
            require_ok(pw_deformation_iterate(nullptr, made, iterations));
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
