// ThreadPool: every chunk runs once, results are visible to the caller, exceptions propagate.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace partwheel::test {
namespace {

TEST(ThreadPool, RunsEachChunkOnce) {
    for (const size_t max_threads : {1, 2, 3, 8}) {
        ThreadPool threads(max_threads);
        for (size_t round = 0; round < 2000; ++round) {
            const size_t count = round % 70, chunk = 1 + round % 9;
            std::vector<size_t> calls(count, 0);
            std::atomic<size_t> chunks{0};
            threads.parallel_for(count, chunk, [&](size_t first, size_t last) {
                ++chunks;
                ASSERT_TRUE(first % chunk == 0 && first < last && last - first <= chunk && last <= count);
                for (size_t i = first; i < last; ++i) ++calls[i];
            });
            ASSERT_EQ(calls, std::vector<size_t>(count, 1));
            ASSERT_EQ(chunks, (count + chunk - 1) / chunk);
        }
    }
}

TEST(ThreadPool, AnAbsurdNumberOfThreadsLeavesSomeToOthers) {
    EXPECT_EQ(thread_count(3), 3U);
    for (const size_t absurd : {size_t{100000}, std::numeric_limits<size_t>::max()}) EXPECT_LE(ThreadPool(absurd).count(), 1000U);
}

// Of several exceptions the caller gets the first, whichever thread runs it.
TEST(ThreadPool, TheFirstExceptionIsRethrown) {
    for (const size_t max_threads : {1, 2, 4}) {
        ThreadPool threads(max_threads);
        for (int round = 0; round < 300; ++round) {
            std::vector<int> calls(64, 0);
            try {
                threads.parallel_for(64, 2, [&](size_t first, size_t) {
                    ++calls[first];
                    if (first >= 10 && first % 3 == 1) throw std::runtime_error(std::to_string(first));
                });
                FAIL() << "nothing was thrown";
            } catch (const std::runtime_error& error) {
                ASSERT_STREQ(error.what(), "10");
            }
            for (size_t first = 0; first <= 10; first += 2) ASSERT_EQ(calls[first], 1);  // earlier chunks have run
            std::atomic<int> after{0};
            threads.parallel_for(64, 2, [&](size_t, size_t) { ++after; });  // the pool still works
            ASSERT_EQ(after, 32);
        }
    }
}

}  // namespace
}  // namespace partwheel::test
