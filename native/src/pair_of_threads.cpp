// The two threads meet in one atomic state; tasks are handed out by one atomic counter.
#include "pair_of_threads.h"

#include <algorithm>
#include <utility>

#if defined(__linux__)
#include <pthread.h>
#include <time.h>
#endif

namespace partwheel {

namespace {

// Each thread looks out for the other so many times, some 50 microseconds, before the system may run others in its
// place, that other one among them.
constexpr int looks_before_yielding = 2000;

// Offers come every few microseconds, so the second thread looks out for the next one this many times, about a
// millisecond, before it goes to sleep: waking it takes longer than most tasks.
constexpr int looks_before_sleeping = 4000;

// Two threads pay while the caller has been alone for no more than this part of its time, and these seconds, a few times
// what a system gives to another program at a time.
constexpr double tolerated_part = 1.0 / 8, tolerated_seconds = 12e-3;

void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

}  // namespace

PairOfThreads::PairOfThreads() : second_([this] { serve(); }) {}

PairOfThreads::~PairOfThreads() {
    state_.store(ended, std::memory_order_release);
    state_.notify_one();
    second_.join();
}

void PairOfThreads::share(size_t count, const std::function<void(size_t, size_t)>& task) {
    task_ = &task;
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    state_.store(offered, std::memory_order_release);
    state_.notify_one();
    const auto begun = Clock::now();
    work(0);
    uint32_t state = offered;
    if (!state_.compare_exchange_strong(state, idle, std::memory_order_acq_rel))
        wait_for_second();
    else if (count > 1)
        alone_ += (Clock::now() - begun) / 2;
    const auto errors = std::exchange(errors_, {});
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

// Its last task is under way.
void PairOfThreads::wait_for_second() {
    for (int looks = 0; looks < looks_before_yielding; ++looks) {
        if (state_.load(std::memory_order_acquire) == idle) return;
        pause();
    }
    const auto begun = Clock::now();
    const auto had_run = second_has_run();
    while (state_.load(std::memory_order_acquire) != idle) std::this_thread::yield();
    // A second thread that runs has more to do; only one that does not is what a crowded machine makes of it.
    alone_ += std::max(Clock::duration::zero(), Clock::now() - begun - (second_has_run() - had_run));
}

// Its time on a processor; 0 where the system doesn't tell.
PairOfThreads::Clock::duration PairOfThreads::second_has_run() {
#if defined(__linux__)
    clockid_t clock;
    timespec time;
    if (pthread_getcpuclockid(second_.native_handle(), &clock) == 0 && clock_gettime(clock, &time) == 0)
        return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
#endif
    return {};
}

bool PairOfThreads::pays() const {
    const auto seconds = [](Clock::duration d) { return std::chrono::duration<double>(d).count(); };
    return seconds(alone_) <= tolerated_seconds + tolerated_part * seconds(Clock::now() - made_);
}

void PairOfThreads::work(size_t thread) noexcept {
    try {
        for (size_t i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < count_;) (*task_)(i, thread);
    } catch (...) {
        errors_[thread] = std::current_exception();
        next_.store(count_, std::memory_order_relaxed);
    }
}

void PairOfThreads::serve() {
    for (int looks = 0;; ++looks) {
        uint32_t state = state_.load(std::memory_order_acquire);
        if (state == ended) return;
        if (state == offered && state_.compare_exchange_strong(state, taken, std::memory_order_acq_rel)) {
            work(1);
            state_.store(idle, std::memory_order_release);
            looks = 0;
        } else if (looks > looks_before_sleeping) {
            state_.wait(state, std::memory_order_acquire);
            looks = 0;
        } else {
            looks < looks_before_yielding ? pause() : std::this_thread::yield();
        }
    }
}

}  // namespace partwheel
