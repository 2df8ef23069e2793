// Finds the nearest of many boxes by branch and bound; orders them by (distance, index).
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
    if (!boxes_.empty()) build_node(0, 0, boxes_.size());
}

void NearestBoxes::build_node(size_t node, size_t first, size_t last) {
    if (nodes_.size() <= node) nodes_.resize(node + 1);
    if (last - first == 1) {
        nodes_[node] = boxes_[first];
        return;
    }
    const size_t middle = first + (last - first) / 2;
    build_node(2 * node + 1, first, middle);
    build_node(2 * node + 2, middle, last);
    Box box = nodes_[2 * node + 1];
    box.add(nodes_[2 * node + 2].low);
    box.add(nodes_[2 * node + 2].high);
    nodes_[node] = box;
}

struct NearestBoxes::Search {
    using Neighbor = std::pair<double, size_t>;  // squared distance, index

    const NearestBoxes& boxes;
    const size_t query, count;      // the box whose neighbors are searched, and how many
    std::vector<Neighbor> best{};  // a heap whose front is the worst

    bool may_improve(const Neighbor& lower_bound) const { return best.size() < count || lower_bound < best.front(); }

    // squared: the distance of the node's box.
    void visit(size_t node, size_t first, size_t last, double squared) {
        if (!may_improve({squared, first})) return;
        if (last - first == 1) {
            if (first == query) return;
            if (best.size() == count) {
                std::pop_heap(best.begin(), best.end());
                best.pop_back();
            }
            best.push_back({squared, first});
            std::push_heap(best.begin(), best.end());
            return;
        }
        const size_t middle = first + (last - first) / 2;
        const Box& box = boxes.boxes_[query];
        const double left = squared_distance(box, boxes.nodes_[2 * node + 1]);
        const double right = squared_distance(box, boxes.nodes_[2 * node + 2]);
        if (right < left) visit(2 * node + 2, middle, last, right);
        visit(2 * node + 1, first, middle, left);
        if (!(right < left)) visit(2 * node + 2, middle, last, right);
    }
};

std::vector<int32_t> NearestBoxes::nearest(size_t i, size_t count) const {
    std::vector<int32_t> indices;
    if (count == 0) return indices;
    Search search{*this, i, count};
    search.visit(0, 0, boxes_.size(), 0);
    std::sort_heap(search.best.begin(), search.best.end());
    for (const auto& [squared, index] : search.best) indices.push_back(static_cast<int32_t>(index));
    return indices;
}

}  // namespace partwheel
