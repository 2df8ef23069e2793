// Tests where the system refuses to start threads, as when too many are running.
#pragma once

#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <cstdlib>
#include <system_error>
#include <thread>

namespace partwheel::test {

#ifdef _WIN32
template <class Task>
void expect_holds_alone(const Task&) {
    GTEST_SKIP() << "Windows has no limit of threads.";
}
#else
// Expects task() to hold in a child process that may have no second thread. Root may have any, so the child isn't root.
template <class Task>
void expect_holds_alone(const Task& task) {
    constexpr int holds = 0, does_not = 1, not_alone = 2;
    const auto child = [&] {
        constexpr uid_t nobody = 65534;
        constexpr rlimit none{0, 0};
        if ((geteuid() == 0 && setuid(nobody) != 0) || setrlimit(RLIMIT_NPROC, &none) != 0) return not_alone;
        try {
            std::thread([] {}).join();
            return not_alone;
        } catch (const std::system_error&) {
            return task() ? holds : does_not;
        }
    };
    EXPECT_EXIT(_exit(child()), testing::ExitedWithCode(holds), "");
}
#endif

}  // namespace partwheel::test
