// A second thread that takes its share of many small tasks.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>

namespace partwheel {

// What each of two threads writes to is so far from what the other does: two cache lines, for they are fetched in pairs.
inline constexpr size_t apart = 128;

class PairOfThreads {
public:
    PairOfThreads();  // throws std::system_error if the system gives no thread
    ~PairOfThreads();
    PairOfThreads(const PairOfThreads&) = delete;
    PairOfThreads& operator=(const PairOfThreads&) = delete;

    // Calls task(i, thread) once for each i < count, thread being 0 (the caller's) or 1, and returns when all are done.
    // A second thread that is slow to begin is not waited for. If a task throws, some others may not be called.
    void share(size_t count, const std::function<void(size_t, size_t)>& task);

    // Whether the second thread has been there when there was work for two: on a crowded machine it often isn't, and
    // one thread is then faster than two that wait for each other.
    bool pays() const;

private:
    using Clock = std::chrono::steady_clock;

    enum State : uint32_t { idle, offered, taken, ended };

    void work(size_t thread) noexcept;
    void wait_for_second();
    Clock::duration second_has_run();
    void serve();

    std::atomic<uint32_t> state_{idle};
    std::atomic<size_t> next_{0};
    size_t count_ = 0;
    const std::function<void(size_t, size_t)>* task_ = nullptr;
    std::array<std::exception_ptr, 2> errors_;
    const Clock::time_point made_ = Clock::now();
    Clock::duration alone_{};  // how long the caller had work for two, or waited, and the second thread was not running
    std::thread second_;  // last, so that all else is there when it begins
};

// Calls task(i) once for each i from first to last - 1: by two threads, each in a half of these, or by one if there is
// no second.
template <class Task>
void in_halves(PairOfThreads* threads, size_t first, size_t last, const Task& task) {
    const std::array bounds = {first, (first + last) / 2, last};
    const auto work = [&](size_t half, size_t) {
        for (size_t i = bounds[half]; i < bounds[half + 1]; ++i) task(i);
    };
    if (threads) return threads->share(2, work);
    work(0, 0);
    work(1, 0);
}

}  // namespace partwheel
