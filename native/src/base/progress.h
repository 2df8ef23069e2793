// Progress, cancellation and timing of a call, shared between the working thread and its observers.
#pragma once

#include "base/error.h"

#include <algorithm>
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

    // The same for steps of unknown number: completes this share of what is left, in one thread.
    void advance_by(double share) {
        const double done = part();
        advance(done + share * (1 - done));
    }

    // The completed part of the current stage, or of the section that is in scope. Not 0 where a stage is entered
    // again.
    double part() const;

    // While it is in scope, advance() refers to the section [begin, end] of the stage, or of the enclosing section.
    class Section {
    public:
        Section(Progress& progress, double begin, double end) : range_(progress.section_), previous_(range_) {
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

    // While it is in scope, pieces of the build run through all stages, in any number of threads. They make up what is
    // left of the fraction, are canceled with the build, and add their seconds to it.
    class Pieces {
    public:
        explicit Pieces(Progress& whole) : whole_(whole), rest_(1 - whole.fraction()) { whole.add_stage_time(); }
        ~Pieces() { whole_.stage_start_ = Clock::now(); }
        Pieces(const Pieces&) = delete;
        Pieces& operator=(const Pieces&) = delete;

        // The progress of one piece, for one thread at a time; share: of the work of all pieces.
        Progress piece(double share) { return {whole_, rest_ * share}; }

    private:
        Progress& whole_;
        double rest_;
    };

    // The progress of work in another thread beside this one: canceled with it, but not part of its fraction.
    Progress beside() { return {*this, 0}; }

    Progress() = default;
    ~Progress() {
        if (whole_) add_stage_time();
    }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Like advance(), for calls without stages: the completed part of the call.
    void reach(double fraction);

    void cancel() { canceled_.store(true, std::memory_order_relaxed); }
    // Read fraction() before stage(): then the stage is never older than the fraction.
    double fraction() const { return std::min(1.0, fraction_.load(std::memory_order_acquire)); }
    pw_stage stage() const { return stage_.load(std::memory_order_relaxed); }
    double seconds(pw_stage stage) const { return seconds_[stage].load(std::memory_order_relaxed); }

private:
    using Clock = std::chrono::steady_clock;
    Progress(Progress& whole, double share)
        : whole_(&whole), share_(share), stage_(whole.stage()), stage_start_(Clock::now()) {}
    bool is_canceled() const { return whole_ ? whole_->is_canceled() : canceled_.load(std::memory_order_relaxed); }
    Progress& root() { return whole_ ? whole_->root() : *this; }
    void add_stage_time();
    void raise_to(double fraction);

    Progress* whole_ = nullptr;  // of a piece
    double share_ = 1;           // of the fraction of the whole
    std::atomic<bool> canceled_{false};
    std::atomic<double> fraction_{0};  // stored after the stage it belongs to
    std::atomic<pw_stage> stage_{PW_STAGE_SURFACE};
    std::array<std::atomic<double>, PW_STAGE_COUNT> seconds_{};
    Clock::time_point stage_start_{};
    std::array<double, 2> section_{0, 1};  // see Section; working thread only
    bool running_ = false;
};

// A progress that nobody observes or cancels, one per thread.
Progress& unobserved_progress();

}  // namespace partwheel
