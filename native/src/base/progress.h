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

    // While it is in scope, advance() refers to the section [begin, end] of the stage, or of the enclosing section.
    class Section {
    public:
        Section(Progress& progress, double begin, double end) : progress_(progress), previous_(progress.section_) {
            const auto [from, to] = previous_;
            progress.section_ = {from + (to - from) * begin, from + (to - from) * end};
        }
        ~Section() { progress_.section_ = previous_; }
        Section(const Section&) = delete;
        Section& operator=(const Section&) = delete;

    private:
        Progress& progress_;
        std::array<double, 2> previous_;
    };

    // Until it goes out of scope, a build's fraction is about this share of it: an assembly runs through the stages once for
    // each shell.
    class Share {
    public:
        Share(Progress& progress, double begin, double end) : progress_(progress), previous_(progress.share_) {
            progress.share_ = {begin, end};
        }
        ~Share() { progress_.share_ = previous_; }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;

    private:
        Progress& progress_;
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
    std::array<double, 2> section_{0, 1};  // of the stage; working thread only
    std::array<double, 2> share_{0, 1};    // of the build; likewise
    bool running_ = false;
};

// A progress without observers, one per thread.
Progress& unwatched();

}  // namespace partwheel
