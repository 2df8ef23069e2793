// Helpers sleep until work is offered; pieces are handed out by one atomic counter. One that wakes too late to begin is
// not waited for.
#include "base/parallel.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace partwheel {

// By way of another constructor, so that the destructor sees to the helpers there are if there is no memory for more.
Threads::Threads(size_t most, size_t pieces) : Threads(nullptr) {
    const size_t wanted = most > 0 ? most : std::max(1U, std::thread::hardware_concurrency());
    try {
        while (count() < std::min(wanted, pieces)) helpers_.emplace_back([this] { help(); });
    } catch (const std::system_error&) {
        // Fewer do as well.
    }
}

Threads::~Threads() {
    {
        const std::scoped_lock lock(mutex_);
        ended_ = true;
    }
    offered_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
}

void Threads::share(const Work& work) {
    if (helpers_.empty() || work.count <= work.piece) {
        for (size_t first = 0; first < work.count; first += work.piece) work.do_piece(first);
        return;
    }
    {
        const std::scoped_lock lock(mutex_);
        work_ = work;
        next_.store(0, std::memory_order_relaxed);
        ++round_;
        open_ = true;
    }
    offered_.notify_all();
    take_pieces();
    std::unique_lock lock(mutex_);
    open_ = false;
    done_.wait(lock, [this] { return busy_ == 0; });
    if (error_) std::rethrow_exception(std::exchange(error_, {}));
}

// Pieces are begun in their order, so of those that throw the first is always among those begun.
void Threads::take_pieces() noexcept {
    for (size_t first; (first = next_.fetch_add(work_.piece, std::memory_order_relaxed)) < work_.count;) {
        try {
            work_.do_piece(first);
        } catch (...) {
            next_.store(work_.count, std::memory_order_relaxed);
            const std::scoped_lock lock(mutex_);
            if (!error_ || first < error_at_) {
                error_ = std::current_exception();
                error_at_ = first;
            }
        }
    }
}

void Threads::help() {
    std::unique_lock lock(mutex_);
    for (uint64_t seen = 0;;) {
        offered_.wait(lock, [&] { return ended_ || (open_ && round_ != seen); });
        if (ended_) return;
        seen = round_;
        ++busy_;
        lock.unlock();
        take_pieces();
        lock.lock();
        if (--busy_ == 0) done_.notify_one();
    }
}

}  // namespace partwheel
