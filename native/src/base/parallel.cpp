// Helpers sleep until there is work; one atomic counter distributes the chunks. A helper that wakes too late is not
// waited for.
#include "base/parallel.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace partwheel {

// More would not help, and tens of thousands leave none to the rest of the machine.
constexpr size_t most_threads = 256;

size_t thread_count(size_t max_threads) {
    return std::min<size_t>(max_threads > 0 ? max_threads : std::max(1U, std::thread::hardware_concurrency()), most_threads);
}

// Delegates to another constructor, so that the destructor joins the existing helpers if starting one throws.
ThreadPool::ThreadPool(size_t max_threads, size_t max_chunks) : ThreadPool(nullptr) {
    try {
        while (count() < std::min(thread_count(max_threads), max_chunks)) helpers_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
        // Fewer are fine.
    }
}

ThreadPool::~ThreadPool() {
    {
        const std::scoped_lock lock(mutex_);
        is_stopping_ = true;
    }
    work_available_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::run(const Work& work) {
    if (helpers_.empty() || work.count <= work.chunk_size) {
        for (size_t first = 0; first < work.count; first += work.chunk_size) work.run_chunk(first);
        return;
    }
    {
        const std::scoped_lock lock(mutex_);
        current_ = work;
        next_.store(0, std::memory_order_relaxed);
        ++generation_;
        accepts_helpers_ = true;
    }
    work_available_.notify_all();
    run_chunks();
    std::unique_lock lock(mutex_);
    accepts_helpers_ = false;
    done_.wait(lock, [this] { return active_helpers_ == 0; });
    if (error_) std::rethrow_exception(std::exchange(error_, {}));
}

// Chunks start in order, so the first one that throws is always among those started.
void ThreadPool::run_chunks() noexcept {
    for (size_t first; (first = next_.fetch_add(current_.chunk_size, std::memory_order_relaxed)) < current_.count;) {
        try {
            current_.run_chunk(first);
        } catch (...) {
            next_.store(current_.count, std::memory_order_relaxed);
            const std::scoped_lock lock(mutex_);
            if (!error_ || first < error_at_) {
                error_ = std::current_exception();
                error_at_ = first;
            }
        }
    }
}

void ThreadPool::work() {
    std::unique_lock lock(mutex_);
    for (uint64_t last_generation = 0;;) {
        work_available_.wait(lock, [&] { return is_stopping_ || (accepts_helpers_ && generation_ != last_generation); });
        if (is_stopping_) return;
        last_generation = generation_;
        ++active_helpers_;
        lock.unlock();
        run_chunks();
        lock.lock();
        if (--active_helpers_ == 0) done_.notify_one();
    }
}

}  // namespace partwheel
