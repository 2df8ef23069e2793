// Work that falls into pieces which have nothing to do with each other, done by all cores.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

namespace partwheel {

// The caller's thread and others that help it, asleep in between. If the system gives no others the caller does it all.
class Threads {
public:
    // most: at most so many, the caller's included; 0: one a core. No more than there will be pieces.
    explicit Threads(size_t most = 0, size_t pieces = std::numeric_limits<size_t>::max());
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    size_t count() const { return helpers_.size() + 1; }

    // Calls task(first, last) for pieces of so many that make up 0 to count - 1, and returns when all are done. Which
    // thread does which is left open: if each writes what is its own, the result is the same for any number of threads.
    // If a task throws, later ones may not be called, and the caller gets what the first of those that throw throws.
    // Allocates nothing. Not for several callers at a time, nor from within a task.
    template <class Task>
    void parallel_for(size_t count, size_t piece, const Task& task) {
        share({[](const void* of, size_t first, size_t last) { (*static_cast<const Task*>(of))(first, last); }, &task,
               count, piece});
    }

private:
    struct Work {
        void (*call)(const void* task, size_t first, size_t last);
        const void* task;
        size_t count, piece;

        void do_piece(size_t first) const { call(task, first, count - first < piece ? count : first + piece); }
    };

    Threads(std::nullptr_t) {}
    void share(const Work& work);
    void take_pieces() noexcept;
    void help();

    std::mutex mutex_;  // guards what is not atomic, but for work_, which only changes while no helper is at work
    std::condition_variable offered_, done_;
    Work work_{};
    uint64_t round_ = 0;  // offers so far
    bool open_ = false;   // a helper may still begin with this one's
    bool ended_ = false;
    size_t busy_ = 0;  // helpers at work
    std::atomic<size_t> next_{0};
    std::exception_ptr error_;
    size_t error_at_ = 0;
    std::vector<std::thread> helpers_;
};

}  // namespace partwheel
