// The two threads meet in one atomic state; tasks are handed out by one atomic counter.
#include "pair_of_threads.h"

#include <utility>

namespace partwheel {

namespace {

// Offers come every few microseconds, so the second thread looks out for the next one this many times, about a
// millisecond, before it goes to sleep: waking it takes longer than most tasks.
constexpr int patience = 50000;

// So many looks at whether the second thread has done its last task before the system may run it here.
constexpr int looks_before_yielding = 2000;

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
    work(0);
    uint32_t state = offered;
    if (!state_.compare_exchange_strong(state, idle, std::memory_order_acq_rel))
        for (int looks = 0; state_.load(std::memory_order_acquire) != idle; ++looks)  // its last task is under way
            looks < looks_before_yielding ? pause() : std::this_thread::yield();
    const auto errors = std::exchange(errors_, {});
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
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
        } else if (looks > patience) {
            state_.wait(state, std::memory_order_acquire);
            looks = 0;
        } else {
            pause();
        }
    }
}

}  // namespace partwheel
