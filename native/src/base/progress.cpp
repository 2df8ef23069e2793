// Progress, cancellation and timing of a call.
#include "base/progress.h"

namespace partwheel {

namespace {

// The fraction of a build's time at the start of each stage: medians over real models. Only progress bars depend on it.
constexpr std::array<double, PW_STAGE_COUNT + 1> stage_begin = {0.0, 0.1, 0.2, 0.45, 0.8, 0.98, 1.0};

}  // namespace

void Progress::begin() {
    for (auto& s : seconds_) s.store(0, std::memory_order_relaxed);
    stage_.store(PW_STAGE_SURFACE, std::memory_order_relaxed);
    fraction_.store(0, std::memory_order_release);
    stage_start_ = Clock::now();
    running_ = true;
}

void Progress::end() {
    if (running_) add_stage_time();
    running_ = false;
    canceled_.store(false, std::memory_order_relaxed);
}

void Progress::enter(pw_stage stage) {
    add_stage_time();
    stage_.store(stage, std::memory_order_relaxed);
    if (whole_) whole_->stage_.store(stage, std::memory_order_relaxed);
    advance(0);
}

void Progress::advance(double part) {
    if (is_canceled())
        throw Error(PW_ERROR_CANCELED, "The build was canceled. Nothing was changed.");
    const pw_stage stage = stage_.load(std::memory_order_relaxed);
    const double begin = stage_begin[stage], end = stage_begin[stage + 1];
    const double share = section_[0] + (section_[1] - section_[0]) * std::clamp(part, 0.0, 1.0);
    raise_to(begin + (end - begin) * share);
}

double Progress::part() const {
    const pw_stage stage = stage_.load(std::memory_order_relaxed);
    const double begin = stage_begin[stage], end = stage_begin[stage + 1];
    const double share = (fraction() - begin) / (end - begin);
    return section_[0] < section_[1] ? std::clamp((share - section_[0]) / (section_[1] - section_[0]), 0.0, 1.0) : 1;
}

void Progress::reach(double fraction) {
    if (is_canceled())
        throw Error(PW_ERROR_CANCELED, "This was canceled. Nothing was changed.");
    raise_to(std::clamp(fraction, 0.0, 1.0));
}

void Progress::add_stage_time() {
    const auto now = Clock::now();
    const pw_stage stage = stage_.load(std::memory_order_relaxed);
    const double passed = std::chrono::duration<double>(now - stage_start_).count();
    root().seconds_[stage].fetch_add(passed, std::memory_order_relaxed);
    stage_start_ = now;
}

void Progress::raise_to(double fraction) {
    double before = fraction_.load(std::memory_order_relaxed);
    while (fraction > before && !fraction_.compare_exchange_weak(before, fraction, std::memory_order_release,
                                                                 std::memory_order_relaxed)) {}
    if (whole_ && fraction > before) whole_->fraction_.fetch_add((fraction - before) * share_, std::memory_order_release);
}

Progress& unobserved_progress() {
    thread_local Progress progress;
    return progress;
}

}  // namespace partwheel
