// What the benchmarks share: models from OFF files, stopwatches, memory.
#include "measured.h"

#include <malloc.h>

#include <ctime>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace partwheel::bench {

Model read_off(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw std::runtime_error(path + " can't be opened");
    std::string word;
    size_t vertices = 0, triangles = 0, edges = 0;
    in >> word >> vertices >> triangles >> edges;
    if (word != "OFF") throw std::runtime_error(path + " is not an OFF file");
    Model model;
    model.vertices.resize(3 * vertices);
    for (double& c : model.vertices) in >> c;
    model.triangles.reserve(3 * triangles);
    for (size_t t = 0; t < triangles; ++t) {
        int corners = 0;
        int32_t a = 0, b = 0, c = 0;
        in >> corners >> a >> b >> c;
        std::getline(in, word);  // colours, in some files
        if (corners != 3) throw std::runtime_error(path + " has faces that are no triangles");
        model.triangles.insert(model.triangles.end(), {a, b, c});
    }
    if (!in || model.triangles.empty()) throw std::runtime_error(path + " is cut short");
    return model;
}

namespace {

double clock_seconds(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

Seconds Seconds::now() { return {clock_seconds(CLOCK_MONOTONIC), clock_seconds(CLOCK_PROCESS_CPUTIME_ID)}; }

Seconds& Seconds::operator+=(const Seconds& more) {
    wall += more.wall;
    cpu += more.cpu;
    return *this;
}

Seconds Stopwatch::lap() {
    const Seconds now = Seconds::now(), gone = now - then_;
    then_ = now;
    return gone;
}

size_t peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        std::istringstream words(line);
        std::string key;
        size_t kilobytes = 0;
        if (words >> key >> kilobytes && key == "VmHWM:") return 1024 * kilobytes;
    }
    throw std::runtime_error("/proc/self/status has no VmHWM");
}

void reset_peak_memory() {
    std::ofstream clear("/proc/self/clear_refs");
    clear << "5" << std::flush;  // proc(5): the peak is set to what is held now
    if (!clear) throw std::runtime_error("/proc/self/clear_refs can't be written");
}

void keep_memory() {
    if (mallopt(M_MMAP_MAX, 0) == 0 || mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max()) == 0)
        throw std::runtime_error("the C library doesn't let memory be kept");
}

}  // namespace partwheel::bench
