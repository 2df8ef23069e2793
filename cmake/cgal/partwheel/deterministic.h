// What CGAL leaves to the standard library and to the system, done in one way, so that its results are the same bits
// everywhere. cmake/deterministic_cgal.cmake has CGAL's headers call this. Where several are equally good the first is taken,
// and which that is depends on a hash table's order, or on what nth_element does with equals.
#pragma once

#include <boost/unordered/unordered_flat_map.hpp>
#include <boost/unordered_map.hpp>
#include <boost/unordered_set.hpp>

#include <algorithm>
#include <functional>
#include <cmath>

namespace partwheel::deterministic {

// As std::nth_element.
template <class Iterator, class Less = std::less<>>
void nth_element(Iterator first, Iterator nth, Iterator last, Less less = {}) {
    for (int rounds = 64; last - first > 1; --rounds) {
        if (rounds == 0) return std::stable_sort(first, last, less);
        const auto pivot = *(first + (last - first) / 2);
        Iterator equal = first, greater = last;
        for (Iterator i = first; i != greater;) {
            if (less(*i, pivot))
                std::iter_swap(equal++, i++);
            else if (less(pivot, *i))
                std::iter_swap(i, --greater);
            else
                ++i;
        }
        if (nth < equal)
            last = equal;
        else if (nth < greater)
            return;
        else
            first = greater;
    }
}

// As std::atan2, to some 1e-15. Systems differ in its last bit.
inline double atan2(double y, double x) {
    constexpr double pi = 3.14159265358979323846;
    const double a = std::fabs(x), b = std::fabs(y), larger = std::max(a, b);
    if (larger == 0) return 0;
    double t = std::min(a, b) / larger, sum = 0;
    for (int halved = 0; halved < 2; ++halved) t /= 1 + std::sqrt(1 + t * t);
    for (int k = 23; k > 0; k -= 2) sum = 1.0 / k - t * t * sum;
    double angle = 4 * t * sum;
    if (b > a) angle = pi / 2 - angle;
    if (x < 0) angle = pi - angle;
    return y < 0 ? -angle : angle;
}

inline double acos(double cosine) { return atan2(std::sqrt((1 - cosine) * (1 + cosine)), cosine); }

}  // namespace partwheel::deterministic
