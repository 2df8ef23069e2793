// Part trees without their empty parts.
#include "parts/part_tree.h"

namespace partwheel {

size_t number_in_sequence(std::span<int32_t> numbers) {
    int32_t count = 0;
    for (int32_t& number : numbers)
        if (number == 0) number = count++;
    return idx(count);
}

std::vector<int32_t> renumber_images(std::span<const int32_t> image, std::span<const int32_t> new_id, size_t count) {
    std::vector<int32_t> new_image(count, -1);
    for (size_t n = 0; n < image.size(); ++n)
        if (new_id[n] >= 0 && image[n] >= 0) new_image[idx(new_id[n])] = new_id[idx(image[n])];
    return new_image;
}

PartTree relabel(const PartTree& tree, std::span<const int32_t> label) {
    std::vector<int32_t> new_id(tree.count + tree.children.size(), -1);  // of each node
    for (const int32_t p : label) new_id[idx(p)] = 0;
    PartTree result;
    result.count = number_in_sequence(std::span(new_id).first(tree.count));
    for (const int32_t p : label) result.label.push_back(new_id[idx(p)]);
    for (size_t j = 0; j < tree.children.size(); ++j) {
        const int32_t a = new_id[idx(tree.children[j][0])], b = new_id[idx(tree.children[j][1])];
        int32_t& node = new_id[tree.count + j];
        node = std::max(a, b);
        if (a < 0 || b < 0) {  // the child that is left replaces the merge, also as the end of a larger one
            if (node >= static_cast<int32_t>(result.count) && !tree.is_intermediate[j])
                result.is_intermediate[idx(node) - result.count] = 0;
            continue;
        }
        node = static_cast<int32_t>(result.count + result.children.size());
        result.children.push_back({std::min(a, b), std::max(a, b)});
        result.costs.push_back(tree.costs[j]);
        result.is_intermediate.push_back(tree.is_intermediate[j]);
    }
    for (const std::vector<int32_t>& image : tree.mirror)
        result.mirror.push_back(renumber_images(image, new_id, result.count + result.children.size()));
    return result;
}

}  // namespace partwheel
