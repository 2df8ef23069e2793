// Convex hulls by insertion of points (beneath-beyond).
//
// A point that sees no facet from strictly outside is in the hull. Otherwise all facets that it sees, those in whose
// plane it lies included, are taken away, and the rim of the hole is joined to it. Taking the coplanar ones away too
// keeps the vertices exactly the extreme points, and no degenerate facet can arise: an edge of the rim has a facet on
// its far side that strictly doesn't see the point, so the point is not on the edge's line.
//
// The hulls of clusters are mostly tiny: there all facets are tested, two at a time, and those that see the point are a
// set of bits. On a hull of more facets than a set has bits a walk finds one of them, the others are found from there.
// What a point sees can't be foreseen, so the inner loops don't branch on it.
#include "cluster/hull.h"

#include "base/large_pages.h"
#include "base/predicates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <new>
#include <vector>

namespace partwheel {

namespace {

// From so many facets on, points that are to be added are taken as they come, rather than tested first for what they add.
constexpr size_t large_hull = 32;

// Then every so many-th point is first, then those halfway between, and so on: as vertices are numbered along a curve
// through space, the first few are from all over and add most of what all will.
constexpr size_t first_stride = 64;

// A point that adds less than this part of the hull's volume does not count when the volume is all that is asked for.
constexpr double negligible = 1e-14;

// So many points are asked for ahead of use: more would take longer than they are waited for.
constexpr size_t few_points = 8;

// So many facets at most are a set of bits.
constexpr size_t set_bits = 64;

constexpr size_t next_corner[3] = {1, 2, 0};

// One vector register of every 64-bit machine. A closed surface of triangles has an even number of facets.
using Pair = double __attribute__((vector_size(16)));
using PairBits = int64_t __attribute__((vector_size(16)));
using Four = int32_t __attribute__((vector_size(16)));

template <class Vector, class Number>
Vector vector_at(const Number* numbers) {
    Vector v;
    std::memcpy(&v, numbers, sizeof v);
    return v;
}

// Bit k is set if number k is negative.
unsigned signs(Pair x) {
#if defined(__SSE2__)
    return static_cast<unsigned>(__builtin_ia32_movmskpd(x));
#else
    const auto bits = std::bit_cast<std::array<uint64_t, 2>>(x);
    return static_cast<unsigned>(bits[0] >> 63 | bits[1] >> 63 << 1);
#endif
}

constexpr size_t whole_fours(size_t n) { return (n + 3) / 4 * 4; }

// Among numbers that have been filled up to whole fours.
bool contains(std::span<const int32_t> numbers, int32_t v) {
    Four equal = {0, 0, 0, 0};
    for (size_t i = 0; i < numbers.size(); i += 4) equal |= vector_at<Four>(&numbers[i]) == v;
    const auto halves = std::bit_cast<std::array<int64_t, 2>>(equal);
    return (halves[0] | halves[1]) != 0;
}

Pair magnitude(Pair x) {
    return std::bit_cast<Pair>(std::bit_cast<PairBits>(x) & std::numeric_limits<int64_t>::max());
}

// The larger of 0 and each number.
Pair positive(Pair x) { return std::bit_cast<Pair>(std::bit_cast<PairBits>(x) & (x > 0)); }

// Twice the larger of 0 and x, without a branch.
double twice_positive(double x) { return x + std::fabs(x); }

double reach_of(const Point& p) { return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}); }

// The planes of facets. Of a point p relative to the hull's origin, x px + y py + z pz - offset is six times the volume
// of facet and p.
struct Plane {
    Point normal;
    double offset;
    double size;  // the sum of the absolute products in the normal
};

// A side is wrong by at most size * reach * this, where reach bounds the coordinates of the point and of the hull's
// vertices relative to the origin: 4 roundings in a normal, 2 in the two differences with the origin, 3 in each dot
// product, all of these twice as the difference of point and vertex is up to 2 reach, and 2 in the last subtraction.
constexpr double side_error = 24 * 0x1p-53;

constexpr size_t plane_numbers = 5;

}  // namespace

// ---- Hulls at rest: one block of memory each, from the kernel's pool -----------------------------------------------

size_t Hull::Block::bytes(size_t vertices, size_t facets) {
    return sizeof(Block) + facets * (plane_numbers * sizeof(double) + sizeof(HullFacet)) +
           whole_fours(vertices) * sizeof(int32_t);
}
int32_t* Hull::Block::vertices() { return reinterpret_cast<int32_t*>(this + 1); }
double* Hull::Block::planes() { return reinterpret_cast<double*>(vertices() + whole_fours(vertex_count)); }
HullFacet* Hull::Block::facets() { return reinterpret_cast<HullFacet*>(planes() + plane_numbers * facet_count); }

// Free blocks in lists by size; what is larger comes from the system.
class Hull::Pool {
public:
    Pool() = default;
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;
    ~Pool() {
        ::operator delete(first_chunk_, std::align_val_t{unit});
        for (void* chunk : chunks_) free_large(chunk);
    }

    void* allocate(size_t bytes) {
        const size_t units = (bytes + unit - 1) / unit;
        if (units >= classes) return ::operator new(units * unit, std::align_val_t{unit});
        if (Free* head = free_[units]) {
            free_[units] = head->next;
            return head;
        }
        if (left_ < units * unit) {
            add_chunk();
        }
        left_ -= units * unit;
        return std::exchange(next_, next_ + units * unit);
    }

    void free(void* block, size_t bytes) {
        const size_t units = (bytes + unit - 1) / unit;
        if (units >= classes)
            ::operator delete(block, std::align_val_t{unit});
        else
            free_[units] = new (block) Free{free_[units]};
    }

private:
    void add_chunk() {
        if (!first_chunk_) {  // in small pages: there may be no need for a large one
            left_ = large_page / 4;
            next_ = static_cast<std::byte*>(first_chunk_ = ::operator new(left_, std::align_val_t{unit}));
        } else {
            chunks_.reserve(chunks_.size() + 1);
            chunks_.push_back(allocate_large(large_page));
            next_ = static_cast<std::byte*>(chunks_.back());
            left_ = large_page;
        }
    }

    static constexpr size_t unit = 64, classes = 128;
    struct Free {
        Free* next;
    };
    Free* free_[classes] = {};
    void* first_chunk_ = nullptr;
    std::vector<void*> chunks_;
    std::byte* next_ = nullptr;
    size_t left_ = 0;
};

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

// ---- The kernel ----------------------------------------------------------------------------------------------------

class HullKernel::Impl {
public:
    explicit Impl(std::span<const Point> points) {
        points_.reserve(points.size());
        for (const Point& p : points) points_.push_back({p});
        reserve(64);
    }

    Hull build(std::span<const int32_t> vertices);
    Hull unite(const Hull& hull, std::span<const int32_t> points);
    Measure united_volume(const Hull& hull, std::span<const int32_t> points, double enough);
    void prefetch(std::span<const int32_t> points) const {
        for (const int32_t v : points.first(std::min(points.size(), few_points))) prefetch_line(&at(v));
    }
    std::pair<Point, Point> bounds(const Hull& hull) const;

private:
    // A hull's facets, at rest or at work.
    struct View {
        const double *x, *y, *z, *offset, *size;
        const HullFacet* facets;
        size_t count;
        Point origin;
        double reach;
        bool centred;

        double side(size_t f, const Point& p) const { return x[f] * p[0] + y[f] * p[1] + z[f] * p[2] - offset[f]; }
        Pair sides(size_t f, const Point& p) const {
            return vector_at<Pair>(x + f) * p[0] + vector_at<Pair>(y + f) * p[1] + vector_at<Pair>(z + f) * p[2] -
                   vector_at<Pair>(offset + f);
        }
        // A facet's size times this bounds the error of a side.
        double error_factor(const Point& p) const { return side_error * std::max(reach, reach_of(p)); }
    };

    // A point that may be outside.
    struct Candidate {
        double volume6 = 0;  // six times what it alone adds to the hull, to rounding; infinity if not known
        int32_t vertex = 0;
    };

    // With what is noted of it, so that all comes from memory at once.
    struct alignas(32) Vertex {
        Point place;
        uint32_t mark = 0;         // stamp_: it is one of those in question
        int32_t facet_from = -1;   // the new facet whose rim edge starts here
    };

    struct RimEdge {
        int32_t from, to;
        int32_t beyond;  // the facet that stays
    };

    static constexpr size_t none = ~size_t{0}, inside = none - 1;  // in place of a facet

    const Point& at(int32_t v) const { return points_[static_cast<size_t>(v)].place; }
    void mark(int32_t v) { points_[static_cast<size_t>(v)].mark = stamp_; }
    bool marked(int32_t v) const { return points_[static_cast<size_t>(v)].mark == stamp_; }
    void mark_corners() {  // of the hull at work, and no other vertex
        ++stamp_;
        for (size_t f = 0; f < count_; ++f)
            for (const int32_t v : facets_[f].corners) mark(v);
    }
    static View view(const Hull& hull);
    View view() const;

    int exact_side(const View& h, size_t f, int32_t vertex) const;
    size_t walk(const View& h, const Point& p, size_t start);
    static bool surely_best(const View& h, size_t f, const Point& p);
    size_t find_seen(const View& h, const Point& p, int32_t vertex, size_t start);
    double flood(const View& h, size_t f, const Point& p, int32_t vertex);
    static std::array<double, 2> added_volumes6(const View& h, const Point& p, const Point& q);
    static bool surely_inside(const View& h, const Point& p);
    void survey(const Hull& hull, std::span<const int32_t> points);

    void reserve(size_t facets) {
        if (facets_.size() < 3 * facets + 3) [[unlikely]]
            make_room(facets);
    }
    void make_room(size_t facets);
    void load(const Hull& hull);
    Plane plane(const Triangle& corners) const;
    void set_plane(size_t f, const Plane& plane);
    double look(int32_t vertex);
    double see(const Point& p, int32_t vertex);
    void attach(int32_t vertex);
    void insert(int32_t vertex);
    void make_facets(std::span<const RimEdge> rim, const Point& p, int32_t vertex);
    void close_gaps();
    Hull unload(std::span<const int32_t> some, std::span<const int32_t> others);
    Hull allocate(std::span<const int32_t> vertices, size_t facets);
    bool load_simplex(std::span<const int32_t> vertices);

    LargeVector<Vertex> points_;
    Hull::Pool pool_;

    // The hull at work: its facets are in the first count_ places, but for the gaps.
    size_t count_ = 0;
    std::vector<double> x_, y_, z_, offset_, size_;
    std::vector<HullFacet> facets_;
    std::vector<uint32_t> gaps_;
    size_t latest_ = 0;  // one of them: the newest, if any has been made
    Point origin_{};
    double reach_ = 0;
    bool centred_ = false;
    double volume6_ = 0;

    // What the last survey found, of these arguments, in the order to insert them. The first inserted_ are in the hull at
    // work, if that is loaded_.
    const Hull::Block* surveyed_ = nullptr;
    std::vector<int32_t> surveyed_points_;
    std::vector<Candidate> candidates_;
    std::vector<int32_t> others_;  // scratch of survey()
    size_t inserted_ = 0;
    bool loaded_ = false;

    // Scratch.
    size_t seen_count_ = 0, rim_count_ = 0;
    std::vector<uint32_t> seen_;        // the facets that the last point flooded from sees
    std::vector<RimEdge> rim_;          // the edges around them
    std::vector<uint32_t> facet_mark_;  // facet_mark_[f] == facet_stamp_: f is one of those in question
    uint32_t facet_stamp_ = 0;
    uint32_t stamp_ = 0;  // of vertices, in the same manner
    std::vector<int32_t> vertices_;
    std::vector<int32_t> unloaded_;
};

HullKernel::Impl::View HullKernel::Impl::view(const Hull& hull) {
    Hull::Block& b = *hull.block_;
    const size_t n = b.facet_count;
    const double* p = b.planes();
    return {p, p + n, p + 2 * n, p + 3 * n, p + 4 * n, b.facets(), n, b.origin, b.reach, b.centred};
}

HullKernel::Impl::View HullKernel::Impl::view() const {
    return {x_.data(),    y_.data(),      z_.data(), offset_.data(), size_.data(),
            facets_.data(), count_, origin_, reach_, centred_};
}

// 1: the vertex is outside the facet, 0: in its plane.
int HullKernel::Impl::exact_side(const View& h, size_t f, int32_t vertex) const {
    const Triangle& t = h.facets[f].corners;
    return orientation(at(t[0]), at(t[1]), at(t[2]), at(vertex));
}

// Looks for a facet that surely sees p by going to better and better neighbours; `inside` if p surely is. None if it
// finds neither.
//
// Better is what the ray from the origin to p meets later, relative to its length: that is a linear function of the
// facets' polar points, and these are the corners of a convex polytope, so that with exact numbers no facet but the
// best would be without a better neighbour. (Nearly) equally good ones, as in coplanar facets, are tried once each.
size_t HullKernel::Impl::walk(const View& h, const Point& p, size_t start) {
    constexpr double equal = 1e-9;
    const double factor = h.error_factor(p);
    ++facet_stamp_;
    const auto rate = [&](size_t f) { return h.offset[f] > 0 ? h.side(f, p) / h.offset[f] : -HUGE_VAL; };
    size_t f = start;
    for (double here = rate(f); h.side(f, p) <= h.size[f] * factor;) {
        facet_mark_[f] = facet_stamp_;
        size_t best = f;
        double there = -HUGE_VAL;
        for (const int32_t n : h.facets[f].neighbours) {
            const auto g = static_cast<size_t>(n);
            const double rated = facet_mark_[g] == facet_stamp_ ? -HUGE_VAL : rate(g);
            best = rated > there ? g : best;
            there = std::max(there, rated);
        }
        if (!(there >= here - equal)) return h.centred && surely_best(h, f, p) ? inside : none;
        f = best;
        here = there;
    }
    return f;
}

// Whether, with exact numbers, p is inside of facet f, and f better than each of its neighbours in the sense of walk():
// then it is better than all others, for only facets with no coplanar neighbour can be, and their polar points have
// just three edges; and p is inside of all.
bool HullKernel::Impl::surely_best(const View& h, size_t f, const Point& p) {
    constexpr double rounding = 1 + 1e-14;  // more than that of the products
    const double factor = h.error_factor(p);
    const double error = factor * h.size[f], side = h.side(f, p);
    if (!(side + error < 0 && h.offset[f] > error)) return false;
    for (const int32_t n : h.facets[f].neighbours) {
        const auto g = static_cast<size_t>(n);
        const double error_g = factor * h.size[g], side_g = h.side(g, p);
        if (!(side_g + error_g < 0 && h.offset[g] > error_g)) return false;
        if (!((side_g + error_g) * (h.offset[f] - error) < (side - error) * (h.offset[g] + error_g) * rounding))
            return false;
    }
    return true;
}

// Some facet that the vertex is strictly outside of; none if it is in the hull. p is the vertex relative to the origin,
// start a facet near it, if one is known.
size_t HullKernel::Impl::find_seen(const View& h, const Point& p, int32_t vertex, size_t start) {
    if (const size_t f = walk(h, p, start); f != none) return f == inside ? none : f;
    const double factor = h.error_factor(p);
    bool doubtful = false;
    for (size_t f = 0; f < h.count; f += 2) {
        const Pair side = h.sides(f, p), error = factor * vector_at<Pair>(h.size + f);
        const auto negative = std::bit_cast<PairBits>(side + error);
        if ((negative[0] & negative[1]) < 0) continue;
        if (side[0] > error[0]) return f;
        if (side[1] > error[1]) return f + 1;
        doubtful = true;
    }
    for (size_t f = 0; doubtful && f < h.count; ++f)
        if (h.side(f, p) >= -factor * h.size[f] && exact_side(h, f, vertex) > 0) return f;
    return none;
}

// seen_ becomes the facets that see the vertex, strictly or in whose plane it lies, f being one of them, and rim_ the
// edges around them. Returns six times the volume between them and the vertex.
double HullKernel::Impl::flood(const View& h, size_t f, const Point& p, int32_t vertex) {
    // Whatever is written past the end of seen_ or rim_ is overwritten unless it turns out to belong there.
    const double factor = h.error_factor(p);
    const uint32_t yes = facet_stamp_ + 1, no = yes + 1;
    facet_stamp_ += 2;
    uint32_t *const seen = seen_.data(), *const mark = facet_mark_.data();
    RimEdge* rim = rim_.data();
    size_t count = 1;
    seen[0] = static_cast<uint32_t>(f);
    mark[f] = yes;
    double volume = 0;
    for (size_t i = 0; i < count; ++i) {
        const HullFacet& facet = h.facets[seen[i]];
        volume += twice_positive(h.side(seen[i], p));
        for (size_t k = 0; k < 3; ++k) {
            const auto g = static_cast<uint32_t>(facet.neighbours[k]);
            const double side = h.side(g, p), error = h.size[g] * factor;
            bool sees = side > 0;
            if (std::fabs(side) <= error) [[unlikely]]
                sees = mark[g] < yes ? exact_side(h, g, vertex) >= 0 : mark[g] == yes;
            seen[count] = g;
            count += sees & (mark[g] != yes);
            mark[g] = sees ? yes : no;
            *rim = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbours[k]};
            rim += !sees;
        }
    }
    seen_count_ = count;
    rim_count_ = static_cast<size_t>(rim - rim_.data());
    return volume / 2;
}

// Six times what each of the points alone adds to the hull, to rounding.
std::array<double, 2> HullKernel::Impl::added_volumes6(const View& h, const Point& p, const Point& q) {
    Pair sum_p = {0, 0}, sum_q = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {
        sum_p += positive(h.sides(f, p));
        sum_q += positive(h.sides(f, q));
    }
    return {sum_p[0] + sum_p[1], sum_q[0] + sum_q[1]};
}

// As far as rounded numbers tell.
bool HullKernel::Impl::surely_inside(const View& h, const Point& p) {
    const double factor = h.error_factor(p);
    unsigned negative = 3;
    for (size_t f = 0; f < h.count; f += 2) negative &= signs(h.sides(f, p) + factor * vector_at<Pair>(h.size + f));
    return negative == 3;
}

void HullKernel::Impl::survey(const Hull& hull, std::span<const int32_t> points) {
    surveyed_ = hull.block_.get();
    surveyed_points_.assign(points.begin(), points.end());
    candidates_.clear();
    inserted_ = 0;
    loaded_ = false;
    const View h = view(hull);
    reserve(h.count);
    const std::span<const int32_t> own = hull.vertices();
    constexpr size_t few = 64;
    const auto is_own = [&](int32_t v) {
        return own.size() > few ? std::binary_search(own.begin(), own.end(), v) : contains(own, v);
    };
    if (h.count >= large_hull) {
        const auto take = [&](int32_t v) {
            if (is_own(v)) return;
            prefetch_line(&at(v));
            candidates_.push_back({HUGE_VAL, v});
        };
        for (size_t i = 0; i < points.size(); i += first_stride) take(points[i]);
        for (size_t stride = first_stride / 2; stride > 0; stride /= 2)
            for (size_t i = stride; i < points.size(); i += 2 * stride) take(points[i]);
        return;
    }
    // Those that remain to be tested. What is written past their end is no harm.
    others_.resize(points.size());
    size_t others = 0;
    for (const int32_t v : points) {
        others_[others] = v;
        others += !is_own(v);
    }
    for (size_t i = 0; i < others; i += 2) {
        const std::array<int32_t, 2> v = {others_[i], others_[std::min(i + 1, others - 1)]};
        const std::array<Point, 2> p = {at(v[0]) - h.origin, at(v[1]) - h.origin};
        const auto volumes6 = added_volumes6(h, p[0], p[1]);
        for (size_t k = 0; k < 2 && i + k < others; ++k)
            if (volumes6[k] > 0 || !surely_inside(h, p[k])) candidates_.push_back({volumes6[k], v[k]});
    }
    std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
        return a.volume6 != b.volume6 ? a.volume6 > b.volume6 : a.vertex < b.vertex;
    });
}

// Makes room for work on a hull of so many facets, and for one point more.
void HullKernel::Impl::make_room(size_t facets) {
    const size_t room = 6 * facets + 6;
    for (auto* numbers : {&x_, &y_, &z_, &offset_, &size_}) numbers->resize(room);
    facets_.resize(room);
    seen_.resize(room + 1);
    rim_.resize(3 * room + 1);
    facet_mark_.resize(room, 0);
}

void HullKernel::Impl::load(const Hull& hull) {
    const View h = view(hull);
    if (h.count <= set_bits)
        for (const int32_t v : hull.vertices()) prefetch_line(&at(v));
    count_ = h.count;
    // One loop for all, for they are short and their length can't be foreseen.
    const double* const from[] = {h.x, h.y, h.z, h.offset, h.size};
    double* const to[] = {x_.data(), y_.data(), z_.data(), offset_.data(), size_.data()};
    for (size_t f = 0; f < count_; f += 2) {
        for (size_t k = 0; k < plane_numbers; ++k) std::memcpy(to[k] + f, from[k] + f, sizeof(Pair));
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

Plane HullKernel::Impl::plane(const Triangle& corners) const {
    const Point& c = at(corners[2]);
    const Point u = at(corners[0]) - c, v = at(corners[1]) - c;
    const Point n = cross(u, v);
    const double size = std::fabs(u[1] * v[2]) + std::fabs(u[2] * v[1]) + std::fabs(u[2] * v[0]) +
                        std::fabs(u[0] * v[2]) + std::fabs(u[0] * v[1]) + std::fabs(u[1] * v[0]);
    return {n, dot(n, c - origin_), size};
}

void HullKernel::Impl::set_plane(size_t f, const Plane& plane) {
    x_[f] = plane.normal[0];
    y_[f] = plane.normal[1];
    z_[f] = plane.normal[2];
    offset_[f] = plane.offset;
    size_[f] = plane.size;
}

// What look() does, on a hull with at most set_bits facets.
double HullKernel::Impl::see(const Point& p, int32_t vertex) {
    const View h = view();
    const double factor = h.error_factor(p);
    uint64_t sees = 0, surely = 0;
    Pair sum = {0, 0};
    for (size_t f = 0; f < h.count; f += 2) {  // a gap sees nothing
        const Pair side = h.sides(f, p), error = factor * vector_at<Pair>(h.size + f);
        sum += positive(side);
        sees |= uint64_t{3 ^ signs(side + error)} << f;
        surely |= uint64_t{signs(error - side)} << f;
    }
    for (uint64_t doubtful = sees & ~surely; doubtful != 0; doubtful &= doubtful - 1) {
        const auto f = static_cast<size_t>(std::countr_zero(doubtful));
        const int side = exact_side(h, f, vertex);
        if (side < 0) sees &= ~(uint64_t{1} << f);
        if (side > 0) surely |= uint64_t{1} << f;
    }
    rim_count_ = 0;
    if (surely == 0) return 0;
    uint32_t* seen = seen_.data();
    RimEdge* rim = rim_.data();
    for (uint64_t left = sees; left != 0; left &= left - 1) {
        const auto f = static_cast<uint32_t>(std::countr_zero(left));
        *seen++ = f;
        const HullFacet& facet = h.facets[f];
        for (size_t k = 0; k < 3; ++k) {
            *rim = {facet.corners[k], facet.corners[next_corner[k]], facet.neighbours[k]};
            rim += (~sees >> facet.neighbours[k]) & 1;
        }
    }
    seen_count_ = static_cast<size_t>(seen - seen_.data());
    rim_count_ = static_cast<size_t>(rim - rim_.data());
    return sum[0] + sum[1];
}

// The planes of the facets between the rim and the vertex, two at a time, as plane() gives them: they go to the places
// in seen_. p is the vertex relative to the origin.
void HullKernel::Impl::make_facets(std::span<const RimEdge> rim, const Point& p, int32_t vertex) {
    const Point& c = at(vertex);
    for (size_t i = 0; i < rim.size(); i += 2) {
        const size_t j = std::min(i + 1, rim.size() - 1);
        const Point &from0 = at(rim[i].from), &to0 = at(rim[i].to), &from1 = at(rim[j].from), &to1 = at(rim[j].to);
        Pair u[3], v[3];
        for (size_t k = 0; k < 3; ++k) {
            u[k] = Pair{from0[k], from1[k]} - c[k];
            v[k] = Pair{to0[k], to1[k]} - c[k];
        }
        const Pair yz = u[1] * v[2], zy = u[2] * v[1], zx = u[2] * v[0], xz = u[0] * v[2], xy = u[0] * v[1],
                   yx = u[1] * v[0];
        const Pair x = yz - zy, y = zx - xz, z = xy - yx;
        const Pair size = magnitude(yz) + magnitude(zy) + magnitude(zx) + magnitude(xz) + magnitude(xy) + magnitude(yx);
        const Pair offset = x * p[0] + y * p[1] + z * p[2];
        for (size_t k = 0; k < 2; ++k) {
            const size_t f = seen_[k == 0 ? i : j];
            x_[f] = x[k];
            y_[f] = y[k];
            z_[f] = z[k];
            offset_[f] = offset[k];
            size_[f] = size[k];
        }
    }
}

// Finds seen_ and rim_ of a vertex on the hull at work; rim_ is empty if the vertex is in the hull. Returns six times
// what the vertex adds.
double HullKernel::Impl::look(int32_t vertex) {
    reserve(count_);
    const Point p = at(vertex) - origin_;
    if (count_ <= set_bits) return see(p, vertex);
    rim_count_ = 0;
    const size_t seen = find_seen(view(), p, vertex, latest_);
    return seen == none ? 0 : flood(view(), seen, p, vertex);
}

// Takes the vertex that was looked at last into the hull at work.
void HullKernel::Impl::attach(int32_t vertex) {
    if (rim_count_ == 0) return;
    const Point p = at(vertex) - origin_;
    reach_ = std::max(reach_, reach_of(p));

    // The new facets take the places of those that go, then gaps, then further places.
    const std::span<const RimEdge> rim(rim_.data(), rim_count_);
    size_t places = std::min(seen_count_, rim.size());
    for (; places < rim.size() && !gaps_.empty(); gaps_.pop_back()) seen_[places++] = gaps_.back();
    while (places < rim.size()) seen_[places++] = static_cast<uint32_t>(count_++);
    for (size_t i = rim.size(); i < seen_count_; ++i) {
        gaps_.push_back(seen_[i]);
        set_plane(seen_[i], {{}, HUGE_VAL, 0});
    }
    latest_ = seen_[0];
    make_facets(rim, p, vertex);
    HullFacet* const facets = facets_.data();
    Vertex* const points = points_.data();
    for (size_t i = 0; i < rim.size(); ++i) {
        const auto [from, to, beyond] = rim[i];
        const uint32_t f = seen_[i];
        facets[f].corners = {from, to, vertex};
        facets[f].neighbours[0] = beyond;
        HullFacet& across = facets[beyond];
        const size_t k = size_t{across.corners[1] == to} + 2 * size_t{across.corners[2] == to};
        across.neighbours[k] = static_cast<int32_t>(f);
        points[from].facet_from = static_cast<int32_t>(f);
    }
    for (size_t i = 0; i < rim.size(); ++i) {
        const int32_t next = points[rim[i].to].facet_from;
        facets[seen_[i]].neighbours[1] = next;
        facets[next].neighbours[2] = static_cast<int32_t>(seen_[i]);
    }
}

void HullKernel::Impl::insert(int32_t vertex) {
    volume6_ += look(vertex);
    attach(vertex);
}

// Moves the last facets into the gaps.
void HullKernel::Impl::close_gaps() {
    std::sort(gaps_.begin(), gaps_.end());
    for (size_t next = 0, end = gaps_.size(); next < end; --count_) {
        const size_t last = count_ - 1;
        if (gaps_[end - 1] == last) {
            --end;
            continue;
        }
        const size_t f = gaps_[next++];
        set_plane(f, {{x_[last], y_[last], z_[last]}, offset_[last], size_[last]});
        facets_[f] = facets_[last];
        for (const int32_t n : facets_[f].neighbours) {
            Triangle& back = facets_[static_cast<size_t>(n)].neighbours;
            *std::find(back.begin(), back.end(), static_cast<int32_t>(last)) = static_cast<int32_t>(f);
        }
    }
    gaps_.clear();
}

// The hull at work; its vertices are among these, which are in rising order both.
Hull HullKernel::Impl::unload(std::span<const int32_t> some, std::span<const int32_t> others) {
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
        for (size_t k = 0; k < plane_numbers; ++k) std::memcpy(to + k * count_ + f, from[k] + f, sizeof(Pair));
        std::memcpy(&facets[f], &facets_[f], 2 * sizeof(HullFacet));
    }
    block.origin = origin_;
    block.reach = reach_;
    block.centred = centred_;
    // Measured anew, so that rounding doesn't pile up over a long chain of unions.
    Pair sum = {0, 0};
    for (size_t f = 0; f < count_; f += 2) sum += vector_at<Pair>(&offset_[f]);
    block.volume = (sum[0] + sum[1]) / 6;
    return hull;
}

Hull HullKernel::Impl::allocate(std::span<const int32_t> vertices, size_t facets) {
    Hull hull;
    hull.block_.reset(new (pool_.allocate(Hull::Block::bytes(vertices.size(), facets))) Hull::Block{});
    hull.block_->pool = &pool_;
    hull.block_->vertex_count = static_cast<uint32_t>(vertices.size());
    hull.block_->facet_count = static_cast<uint32_t>(facets);
    int32_t* const to = hull.block_->vertices();
    std::fill(std::copy(vertices.begin(), vertices.end(), to), to + whole_fours(vertices.size()), -1);
    return hull;
}

// Starts with four of these points that span a tetrahedron; false if all lie in one plane.
bool HullKernel::Impl::load_simplex(std::span<const int32_t> vertices) {
    const auto first = vertices.begin(), end = vertices.end();
    if (first == end) return false;
    auto second = first, third = first, fourth = first;
    if (vertices.size() >= 4 &&
        orientation(at(vertices[0]), at(vertices[1]), at(vertices[2]), at(vertices[3])) != 0) {
        second = first + 1;
        third = first + 2;
        fourth = first + 3;
    } else {
        const Point& a = at(*first);
        second = std::find_if(first, end, [&](int32_t v) { return at(v) != a; });
        if (second == end) return false;
        const Point& b = at(*second);
        third = std::find_if(second, end, [&](int32_t v) { return !collinear(a, b, at(v)); });
        if (third == end) return false;
        const Point& c = at(*third);
        fourth = std::find_if(first, end, [&](int32_t v) { return orientation(a, b, c, at(v)) != 0; });
        if (fourth == end) return false;
    }

    std::array<int32_t, 4> t = {*first, *second, *third, *fourth};
    if (orientation(at(t[0]), at(t[1]), at(t[2]), at(t[3])) < 0) std::swap(t[0], t[1]);
    origin_ = {};
    for (const int32_t v : t)
        for (size_t k = 0; k < 3; ++k) origin_[k] += at(v)[k] / 4;
    reach_ = 0;
    for (const int32_t v : t) reach_ = std::max(reach_, reach_of(at(v) - origin_));
    const HullFacet facets[] = {{{t[0], t[2], t[1]}, {3, 2, 1}},
                                {{t[0], t[1], t[3]}, {0, 2, 3}},
                                {{t[1], t[2], t[3]}, {0, 3, 1}},
                                {{t[2], t[0], t[3]}, {0, 1, 2}}};
    count_ = 4;
    gaps_.clear();
    latest_ = 0;
    for (size_t f = 0; f < 4; ++f) {
        facets_[f] = facets[f];
        set_plane(f, plane(facets[f].corners));
    }
    // Once it is inside it stays there.
    centred_ = true;
    for (size_t f = 0; f < 4; ++f) centred_ &= offset_[f] > side_error * reach_ * size_[f];
    volume6_ = six_volumes(at(t[0]), at(t[1]), at(t[2]), at(t[3]));
    return true;
}

Hull HullKernel::Impl::build(std::span<const int32_t> vertices) {
    surveyed_ = nullptr;
    // Extreme points first: most others are then inside from the start.
    std::vector<int32_t>& order = vertices_;
    order.clear();
    for (size_t i = 0; i < lattice_directions && vertices.size() > 32; ++i) {
        const Point d = lattice_direction(i);
        const auto [low, high] = std::minmax_element(
            vertices.begin(), vertices.end(), [&](int32_t v, int32_t w) { return dot(at(v), d) < dot(at(w), d); });
        order.push_back(*low);
        order.push_back(*high);
    }
    order.insert(order.end(), vertices.begin(), vertices.end());

    if (!load_simplex(order)) {
        std::sort(order.begin(), order.end());
        order.erase(std::unique(order.begin(), order.end()), order.end());
        return allocate(order, 0);
    }
    mark_corners();
    for (const int32_t v : order)
        if (!marked(v)) {
            mark(v);
            insert(v);
        }
    std::sort(order.begin(), order.end());
    order.erase(std::unique(order.begin(), order.end()), order.end());
    return unload(order, {});
}

Hull HullKernel::Impl::unite(const Hull& hull, std::span<const int32_t> points) {
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

HullKernel::Measure HullKernel::Impl::united_volume(const Hull& hull, std::span<const int32_t> points, double enough) {
    if (hull.facet_count() == 0) return {unite(hull, points).volume(), true};
    survey(hull, points);
    const double volume = hull.volume();
    if (candidates_.empty()) return {volume, true};
    if (const double first = candidates_[0].volume6; first < HUGE_VAL) {
        const double with_first = volume + first / 6;
        if (candidates_.size() == 1 || candidates_[1].volume6 <= negligible * volume) return {with_first, true};
        if (with_first > enough) return {with_first, false};
    }
    load(hull);
    for (;;) {
        const int32_t vertex = candidates_[inserted_].vertex;
        const double volume6 = volume6_ + look(vertex);
        if (volume6 / 6 > enough) {
            surveyed_ = nullptr;
            return {volume6 / 6, false};
        }
        // The last one need not be taken in.
        if (inserted_ + 1 == candidates_.size() || candidates_[inserted_ + 1].volume6 <= negligible * volume)
            return {volume6 / 6, true};
        volume6_ = volume6;
        attach(vertex);
        ++inserted_;
    }
}

std::pair<Point, Point> HullKernel::Impl::bounds(const Hull& hull) const {
    Point low = at(hull.vertices().front()), high = low;
    for (const int32_t v : hull.vertices())
        for (size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], at(v)[k]);
            high[k] = std::max(high[k], at(v)[k]);
        }
    return {low, high};
}

HullKernel::HullKernel(std::span<const Point> points) : impl_(std::make_unique<Impl>(points)) {}
HullKernel::~HullKernel() = default;
Hull HullKernel::build(std::span<const int32_t> vertices) { return impl_->build(vertices); }
Hull HullKernel::unite(const Hull& hull, std::span<const int32_t> points) { return impl_->unite(hull, points); }
HullKernel::Measure HullKernel::united_volume(const Hull& hull, std::span<const int32_t> points, double enough) {
    return impl_->united_volume(hull, points, enough);
}
void HullKernel::prefetch(std::span<const int32_t> points) const { impl_->prefetch(points); }
std::pair<Point, Point> HullKernel::bounds(const Hull& hull) const { return impl_->bounds(hull); }

}  // namespace partwheel
