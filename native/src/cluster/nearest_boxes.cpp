// The nearest of many boxes: branch and bound by (distance, lowest id).
#include "cluster/nearest_boxes.h"

#include <algorithm>
#include <utility>

namespace partwheel {

namespace {

double squared_distance(const Box& a, const Box& b) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        const double gap = std::max({a.low[k] - b.high[k], b.low[k] - a.high[k], 0.0});
        sum += gap * gap;
    }
    return sum;
}

}  // namespace

NearestBoxes::NearestBoxes(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
    if (!boxes_.empty()) bound(0, 0, boxes_.size());
}

void NearestBoxes::bound(size_t node, size_t first, size_t last) {
    if (nodes_.size() <= node) nodes_.resize(node + 1);
    if (last - first == 1) {
        nodes_[node] = boxes_[first];
        return;
    }
    const size_t middle = first + (last - first) / 2;
    bound(2 * node + 1, first, middle);
    bound(2 * node + 2, middle, last);
    Box box = nodes_[2 * node + 1];
    box.add(nodes_[2 * node + 2].low);
    box.add(nodes_[2 * node + 2].high);
    nodes_[node] = box;
}

struct NearestBoxes::Search {
    using Neighbor = std::pair<double, size_t>;  // squared distance, id

    const NearestBoxes& boxes;
    const size_t own, count;
    std::vector<Neighbor> best{};  // a heap, the worst first

    // first: the lowest id in the node.
    bool may_improve(const Neighbor& least) const { return best.size() < count || least < best.front(); }

    void visit(size_t node, size_t first, size_t last, double squared) {
        if (!may_improve({squared, first})) return;
        if (last - first == 1) {
            if (first == own) return;
            if (best.size() == count) {
                std::pop_heap(best.begin(), best.end());
                best.pop_back();
            }
            best.push_back({squared, first});
            std::push_heap(best.begin(), best.end());
            return;
        }
        const size_t middle = first + (last - first) / 2;
        const Box& box = boxes.boxes_[own];
        const double lower = squared_distance(box, boxes.nodes_[2 * node + 1]);
        const double upper = squared_distance(box, boxes.nodes_[2 * node + 2]);
        if (upper < lower) visit(2 * node + 2, middle, last, upper);
        visit(2 * node + 1, first, middle, lower);
        if (!(upper < lower)) visit(2 * node + 2, middle, last, upper);
    }
};

std::vector<int32_t> NearestBoxes::nearest(size_t i, size_t count) const {
    std::vector<int32_t> ids;
    if (count == 0) return ids;
    Search search{*this, i, count};
    search.visit(0, 0, boxes_.size(), 0);
    std::sort_heap(search.best.begin(), search.best.end());
    for (const auto& [squared, id] : search.best) ids.push_back(static_cast<int32_t>(id));
    return ids;
}

}  // namespace partwheel
