// Hulls at rest, one block of memory each from the kernel's pool, and what takes them to work and back: unions.
#include "cluster/hull/view.h"

#include <numeric>

namespace partwheel {

size_t Hull::Block::bytes(size_t vertices, size_t facets) {
    return sizeof(Block) + facets * (plane_numbers * sizeof(double) + sizeof(HullFacet)) +
           whole_fours(vertices) * sizeof(int32_t);
}
int32_t* Hull::Block::vertices() { return reinterpret_cast<int32_t*>(this + 1); }
double* Hull::Block::planes() { return reinterpret_cast<double*>(vertices() + whole_fours(vertex_count)); }
HullFacet* Hull::Block::facets() { return reinterpret_cast<HullFacet*>(planes() + plane_numbers * facet_count); }

void Hull::Release::operator()(Block* block) const {
    block->pool->free(block, Block::bytes(block->vertex_count, block->facet_count));
}

std::span<const int32_t> Hull::vertices() const {
    if (!block_) return {};
    return {block_->vertices(), block_->vertex_count};
}
std::span<const HullFacet> Hull::facets() const {
    if (!block_) return {};
    return {block_->facets(), block_->facet_count};
}

Hull HullKernel::allocate(std::span<const int32_t> vertices, size_t facets) {
    Hull hull;
    hull.block_.reset(new (pool_.allocate(Hull::Block::bytes(vertices.size(), facets))) Hull::Block{});
    hull.block_->pool = &pool_;
    hull.block_->vertex_count = static_cast<uint32_t>(vertices.size());
    hull.block_->facet_count = static_cast<uint32_t>(facets);
    int32_t* const to = hull.block_->vertices();
    std::fill(std::copy(vertices.begin(), vertices.end(), to), to + whole_fours(vertices.size()), -1);
    return hull;
}

TriangleMesh HullKernel::surface(const Hull& hull) const {
    TriangleMesh mesh;
    const auto corners = hull.vertices();
    for (const int32_t v : corners) mesh.vertices.push_back(at(v));
    for (const HullFacet& facet : hull.facets()) {
        Triangle t = facet.corners;
        for (int32_t& v : t)
            v = static_cast<int32_t>(std::lower_bound(corners.begin(), corners.end(), v) - corners.begin());
        mesh.triangles.push_back(t);
    }
    return mesh;
}

TriangleMesh hull_of(std::span<const Point> points) {
    HullKernel kernel(points);
    std::vector<int32_t> all(points.size());
    std::iota(all.begin(), all.end(), 0);
    return kernel.surface(kernel.build(all));
}

void HullKernel::load(const Hull& hull) {
    const FacetsView h = view(hull);
    if (h.count <= set_bits)
        for (const int32_t v : hull.vertices()) prefetch_line(&at(v));
    count_ = h.count;
    // One loop for all, for they are short and their length can't be foreseen.
    const double* const from[] = {h.x, h.y, h.z, h.offset, h.size};
    double* const to[] = {x_.data(), y_.data(), z_.data(), offset_.data(), size_.data()};
    for (size_t f = 0; f < count_; f += 2) {
        for (size_t k = 0; k < plane_numbers; ++k) std::memcpy(to[k] + f, from[k] + f, sizeof(Two));
        std::memcpy(&facets_[f], &h.facets[f], 2 * sizeof(HullFacet));
    }
    gaps_.clear();
    latest_ = 0;
    origin_ = h.origin;
    reach_ = h.reach;
    centred_ = h.centred;
    volume6_ = 6 * hull.volume();
    loaded_ = true;
}

// Moves the last facets into the gaps.
void HullKernel::close_gaps() {
    std::sort(gaps_.begin(), gaps_.end());
    for (size_t next = 0, end = gaps_.size(); next < end; --count_) {
        const size_t last = count_ - 1;
        if (gaps_[end - 1] == last) {
            --end;
            continue;
        }
        const size_t f = gaps_[next++];
        for (auto* numbers : {&x_, &y_, &z_, &offset_, &size_}) (*numbers)[f] = (*numbers)[last];
        facets_[f] = facets_[last];
        for (const int32_t n : facets_[f].neighbours) {
            Triangle& back = facets_[static_cast<size_t>(n)].neighbours;
            *std::find(back.begin(), back.end(), static_cast<int32_t>(last)) = static_cast<int32_t>(f);
        }
    }
    gaps_.clear();
}

// The hull at work; its vertices are among these, which are in rising order both.
Hull HullKernel::unload(std::span<const int32_t> some, std::span<const int32_t> others) {
    close_gaps();
    mark_corners();
    // Both lists merged, without a branch on what can't be foreseen.
    unloaded_.resize(some.size() + others.size() + 1);
    size_t vertices = 0;
    const auto take = [&](int32_t v) {
        unloaded_[vertices] = v;
        vertices += marked(v);
    };
    size_t i = 0, j = 0;
    while (i < some.size() && j < others.size()) {
        const int32_t a = some[i], b = others[j];
        take(std::min(a, b));
        i += a <= b;
        j += b <= a;
    }
    while (i < some.size()) take(some[i++]);
    while (j < others.size()) take(others[j++]);

    Hull hull = allocate({unloaded_.data(), vertices}, count_);
    Hull::Block& block = *hull.block_;
    double* const to = block.planes();
    HullFacet* const facets = block.facets();
    const double* const from[] = {x_.data(), y_.data(), z_.data(), offset_.data(), size_.data()};
    for (size_t f = 0; f < count_; f += 2) {
        for (size_t k = 0; k < plane_numbers; ++k) std::memcpy(to + k * count_ + f, from[k] + f, sizeof(Two));
        std::memcpy(&facets[f], &facets_[f], 2 * sizeof(HullFacet));
    }
    block.origin = origin_;
    block.reach = reach_;
    block.centred = centred_;
    // Measured anew, so that rounding doesn't pile up over a long chain of unions.
    Two sum = {0, 0};
    for (size_t f = 0; f < count_; f += 2) sum += vector_at<Two>(&offset_[f]);
    block.volume = (sum[0] + sum[1]) / 6;
    return hull;
}

Hull HullKernel::unite(const Hull& hull, std::span<const int32_t> points) {
    if (hull.facet_count() == 0) {
        std::vector<int32_t> all(hull.vertices().begin(), hull.vertices().end());
        all.insert(all.end(), points.begin(), points.end());
        return build(all);
    }
    // Often its volume has just been asked for. A hull of this kernel is known by its address: there is no other in its
    // place before one has been made here, which forgets the survey. One of another kernel's isn't.
    const bool surveyed = surveyed_ == hull.block_.get() && hull.block_->pool == &pool_ &&
                          std::ranges::equal(surveyed_points_, points);
    if (!surveyed) survey(hull, points);
    surveyed_ = nullptr;
    if (!loaded_) load(hull);
    while (inserted_ < candidates_.size()) insert(candidates_[inserted_++].vertex);
    vertices_.clear();
    for (const Candidate& c : candidates_) vertices_.push_back(c.vertex);
    std::sort(vertices_.begin(), vertices_.end());
    return unload(hull.vertices(), vertices_);
}

Box HullKernel::bounds(const Hull& hull) const {
    Box box;
    for (const int32_t v : hull.vertices()) box.add(at(v));
    return box;
}

}  // namespace partwheel
