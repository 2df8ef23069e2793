// Majority votes, weighted by area.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace partwheel {

struct Vote {
    int32_t target, label;
    double area;
};

// Calls assign(target, label) once per target, in ascending order, with the label that has the largest sum of areas;
// the lowest label in a tie. Sums are compared in single precision, so that labels that are equal by symmetry tie.
// The result does not depend on the order of the votes.
template <class Assign>
void for_each_majority(std::vector<Vote> votes, const Assign& assign) {
    std::sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) {
        return std::tie(a.target, a.label, a.area) < std::tie(b.target, b.label, b.area);
    });
    for (size_t i = 0; i < votes.size();) {
        const int32_t target = votes[i].target;
        int32_t winner = votes[i].label;
        double max_area = -1;
        while (i < votes.size() && votes[i].target == target) {
            const int32_t label = votes[i].label;
            double sum = 0;
            for (; i < votes.size() && votes[i].target == target && votes[i].label == label; ++i) sum += votes[i].area;
            if (const double rounded = static_cast<float>(sum); rounded > max_area) {
                max_area = rounded;
                winner = label;
            }
        }
        assign(target, winner);
    }
}

}  // namespace partwheel
