// Progress, cancellation and timing of a call, shared between the working thread and its observers.
#pragma once

#include "base/error.h"

#include <array>
#include <atomic>
#include <chrono>

namespace partwheel {

class Progress {
public:
    // Starts a build: resets fraction and seconds. A pending cancellation stays.
    void begin();

    // Sets the fraction to 1, even if canceled.
    void finish() { raise_to(1); }

    // After success or failure: adds the time of the running stage and clears the cancellation.
    void end();

    // Ends the running stage and starts this one. Throws if canceled.
    void enter(pw_stage stage);

    // Sets the completed part of the current stage, 0..1. Throws Error(PW_ERROR_CANCELED) if canceled. Cheap enough
    // for every few hundred steps of an inner loop.
    void advance(double part);

    // While it is in scope, advance() refers to the section [begin, end] of the stage, or of the enclosing section;
    // with Of::build, to that section of the whole build: an assembly runs through all stages once for each shell.
    class Section {
    public:
        enum class Of { stage, build };
        Section(Progress& progress, double begin, double end, Of whole = Of::stage)
            : range_(whole == Of::stage ? progress.stage_section_ : progress.build_section_), previous_(range_) {
            const auto [from, to] = previous_;
            range_ = {from + (to - from) * begin, from + (to - from) * end};
        }
        ~Section() { range_ = previous_; }
        Section(const Section&) = delete;
        Section& operator=(const Section&) = delete;

    private:
        std::array<double, 2>& range_;
        std::array<double, 2> previous_;
    };

    // Like advance(), for calls without stages: the completed part of the call.
    void reach(double fraction);

    void cancel() { canceled_.store(true, std::memory_order_relaxed); }
    // Read fraction() before stage(): then the stage is never older than the fraction.
    double fraction() const { return fraction_.load(std::memory_order_acquire); }
    pw_stage stage() const { return stage_.load(std::memory_order_relaxed); }
    double seconds(pw_stage stage) const { return seconds_[stage].load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;
    void add_stage_time();
    void raise_to(double fraction);

    std::atomic<bool> canceled_{false};
    std::atomic<double> fraction_{0};  // stored after the stage it belongs to
    std::atomic<pw_stage> stage_{PW_STAGE_SURFACE};
    std::array<std::atomic<double>, PW_STAGE_COUNT> seconds_{};
    Clock::time_point stage_start_{};
    std::array<double, 2> stage_section_{0, 1}, build_section_{0, 1};  // see Section; working thread only
    bool running_ = false;
};

// A progress that nobody observes or cancels, one per thread.
Progress& unobserved_progress();

}  // namespace partwheel
