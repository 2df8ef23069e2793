// The dendrogram: pruning, cuts, wheel stops.
#include "tree/dendrogram.h"

#include "parts/merge/parts.h"

namespace partwheel {

namespace {

// Listing 2 by these costs for all merges but the last ones, which have scores.
template <class Cost>
std::vector<uint8_t> prune_by_cost(std::span<const Merge> merges, std::span<const double> scores,
                            const std::vector<Cost>& costs) {
    const size_t leaves = merges.size() + 1, own = merges.size() - scores.size();
    std::vector<uint8_t> kept(merges.size(), 0);
    // The cost of each merge's parent-to-be, from the root down. Null: it has none.
    std::vector<const Cost*> above(merges.size(), nullptr);
    for (size_t m = merges.size(); m-- > 0;) {
        const bool is_policy_merge = m >= own;
        kept[m] = is_policy_merge ? scores[m - own] > 0 : !above[m] || costs[m] < *above[m];
        const Cost* below = is_policy_merge ? nullptr : kept[m] ? &costs[m] : above[m];
        for (int32_t child : {merges[m].left, merges[m].right})
            if (idx(child) >= leaves) above[idx(child) - leaves] = below;
    }
    return kept;
}

}  // namespace

std::vector<NodeCost> node_costs(std::span<const Merge> merges) {
    const size_t leaves = merges.size() + 1;
    std::vector<int32_t> size(leaves + merges.size(), 1);  // in tetrahedra
    std::vector<NodeCost> costs;
    for (size_t m = 0; m < merges.size(); ++m) {
        const int32_t left = size[idx(merges[m].left)], right = size[idx(merges[m].right)];
        size[leaves + m] = left + right;
        const double a = double(left) / double(leaves), b = double(right) / double(leaves);
        if (merges[m].concavity > 0)
            costs.push_back({true, merges[m].concavity});
        else
            costs.push_back({false, a * a + b * b});
    }
    return costs;
}

std::vector<uint8_t> prune(std::span<const Merge> merges) { return prune_by_cost(merges, {}, node_costs(merges)); }

std::vector<uint8_t> prune_scored(std::span<const Merge> merges, std::span<const double> scores) {
    std::vector<double> concavities;
    for (const Merge& m : merges) concavities.push_back(m.concavity);
    return prune_by_cost(merges, scores, concavities);
}

namespace {

// Numbers below a limit, packed with bit_width(limit - 1) bits each.
class PackedRow {
public:
    PackedRow() = default;
    PackedRow(std::span<const uint16_t> numbers, size_t limit) : width_(static_cast<size_t>(std::bit_width(limit - 1))) {
        if (width_ == 0) return;
        words_.resize((numbers.size() * width_ + 63) / 64 + 1, 0);
        for (size_t i = 0; i < numbers.size(); ++i) {
            const size_t word = i * width_ / 64, shift = i * width_ % 64;
            words_[word] |= uint64_t{numbers[i]} << shift;
            if (shift + width_ > 64) words_[word + 1] |= uint64_t{numbers[i]} >> (64 - shift);
        }
    }
    size_t operator[](size_t i) const {
        if (width_ == 0) return 0;
        const size_t word = i * width_ / 64, shift = i * width_ % 64;
        uint64_t bits = words_[word] >> shift;
        if (shift + width_ > 64) bits |= words_[word + 1] << (64 - shift);
        return bits & ((uint64_t{1} << width_) - 1);
    }

private:
    std::vector<uint64_t> words_;
    size_t width_ = 0;
};

}  // namespace

std::vector<int32_t> cut_least_concavity(std::span<const Merge> merges, size_t parts, Progress& progress) {
    const size_t leaves = merges.size() + 1;
    // least[c][k - 1]: the least total concavity of cluster c in k parts. Freed once the cluster is merged, so all of
    // them together have at most one number for each leaf.
    std::vector<std::vector<double>> least(leaves + merges.size());
    std::vector<uint8_t> left_is_smaller(merges.size());
    std::vector<PackedRow> split(merges.size());  // [m][k - 2]: how many of the k parts the smaller child gets, less 1
    std::vector<uint16_t> row;
    size_t steps = 0;
    progress.reach(0);
    for (size_t i = 0; i < leaves; ++i) least[i] = {0.0};
    for (size_t m = 0; m < merges.size(); ++m) {
        auto &left = least[idx(merges[m].left)], &right = least[idx(merges[m].right)], &both = least[leaves + m];
        const size_t most = std::min(parts, left.size() + right.size());
        both.assign(most, std::numeric_limits<double>::infinity());
        both[0] = merges[m].concavity;
        row.assign(most - 1, 0);
        left_is_smaller[m] = left.size() <= right.size();
        for (size_t i = 1; i <= left.size(); ++i) {
            for (size_t j = 1; j <= right.size() && i + j <= most; ++j) {
                const double total = left[i - 1] + right[j - 1];
                if (total < both[i + j - 1]) {
                    both[i + j - 1] = total;
                    row[i + j - 2] = static_cast<uint16_t>((left_is_smaller[m] ? i : j) - 1);
                }
            }
            steps += right.size();
            if (steps < 100000) continue;
            steps = 0;
            progress.reach(static_cast<double>(m) / static_cast<double>(merges.size()));
        }
        split[m] = PackedRow(row, std::min(left.size(), right.size()));
        left = std::vector<double>();  // not {}, which would keep the memory
        right = std::vector<double>();
    }

    std::vector<int32_t> cut;
    std::vector<std::pair<size_t, size_t>> todo = {{leaves + merges.size() - 1, parts}};
    while (!todo.empty()) {
        const auto [c, k] = todo.back();
        todo.pop_back();
        if (k == 1) {
            cut.push_back(static_cast<int32_t>(c));
            continue;
        }
        const size_t m = c - leaves, smaller = split[m][k - 2] + 1;
        const size_t left = left_is_smaller[m] ? smaller : k - smaller;
        todo.push_back({idx(merges[m].right), k - left});
        todo.push_back({idx(merges[m].left), left});
    }
    return cut;
}

std::vector<int32_t> best_scoring_cut(std::span<const Merge> merges, size_t top, std::span<const double> areas,
                                   std::span<const double> scores) {
    constexpr double min_gain = 0.005, max_part_area = 0.99, same_area = 0.95, max_sliver_score = 0.3;
    const size_t leaves = merges.size() + 1, clusters = leaves + merges.size();
    std::vector<double> best(clusters);
    std::vector<uint8_t> divided(clusters, 0);
    std::vector<int32_t> alike = iota(clusters);  // of each cluster: what it is but for slivers
    const auto is_sliver = [&](int32_t c) {
        return best[idx(c)] < 0 && scores[idx(c)] < max_sliver_score && !divided[idx(c)];
    };
    const auto value_undivided = [&](size_t c) {
        const bool is_whole = areas[c] > max_part_area * areas.back();
        const double score = is_whole ? std::min(scores[c], scores.back()) : scores[idx(alike[c])];
        return areas[c] * score - min_gain * areas.back();
    };
    for (size_t c = 0; c + top < clusters; ++c) best[c] = value_undivided(c);
    for (size_t c = clusters - top; c < clusters; ++c) {
        const Merge& merge = merges[c - leaves];
        for (const auto& [child, other] : {std::pair(merge.left, merge.right), std::pair(merge.right, merge.left)}) {
            const int32_t inner = alike[idx(child)];
            if (is_sliver(other) && areas[idx(inner)] > same_area * areas[c] && scores[idx(inner)] > scores[idx(alike[c])])
                alike[c] = inner;
        }
        best[c] = value_undivided(c);
        const double apart = best[idx(merge.left)] + best[idx(merge.right)];
        if (scores[c] != 0 && apart <= best[c]) continue;
        best[c] = apart;
        divided[c] = 1;
    }
    return cut_tree(merges, [&](size_t m) { return divided[leaves + m] != 0; });
}

std::vector<int32_t> sort_leaves(std::vector<Merge>& merges) {
    std::vector<int32_t> order = cut_undoing_last(merges, merges.size() + 1), number(order.size());
    for (size_t i = 0; i < order.size(); ++i) number[idx(order[i])] = static_cast<int32_t>(i);
    for (Merge& merge : merges)
        for (int32_t* child : {&merge.left, &merge.right})
            if (idx(*child) < number.size()) *child = number[idx(*child)];
    return order;
}

WheelStops wheel_stops(std::span<const double> areas, std::span<const double> scores) {
    constexpr double max_overlap = 0.85, shrink = 0.5;
    const auto root = static_cast<int32_t>(areas.size()) - 1;
    const auto area = [&](int32_t i) { return areas[idx(i)]; };
    const auto score = [&](int32_t i) { return scores[idx(i)]; };
    std::vector<int32_t> by_score;
    for (int32_t i = 0; i <= root; ++i)
        if (score(i) > 0 || i == root) by_score.push_back(i);
    std::stable_sort(by_score.begin(), by_score.end(), [&](int32_t a, int32_t b) { return score(a) > score(b); });
    WheelStops wheel;
    for (const int32_t i : by_score) {
        const auto overlaps = [&](int32_t j) {
            return std::min(area(i), area(j)) > max_overlap * std::max(area(i), area(j));
        };
        if (std::none_of(wheel.stops.begin(), wheel.stops.end(), overlaps)) wheel.stops.push_back(i);
    }
    int32_t clicked = wheel.stops.front();
    std::sort(wheel.stops.begin(), wheel.stops.end());
    if (wheel.stops.back() != root) {
        // The stop that kept the root out of the list: the root takes its place if it looks the same, else comes after.
        if (area(wheel.stops.back()) < area(root)) {
            wheel.stops.push_back(root);
        } else {
            if (clicked == wheel.stops.back()) clicked = root;
            wheel.stops.back() = root;
        }
    }
    std::vector<int32_t> below;
    double least = area(wheel.stops.front());
    for (int32_t i = root - 1; i >= 0; --i)
        if (score(i) == 0 && area(i) <= shrink * least) {
            below.push_back(i);
            least = area(i);
        }
    wheel.stops.insert(wheel.stops.begin(), below.rbegin(), below.rend());
    wheel.start = static_cast<size_t>(std::find(wheel.stops.begin(), wheel.stops.end(), clicked) - wheel.stops.begin());
    return wheel;
}

namespace {

// A click takes no stop with less than this share of the best score: it may be a sliver.
constexpr double min_relative_score = 0.3;

double best_score(std::span<const int32_t> stops, std::span<const double> scores) {
    double best = 0;
    for (const int32_t stop : stops) best = std::max(best, scores[idx(stop)]);
    return best;
}

}  // namespace

WheelStops assembly_wheel_stops(std::span<const double> areas, std::span<const double> scores, size_t shell) {
    WheelStops wheel = wheel_stops(areas.first(shell + 1), scores.first(shell + 1));
    if (shell + 1 == areas.size()) return wheel;
    if (areas[shell] < small_shell * areas.back()) {
        wheel.start = wheel.stops.size() - 1;
    } else if (const size_t largest = largest_click(wheel.stops, areas, scores, shell); largest < shell) {
        const auto end = std::ranges::upper_bound(wheel.stops, static_cast<int32_t>(largest));
        const auto score = [&](int32_t stop) { return scores[idx(stop)]; };
        const auto start = std::ranges::max_element(wheel.stops.begin(), end, {}, score);
        wheel.start = static_cast<size_t>(start - wheel.stops.begin());
    }
    std::vector<double> above(scores.begin() + static_cast<std::ptrdiff_t>(shell), scores.end());
    above[0] = 1;  // always a stop
    for (const int32_t stop : wheel_stops(areas.subspan(shell), above).stops)
        if (stop > 0) wheel.stops.push_back(static_cast<int32_t>(shell) + stop);
    return wheel;
}

size_t largest_click(std::span<const int32_t> stops, std::span<const double> areas, std::span<const double> scores,
                     size_t shell) {
    constexpr double max_share = 0.5, of_own_part = 1;
    const auto above = std::ranges::upper_bound(stops, static_cast<int32_t>(shell));
    const std::span within(stops.begin(), above);
    const double best = best_score(within, scores);
    if (shell + 1 == areas.size() || best >= of_own_part) return shell;
    size_t largest = shell;
    for (const int32_t stop : within)
        if (areas[idx(stop)] <= max_share * areas.back() && scores[idx(stop)] >= min_relative_score * best) largest = idx(stop);
    return largest;
}

size_t start_in_view(std::span<const int32_t> stops, std::span<const double> scores, std::span<const double> extents,
                     size_t largest, double view) {
    // See tests/quality/view.py and docs/decisions/fitted.md.
    constexpr double share = 0.5, weight = 0.6, ln2 = 0.69314718055994530942;
    const auto above = std::ranges::upper_bound(stops, static_cast<int32_t>(largest));
    const std::span candidates(stops.begin(), above);
    const double least_score = min_relative_score * best_score(candidates, scores);
    size_t best = 0;
    double best_value = -std::numeric_limits<double>::infinity();
    for (size_t s = 0; s < candidates.size(); ++s) {
        const size_t node = idx(candidates[s]);
        if (scores[node] < least_score) continue;
        const double octaves = log2_of(extents[node] / view) - log2_of(share);
        const double value = scores[node] - weight * ln2 * ln2 * octaves * octaves;
        if (value > best_value) {
            best_value = value;
            best = s;
        }
    }
    return best;
}

}  // namespace partwheel
