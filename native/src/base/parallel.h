// A thread pool for loops over independent chunks.
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

// max_threads: 0 means one per core.
size_t thread_count(size_t max_threads);

// The caller's thread and helper threads, which sleep between calls. Works with fewer helpers if the system provides
// no more.
class ThreadPool {
public:
    // max_threads: includes the caller's; see thread_count(). max_chunks: no more threads than this.
    explicit ThreadPool(size_t max_threads = 0, size_t max_chunks = std::numeric_limits<size_t>::max());
    ~ThreadPool();
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    size_t count() const { return helpers_.size() + 1; }

    // Calls task(first, last) for chunks of chunk_size that cover 0 to count - 1, and returns when all are done. Any
    // thread may run any chunk: if each writes only its own data, the result does not depend on the number of
    // threads. If tasks throw, later chunks may be skipped, and the exception of the first one is rethrown. No
    // allocation; not reentrant; one caller at a time.
    template <class Task>
    void parallel_for(size_t count, size_t chunk_size, const Task& task) {
        run({[](const void* of, size_t first, size_t last) { (*static_cast<const Task*>(of))(first, last); }, &task,
               count, chunk_size});
    }

    // Calls task(thread, i) for i from 0 to count - 1, like parallel_for(). No two calls at a time have the same
    // thread, a number below count(): it may have scratch memory of its own.
    template <class Task>
    void parallel_for_each(size_t count, const Task& task) {
        std::atomic<size_t> next{0};
        parallel_for(count < this->count() ? count : this->count(), 1, [&](size_t thread, size_t) {
            for (size_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) task(thread, i);
        });
    }

private:
    struct Work {
        void (*call)(const void* task, size_t first, size_t last);
        const void* task;
        size_t count, chunk_size;

        void run_chunk(size_t first) const { call(task, first, count - first < chunk_size ? count : first + chunk_size); }
    };

    ThreadPool(std::nullptr_t) {}
    void run(const Work& work);
    void run_chunks() noexcept;
    void work();

    std::mutex mutex_;  // guards what is not atomic, except current_, which only changes while no helper is at work
    std::condition_variable work_available_, done_;
    Work current_{};
    uint64_t generation_ = 0;  // of parallel_for calls
    bool accepts_helpers_ = false;  // to the current call
    bool is_stopping_ = false;
    size_t active_helpers_ = 0;  // in run_chunks()
    std::atomic<size_t> next_{0};
    std::exception_ptr error_;
    size_t error_at_ = 0;
    std::vector<std::thread> helpers_;
};

}  // namespace partwheel
