// The joins of one side, and with each of them those of its images.
#include "tree/mirror/alike.h"

#include "base/groups.h"

#include <algorithm>
#include <map>
#include <utility>

namespace partwheel {

namespace {

class Joining {
public:
    Joining(const PartsOfTetrahedra& parts, std::span<const double> areas)
        : areas_(areas.begin(), areas.end()), above_(areas.size(), -1) {
        result.images = parts.images;
    }

    // What it has become.
    int32_t now(int32_t part) const {
        while (part >= 0 && above_[at(part)] >= 0) part = above_[at(part)];
        return part;
    }

    // The two and their images, all at once.
    void join(int32_t a, int32_t b, double cost) {
        std::vector<std::array<int32_t, 2>> all = {{a, b}};
        for (const std::vector<int32_t>& image : result.images)
            for (size_t i = 0, n = all.size(); i < n; ++i) {
                const std::array<int32_t, 2> there = {image[at(all[i][0])], image[at(all[i][1])]};
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
        Joined sets(members.size());
        for (const auto& [one, other] : all) sets.join(place(one), place(other));
        std::map<size_t, std::vector<int32_t>> of_set;
        for (size_t i = 0; i < members.size(); ++i) of_set[sets.find(i)].push_back(members[i]);
        for (const auto& [set, together] : of_set) {
            const auto made = static_cast<int32_t>(above_.size());
            double area = 0;
            for (const int32_t member : together) {
                above_[at(member)] = made;
                area += areas_[at(member)];
            }
            above_.push_back(-1);
            areas_.push_back(area);
            result.joins.push_back({together, cost});
        }
        for (std::vector<int32_t>& image : result.images) {
            image.resize(above_.size(), -1);
            for (const auto& [set, together] : of_set) find_image(image, together);
        }
    }

    // What is no part of another, the largest first.
    std::vector<int32_t> left() const {
        std::vector<int32_t> tops;
        for (size_t p = 0; p < above_.size(); ++p)
            if (above_[p] < 0) tops.push_back(static_cast<int32_t>(p));
        std::ranges::stable_sort(tops, [&](int32_t a, int32_t b) { return areas_[at(a)] > areas_[at(b)]; });
        return tops;
    }

    double area(int32_t part) const { return areas_[at(part)]; }

    Alike result;

private:
    bool free(int32_t part) const { return part >= 0 && above_[at(part)] < 0; }

    // The image of what was made is what that of its largest member that has one has become.
    void find_image(std::vector<int32_t>& image, const std::vector<int32_t>& together) const {
        const int32_t made = above_[at(together[0])];
        double largest = -1;
        for (const int32_t member : together) {
            const int32_t other = now(image[at(member)]);
            if (other < 0 || areas_[at(member)] <= largest) continue;
            largest = areas_[at(member)];
            image[at(made)] = other;
        }
        if (largest >= 0) image[at(image[at(made)])] = made;
    }

    std::vector<double> areas_;
    std::vector<int32_t> above_;
};

}  // namespace

Alike joined_alike(const PartsOfTetrahedra& parts, std::span<const double> areas,
                   std::span<const std::array<int32_t, 2>> joined, std::span<const double> costs,
                   double scrap) {
    Joining joining(parts, areas);
    double whole = 0;
    for (const double area : areas) whole += area;
    std::vector<int32_t> stands = parts.stands;
    for (size_t j = 0; j < joined.size(); ++j) {
        const int32_t a = joining.now(stands[at(joined[j][0])]), b = joining.now(stands[at(joined[j][1])]);
        if (a >= 0 && b >= 0 && a != b) joining.join(a, b, costs[j]);
        stands.push_back(a >= 0 ? a : b);
    }
    // Two sides that only meet in the plane are joined last; each time their images go along.
    std::vector<int32_t> left = joining.left();
    while (left.size() > 1 && joining.area(left[1]) >= scrap * whole) {
        joining.join(left[0], left[1], costs.empty() ? 0 : costs.back());
        left = joining.left();
    }
    if (left.size() == 1) return std::move(joining.result);
    Alike none;
    for (size_t p = 0; p < areas.size(); ++p)
        if (joining.now(static_cast<int32_t>(p)) != left[0]) none.scraps.push_back(static_cast<int32_t>(p));
    return none;
}

}  // namespace partwheel
