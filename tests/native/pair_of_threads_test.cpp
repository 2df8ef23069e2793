// PairOfThreads: each task once, whoever does it, the results seen by the caller, and errors brought home.
#include "pair_of_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace partwheel::test {
namespace {

TEST(PairOfThreads, EachTaskOnce) {
    PairOfThreads threads;
    std::vector<int> calls, by;
    for (size_t round = 0; round < 3000; ++round) {
        const size_t count = round % 40;
        calls.assign(count, 0);
        by.assign(count, -1);
        threads.share(count, [&](size_t i, size_t thread) {
            ++calls[i];
            by[i] = static_cast<int>(thread);
        });
        for (size_t i = 0; i < count; ++i) {
            ASSERT_EQ(calls[i], 1);
            ASSERT_TRUE(by[i] == 0 || by[i] == 1);
        }
    }
}

TEST(PairOfThreads, TheSecondTakesItsShare) {
    // The first task waits until the other thread has done the second, which it must: both are under way at once.
    PairOfThreads threads;
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> done{0};
        std::atomic<size_t> seen{0};
        threads.share(2, [&](size_t, size_t thread) {
            seen.fetch_or(size_t{1} << thread);
            ++done;
            while (done.load() < 2) std::this_thread::yield();
        });
        EXPECT_EQ(seen.load(), 3U);
    }
}

TEST(PairOfThreads, ASleepingSecondIsWoken) {
    PairOfThreads threads;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // long enough for it to stop looking out
    std::atomic<int> done{0};
    threads.share(2, [&](size_t, size_t) {
        ++done;
        while (done.load() < 2) std::this_thread::yield();
    });
    EXPECT_EQ(done.load(), 2);
}

TEST(PairOfThreads, ASecondThatKeepsTheCallerWaitingDoesNotPay) {
    PairOfThreads threads;
    EXPECT_TRUE(threads.pays());
    std::atomic<bool> begun{false};
    threads.share(2, [&](size_t, size_t thread) {
        if (thread == 0) {
            while (!begun.load()) std::this_thread::yield();
        } else {
            begun = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(200));  // as if another program had its core
        }
    });
    EXPECT_FALSE(threads.pays());
}

#if defined(__linux__)
TEST(PairOfThreads, ASecondThatHasMoreToDoPays) {
    // Other programs may keep it from running meanwhile, so one try in ten will do.
    for (int tries = 0; tries < 10; ++tries) {
        PairOfThreads threads;
        std::atomic<bool> begun{false};
        threads.share(2, [&](size_t, size_t thread) {
            if (thread == 1) begun = true;
            const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(thread == 0 ? 0 : 100);
            while (!begun.load()) std::this_thread::yield();
            while (std::chrono::steady_clock::now() < end) continue;
        });
        if (threads.pays()) return;
    }
    ADD_FAILURE() << "it was running while the caller waited";
}
#endif

TEST(PairOfThreads, ErrorsComeHome) {
    PairOfThreads threads;
    for (size_t bad = 0; bad < 8; ++bad) {
        EXPECT_THROW(threads.share(8,
                                   [&](size_t i, size_t) {
                                       if (i == bad) throw std::runtime_error("no");
                                   }),
                     std::runtime_error);
        std::vector<int> calls(8, 0);
        threads.share(8, [&](size_t i, size_t) { ++calls[i]; });  // as if nothing had been
        EXPECT_EQ(std::accumulate(calls.begin(), calls.end(), 0), 8);
    }
}

TEST(PairOfThreads, NothingToDo) {
    PairOfThreads threads;
    threads.share(0, [](size_t, size_t) { FAIL() << "there is no task"; });
}

}  // namespace
}  // namespace partwheel::test
