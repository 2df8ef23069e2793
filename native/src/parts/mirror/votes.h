// Several that claim the same, each with some area: who has the most gets it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace partwheel {

struct Vote {
    int32_t what, who;
    double area;
};

// Calls give(what, who) once for each that is claimed, in rising order: who claims most of it in all, of equals the
// lowest. Sums are compared in single precision, so that those tie that do by symmetry; nor does the order of the claims
// matter.
template <class Give>
void for_each_majority(std::vector<Vote> claims, const Give& give) {
    std::sort(claims.begin(), claims.end(), [](const Vote& a, const Vote& b) {
        return std::tie(a.what, a.who, a.area) < std::tie(b.what, b.who, b.area);
    });
    for (size_t i = 0; i < claims.size();) {
        const int32_t what = claims[i].what;
        int32_t winner = claims[i].who;
        double most = -1;
        while (i < claims.size() && claims[i].what == what) {
            const int32_t who = claims[i].who;
            double sum = 0;
            for (; i < claims.size() && claims[i].what == what && claims[i].who == who; ++i) sum += claims[i].area;
            if (const double rounded = static_cast<float>(sum); rounded > most) {
                most = rounded;
                winner = who;
            }
        }
        give(what, winner);
    }
}

}  // namespace partwheel
