// Progress, cancellation and timing of one build, shared between the building thread and those that watch it.
#pragma once

#include "base/error.h"

#include <array>
#include <atomic>
#include <chrono>

namespace partwheel {

class Progress {
public:
    // Starts a build: fraction and seconds go back to 0. A cancellation asked for before stands.
    void begin();

    // All is done, whatever was asked for meanwhile.
    void finish() { raise_to(1); }

    // Ends it, whether it went well or not: the running stage's seconds are booked, a cancellation is used up.
    void end();

    // Books the stage that ran until now, then starts this one. Throws if canceled.
    void enter(pw_stage stage);

    // The part of the current stage that is done, 0..1. Throws Error(PW_ERROR_CANCELED) if canceled. Cheap enough
    // for every few hundred steps of an inner loop.
    void advance(double part);

    // Until it goes out of scope advance() is about this share of the stage.
    class Section {
    public:
        Section(Progress& progress, double begin, double end) : progress_(progress), outer_(progress.section_) {
            const auto [from, to] = outer_;
            progress.section_ = {from + (to - from) * begin, from + (to - from) * end};
        }
        ~Section() { progress_.section_ = outer_; }
        Section(const Section&) = delete;
        Section& operator=(const Section&) = delete;

    private:
        Progress& progress_;
        std::array<double, 2> outer_;
    };

    // The same where there are no stages: the part of all that is done.
    void reach(double fraction);

    void cancel() { canceled_.store(true, std::memory_order_relaxed); }
    // Who asks for the fraction first and then for the stage never sees a stage that was over at that fraction.
    double fraction() const { return fraction_.load(std::memory_order_acquire); }
    pw_stage stage() const { return stage_.load(std::memory_order_relaxed); }
    double seconds(pw_stage stage) const { return seconds_[stage].load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;
    void book();
    void raise_to(double fraction);

    std::atomic<bool> canceled_{false};
    std::atomic<double> fraction_{0};  // stored after the stage it belongs to
    std::atomic<pw_stage> stage_{PW_STAGE_SURFACE};
    std::array<std::atomic<double>, PW_STAGE_COUNT> seconds_{};
    Clock::time_point stage_start_{};
    std::array<double, 2> section_{0, 1};  // of the stage; the working thread's
    bool running_ = false;
};

// A progress that nobody watches or cancels, this thread's own.
Progress& unwatched();

}  // namespace partwheel
