// Threads and parallel_for: each piece once, whoever does it, the results seen by the caller, and errors brought home.
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace partwheel::test {
namespace {

TEST(Threads, EachPieceOnce) {
    for (const size_t most : {1, 2, 3, 8}) {
        Threads threads(most);
        for (size_t round = 0; round < 2000; ++round) {
            const size_t count = round % 70, piece = 1 + round % 9;
            std::vector<size_t> calls(count, 0);
            std::atomic<size_t> pieces{0};
            threads.parallel_for(count, piece, [&](size_t first, size_t last) {
                ++pieces;
                ASSERT_TRUE(first % piece == 0 && first < last && last - first <= piece && last <= count);
                for (size_t i = first; i < last; ++i) ++calls[i];
            });
            ASSERT_EQ(calls, std::vector<size_t>(count, 1));
            ASSERT_EQ(pieces, (count + piece - 1) / piece);
        }
    }
}

TEST(Threads, AsManyAsAskedFor) {
    EXPECT_EQ(Threads(1).count(), 1U);
    EXPECT_EQ(Threads(5).count(), 5U);
    EXPECT_EQ(Threads(5, 3).count(), 3U);  // pieces
    EXPECT_EQ(Threads(5, 0).count(), 1U);
    EXPECT_EQ(Threads().count(), std::max(1U, std::thread::hardware_concurrency()));
}

// Each of four pieces waits for the others to have begun.
TEST(Threads, AllTakePart) {
    Threads threads(4);
    for (int round = 0; round < 20; ++round) {
        std::atomic<int> begun{0};
        std::vector<std::thread::id> who(4);
        threads.parallel_for(4, 1, [&](size_t piece, size_t) {
            who[piece] = std::this_thread::get_id();
            ++begun;
            while (begun < 4) std::this_thread::yield();
        });
        EXPECT_EQ(std::set(who.begin(), who.end()).size(), 4U);
    }
}

// Of several that throw the caller gets the first, however they are shared out.
TEST(Threads, ErrorsComeHome) {
    for (const size_t most : {1, 2, 4}) {
        Threads threads(most);
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
            for (size_t first = 0; first <= 10; first += 2) ASSERT_EQ(calls[first], 1);  // what came before is done
            std::atomic<int> after{0};
            threads.parallel_for(64, 2, [&](size_t, size_t) { ++after; });  // as if nothing had been
            ASSERT_EQ(after, 32);
        }
    }
}

}  // namespace
}  // namespace partwheel::test
