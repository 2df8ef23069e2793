// Stored hulls, each in one memory block of the kernel's pool; loading and storing them; unions.
#include "hull/view.h"

#include "base/sorted.h"

namespace partwheel {

size_t Hull::Block::bytes(size_t vertices, size_t facets) {
    return sizeof(Block) + facets * (plane_values * sizeof(double) + sizeof(HullFacet)) +
           round_up_to_4(vertices) * sizeof(int32_t);
}
int32_t* Hull::Block::vertices() { return reinterpret_cast<int32_t*>(this + 1); }
double* Hull::Block::planes() { return reinterpret_cast<double*>(vertices() + round_up_to_4(vertex_count)); }
HullFacet* Hull::Block::facets() { return reinterpret_cast<HullFacet*>(planes() + plane_values * facet_count); }

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
    std::fill(std::copy(vertices.begin(), vertices.end(), to), to + round_up_to_4(vertices.size()), -1);
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

TriangleMesh convex_hull(std::span<const Point> points, Progress& progress) {
    HullKernel kernel(points, progress);
    return kernel.surface(kernel.build(iota(points.size())));
}

void HullKernel::load(const Hull& hull) {
    const FacetsView h = view(hull);
    count_visits(h.count);
    if (h.count <= max_bitset_facets)
        for (const int32_t v : hull.vertices()) prefetch_line(&at(v));
    count_ = h.count;
    // One loop over all five arrays, because they are short and their length is unpredictable.
    const double* const from[] = {h.x, h.y, h.z, h.offset, h.size};
    double* const to[] = {x_.data(), y_.data(), z_.data(), offset_.data(), size_.data()};
    for (size_t f = 0; f < count_; f += 2) {
        for (size_t k = 0; k < plane_values; ++k) std::memcpy(to[k] + f, from[k] + f, sizeof(Double2));
        std::memcpy(&facets_[f], &h.facets[f], 2 * sizeof(HullFacet));
    }
    free_facets_.clear();
    newest_facet_ = 0;
    origin_ = h.origin;
    radius_ = h.radius;
    origin_is_inside_ = h.origin_is_inside;
    volume6_ = 6 * hull.volume();
    loaded_ = true;
}

// Moves the last facets into the free entries.
void HullKernel::compact_facets() {
    std::sort(free_facets_.begin(), free_facets_.end());
    for (size_t next = 0, end = free_facets_.size(); next < end; --count_) {
        const size_t last = count_ - 1;
        if (free_facets_[end - 1] == last) {
            --end;
            continue;
        }
        const size_t f = free_facets_[next++];
        for (auto* numbers : {&x_, &y_, &z_, &offset_, &size_}) (*numbers)[f] = (*numbers)[last];
        facets_[f] = facets_[last];
        for (const int32_t n : facets_[f].neighbors) {
            Triangle& back = facets_[static_cast<size_t>(n)].neighbors;
            *std::find(back.begin(), back.end(), static_cast<int32_t>(last)) = static_cast<int32_t>(f);
        }
    }
    free_facets_.clear();
}

// Stores the loaded hull. Its vertices are among `first`, ascending, and `second`.
Hull HullKernel::unload(std::span<const int32_t> first, std::vector<int32_t>& second) {
    compact_facets();
    mark_corners();
    std::erase_if(second, [&](int32_t v) { return !is_marked(v); });  // most: sorting them would cost more
    sort_unique(second);
    // Merges both lists without unpredictable branches.
    unloaded_.resize(first.size() + second.size() + 1);
    size_t vertices = 0;
    const auto take = [&](int32_t v) {
        unloaded_[vertices] = v;
        vertices += is_marked(v);
    };
    size_t i = 0, j = 0;
    while (i < first.size() && j < second.size()) {
        const int32_t a = first[i], b = second[j];
        take(std::min(a, b));
        i += a <= b;
        j += b <= a;
    }
    while (i < first.size()) take(first[i++]);
    while (j < second.size()) take(second[j++]);

    Hull hull = allocate({unloaded_.data(), vertices}, count_);
    Hull::Block& block = *hull.block_;
    double* const to = block.planes();
    HullFacet* const facets = block.facets();
    const double* const from[] = {x_.data(), y_.data(), z_.data(), offset_.data(), size_.data()};
    for (size_t f = 0; f < count_; f += 2) {
        for (size_t k = 0; k < plane_values; ++k) std::memcpy(to + k * count_ + f, from[k] + f, sizeof(Double2));
        std::memcpy(&facets[f], &facets_[f], 2 * sizeof(HullFacet));
    }
    block.origin = origin_;
    block.radius = radius_;
    block.origin_is_inside = origin_is_inside_;
    // Recomputed, so that rounding errors don't accumulate over a long chain of unions.
    Double2 sum = {0, 0};
    for (size_t f = 0; f < count_; f += 2) sum += vector_at<Double2>(&offset_[f]);
    block.volume = (sum[0] + sum[1]) / 6;
    return hull;
}

Hull HullKernel::unite(const Hull& hull, std::span<const int32_t> points) {
    if (hull.facet_count() == 0) {
        std::vector<int32_t> vertices(hull.vertices().begin(), hull.vertices().end());
        vertices.insert(vertices.end(), points.begin(), points.end());
        return build(vertices);
    }
    // The caller has often just computed the volume of this union. A hull of this kernel is identified by its
    // address: no other hull can get that address before this kernel makes one, which clears candidates_hull_. Hulls
    // of other kernels are not.
    const bool is_current = candidates_hull_ == hull.block_.get() && hull.block_->pool == &pool_ &&
                          std::ranges::equal(candidates_points_, points);
    if (!is_current) collect_candidates(hull, points);
    candidates_hull_ = nullptr;
    if (!loaded_) load(hull);
    while (inserted_count_ < candidates_.size()) insert(candidates_[inserted_count_++].vertex);
    vertices_.clear();
    for (const Candidate& c : candidates_) vertices_.push_back(c.vertex);
    return unload(hull.vertices(), vertices_);
}

Box HullKernel::bounds(const Hull& hull) const {
    Box box;
    for (const int32_t v : hull.vertices()) box.add(at(v));
    return box;
}

}  // namespace partwheel
