// The joins of one side, and with each of them those of its images.
#include "parts/mirror/mirror_tree.h"

#include "base/adjacency.h"
#include "parts/mirror/mirror_parts.h"
#include "parts/mirror/propagate.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace partwheel {

namespace {

// Parts copied from side to side may leave scraps that nothing joins: up to this share of the area.
constexpr double largest_scrap = 0.1;

class Joining {
public:
    Joining(const TetLabels& parts, std::span<const double> areas)
        : above_(areas.size(), -1) {
        for (const double area : areas) areas_.push_back(static_cast<float>(area));
        images = parts.images;
    }

    // What it has become.
    int32_t now(int32_t part) const {
        while (part >= 0 && above_[idx(part)] >= 0) part = above_[idx(part)];
        return part;
    }

    // The two and their images, all at once.
    void join(int32_t a, int32_t b, double cost) {
        std::vector<std::array<int32_t, 2>> all = {{a, b}};
        for (const std::vector<int32_t>& image : images)
            for (size_t i = 0, n = all.size(); i < n; ++i) {
                const std::array<int32_t, 2> there = {image[idx(all[i][0])], image[idx(all[i][1])]};
                if (free(there[0]) && free(there[1]) && there[0] != there[1] &&
                    std::ranges::find(all, there) == all.end())
                    all.push_back(there);
            }
        std::vector<int32_t> members;
        for (const auto& two : all) members.insert(members.end(), two.begin(), two.end());
        std::ranges::sort(members);
        members.erase(std::unique(members.begin(), members.end()), members.end());
        const auto place = [&](int32_t part) {
            return static_cast<size_t>(std::ranges::lower_bound(members, part) - members.begin());
        };
        UnionFind sets(members.size());
        for (const auto& [one, other] : all) sets.join(place(one), place(other));
        std::map<size_t, std::vector<int32_t>> of_set;
        for (size_t i = 0; i < members.size(); ++i) of_set[sets.find(i)].push_back(members[i]);
        for (const auto& [set, together] : of_set) {
            const auto made = static_cast<int32_t>(above_.size());
            double area = 0;
            for (const int32_t member : together) {
                above_[idx(member)] = made;
                area += areas_[idx(member)];
            }
            above_.push_back(-1);
            areas_.push_back(static_cast<float>(area));
            joins.push_back({in_reach(together, all), cost});
        }
        for (std::vector<int32_t>& image : images) {
            image.resize(above_.size(), -1);
            for (const auto& [set, together] : of_set) find_image(image, together);
        }
    }

    // What is no part of another, the largest first.
    std::vector<int32_t> left() const {
        std::vector<int32_t> tops;
        for (size_t p = 0; p < above_.size(); ++p)
            if (above_[p] < 0) tops.push_back(static_cast<int32_t>(p));
        std::ranges::stable_sort(tops, [&](int32_t a, int32_t b) { return areas_[idx(a)] > areas_[idx(b)]; });
        return tops;
    }

    double area(int32_t part) const { return areas_[idx(part)]; }

    // What is joined at once.
    struct Together {
        std::vector<int32_t> members;
        double cost;
    };
    std::vector<Together> joins;  // join i makes number parts + i
    std::vector<std::vector<int32_t>> images;  // by plane, of all numbers

private:
    // From the one that is paired most on, each is paired with one before it.
    static std::vector<int32_t> in_reach(const std::vector<int32_t>& together,
                                         std::span<const std::array<int32_t, 2>> pairs) {
        const auto count = [&](int32_t member) {
            return std::ranges::count_if(pairs, [&](const auto& two) { return two[0] == member || two[1] == member; });
        };
        std::vector<int32_t> order = {*std::ranges::max_element(together, {}, count)};
        for (size_t i = 0; i < order.size(); ++i)
            for (const auto& [one, other] : pairs)
                for (const auto& [from, to] : {std::pair(one, other), std::pair(other, one)})
                    if (from == order[i] && std::ranges::find(order, to) == order.end()) order.push_back(to);
        return order;
    }

    bool free(int32_t part) const { return part >= 0 && above_[idx(part)] < 0; }

    // The image of what was made is what that of its largest member that has one has become.
    void find_image(std::vector<int32_t>& image, const std::vector<int32_t>& together) const {
        const int32_t made = above_[idx(together[0])];
        double largest = -1;
        for (const int32_t member : together) {
            const int32_t other = now(image[idx(member)]);
            if (other < 0 || areas_[idx(member)] <= largest) continue;
            largest = areas_[idx(member)];
            image[idx(made)] = other;
        }
        if (largest >= 0) image[idx(image[idx(made)])] = made;
    }

    std::vector<double> areas_;  // in single precision, so that those tie that do by symmetry
    std::vector<int32_t> above_;
};

// Two at a time.
PartTree in_steps(const Joining& joining, const TetLabels& parts) {
    PartTree result{parts.of, parts.count, {}, {}, {}, {}};
    std::vector<int32_t> number(parts.count);  // of each number of the joining
    std::iota(number.begin(), number.end(), 0);
    for (const auto& [members, cost] : joining.joins) {
        int32_t made = number[idx(members[0])];
        for (size_t i = 1; i < members.size(); ++i) {
            result.joined.push_back({made, number[idx(members[i])]});
            result.costs.push_back(cost);
            result.steps.push_back(i + 1 < members.size());
            made = static_cast<int32_t>(parts.count + result.joined.size() - 1);
        }
        number.push_back(made);
    }
    for (const std::vector<int32_t>& image : joining.images) {
        std::vector<int32_t> there(parts.count + result.joined.size(), -1);
        for (size_t n = 0; n < number.size(); ++n)
            if (image[n] >= 0) there[idx(number[n])] = number[idx(image[n])];
        result.images.push_back(std::move(there));
    }
    return result;
}

}  // namespace

PartTree merge_symmetrically(const TetLabels& parts, std::span<const double> areas, const PartTree& before, double scrap,
                   std::vector<int32_t>& scraps) {
    Joining joining(parts, areas);
    std::vector<int32_t> stands = parts.stands;
    for (size_t j = 0; j < before.joined.size(); ++j) {
        const auto& [one, other] = before.joined[j];
        const int32_t a = joining.now(stands[idx(one)]), b = joining.now(stands[idx(other)]);
        if (a >= 0 && b >= 0 && a != b) joining.join(a, b, before.costs[j]);
        stands.push_back(a >= 0 ? a : b);
    }
    // Two sides that only meet in the plane are joined last; each time their images go along.
    double whole = 0;
    for (const double area : areas) whole += area;
    std::vector<int32_t> left = joining.left();
    while (left.size() > 1 && joining.area(left[1]) >= scrap * whole) {
        joining.join(left[0], left[1], before.costs.empty() ? 0 : before.costs.back());
        left = joining.left();
    }
    scraps.clear();
    if (left.size() == 1) return in_steps(joining, parts);
    for (size_t p = 0; p < parts.count; ++p)
        if (joining.now(static_cast<int32_t>(p)) != left[0]) scraps.push_back(static_cast<int32_t>(p));
    return {};
}

PartTree mirror_tree(const TetMesh& mesh, std::span<const Plane> planes, const PartTree& joins, std::span<const double> worth,
            Progress& progress) {
    TetLabels parts = mirrored(mesh, planes, joins.of, joins.count, worth, progress);
    std::vector<int32_t> scraps;
    for (double scrap = largest_scrap;;) {
        std::vector<double> areas(parts.count, 0);
        for (size_t t = 0; t < parts.of.size(); ++t)
            for (size_t k = 0; k < 4; ++k)
                if (mesh.neighbors[t][k] < 0) areas[idx(parts.of[t])] += facet_area(mesh, t, k);
        PartTree joined = merge_symmetrically(parts, areas, joins, scrap, scraps);
        if (scraps.empty()) return joined;
        const size_t before = parts.count;
        parts = dissolve_parts(mesh, std::move(parts), scraps, progress);
        if (parts.count == before) scrap = 0;  // they have no neighbours
    }
}

}  // namespace partwheel
