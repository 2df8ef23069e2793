// Joins of what is left of their parts.
#include "parts/part_tree.h"

#include <algorithm>

namespace partwheel {

PartTree relabel(const PartTree& joins, std::span<const int32_t> of) {
    std::vector<int32_t> number(joins.count + joins.joined.size(), -1);  // there, of each number here
    for (const int32_t p : of) number[idx(p)] = 0;
    PartTree left;
    for (size_t p = 0; p < joins.count; ++p)
        if (number[p] == 0) number[p] = static_cast<int32_t>(left.count++);
    for (const int32_t p : of) left.of.push_back(number[idx(p)]);
    for (size_t j = 0; j < joins.joined.size(); ++j) {
        const int32_t a = number[idx(joins.joined[j][0])], b = number[idx(joins.joined[j][1])];
        int32_t& made = number[joins.count + j];
        made = std::max(a, b);
        if (a < 0 || b < 0) {  // what was a step to this is now this
            if (made >= static_cast<int32_t>(left.count) && !joins.steps[j]) left.steps[idx(made) - left.count] = 0;
            continue;
        }
        made = static_cast<int32_t>(left.count + left.joined.size());
        left.joined.push_back({a, b});
        left.costs.push_back(joins.costs[j]);
        left.steps.push_back(joins.steps[j]);
    }
    for (const std::vector<int32_t>& image : joins.images) {
        std::vector<int32_t> there(left.count + left.joined.size(), -1);
        for (size_t n = 0; n < number.size(); ++n)
            if (number[n] >= 0 && image[n] >= 0) there[idx(number[n])] = number[idx(image[n])];
        left.images.push_back(std::move(there));
    }
    return left;
}

}  // namespace partwheel
