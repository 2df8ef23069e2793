// What the benchmarks share: models from OFF files, stopwatches, memory, and TetGen watched by itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace partwheel::bench {

struct Model {
    std::vector<double> vertices;    // x, y, z of each
    std::vector<int32_t> triangles;  // 3 indices of each

    size_t vertex_count() const { return vertices.size() / 3; }
    size_t triangle_count() const { return triangles.size() / 3; }
};

// An OFF file of triangles. Throws std::runtime_error, naming the file.
Model read_off(const std::string& path);

// Seconds that have gone by, and seconds of this process on any core: the same where one thread has a core for itself,
// but the latter hardly change when others use the machine.
struct Seconds {
    double wall = 0, cpu = 0;

    static Seconds now();
    Seconds operator-(const Seconds& then) const { return {wall - then.wall, cpu - then.cpu}; }
    Seconds& operator+=(const Seconds& more);
};

// Seconds since it was made or last asked.
class Stopwatch {
public:
    Seconds lap();

private:
    Seconds then_ = Seconds::now();
};

// The most memory this process has held (VmHWM), in bytes, since it started or since the last reset.
size_t peak_memory();
void reset_peak_memory();

// From now on this process keeps the memory that it frees and uses that again. A virtual machine may give memory that
// lies free for a moment back to its host, and the next use of that takes up to 25 times as long (5 ms for 2 MB): a cost
// of the machine, not of the program, which hits whoever comes first.
void keep_memory();

// TetGen's own call, without the library's preparation of its input and reading of its output. A program that sees
// these is linked so that the call goes through a function of ours: see tetgen_watch.cpp.
struct TetgenWatch {
    Seconds seconds;         // of all calls since the last reset
    size_t calls = 0;        // more than one: TetGen failed and was tried again
    size_t peak_memory = 0;  // of the process, when the last call returned
};
TetgenWatch& tetgen_watch();

}  // namespace partwheel::bench
