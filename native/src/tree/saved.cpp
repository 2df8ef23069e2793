// A saved hierarchy: a header, the arrays packed, a hash.
#include "tree/saved.h"

#include "base/adjacency.h"
#include "base/corners.h"
#include "tree/packed.h"

#include <cstring>

namespace partwheel {

namespace {

constexpr std::array<char, 8> magic = {'P', 'W', 'H', 'I', 'E', 'R', '\r', '\n'};

struct Header {
    std::array<char, 8> magic = partwheel::magic;
    uint32_t version = saved_format;
    uint32_t fill_method = 0;
    uint64_t faces = 0, tetrahedra = 0, vertices = 0, components = 0, cavities = 0, added_vertices = 0, notes = 0;
    uint64_t outer = 0, scores = 0;
    double deviation = 0, hull_volume = 0;
};

static_assert(sizeof(Point) == 24 && sizeof(Tetrahedron) == 16 && sizeof(Header) == 104);

// What the header and the summary have.
auto shared_fields(auto& s) {
    return std::tie(s.components, s.cavities, s.added_vertices, s.deviation, s.hull_volume);
}

template <class T, size_t n>
std::span<const T> numbers(const std::vector<std::array<T, n>>& arrays) {
    return {arrays.data()->data(), n * arrays.size()};
}

// Coordinates may be somewhat larger than the caller's, and a model smaller: a sheet is given a thickness.
constexpr double largest_coordinate = 1e101, smallest_model = 1e-81;

bool is_below(int32_t i, size_t count) { return i >= 0 && idx(i) < count; }

bool is_measure(double x) { return x >= 0 && std::isfinite(x); }

void check_vertices(const SavedHierarchy& saved) {
    for (const Point& p : saved.vertices)
        for (const double c : p)
            if (!(std::fabs(c) <= largest_coordinate)) refuse_saved("a vertex is out of range");
    if (!(Frame::around(saved.vertices).longest >= smallest_model)) refuse_saved("its vertices are all at one place");
    std::vector<int32_t> sources;
    for (const int32_t s : saved.source) {
        if (s < -1 || s >= PW_MAX_COUNT) refuse_saved("a vertex has no source");
        if (s >= 0) sources.push_back(s);
    }
    std::sort(sources.begin(), sources.end());
    // On both sides of a wall there are vertices of the same source.
    const bool is_exact = saved.summary.fill_method == PW_FILL_EXACT && saved.summary.proxy_triangles == 0;
    if (is_exact && std::ranges::adjacent_find(sources) != sources.end()) refuse_saved("two vertices have one source");
}

// The largest error of six times a volume, in the frame, due to rounding to the caller's coordinates.
double rounding_of_volumes(std::span<const Point> vertices, const Frame& frame) {
    double largest = 0;
    for (const Point& p : vertices)
        for (const double c : p) largest = std::max(largest, std::fabs(c));
    constexpr double per_coordinate = 256;  // more than the number of products in a volume, times the frame's extent
    return per_coordinate * std::numeric_limits<double>::epsilon() * (1 + largest / frame.scale);
}

void check_tetrahedra(const SavedHierarchy& saved) {
    for (const Tetrahedron& t : saved.tetrahedra)
        for (const int32_t v : t)
            if (!is_below(v, saved.vertices.size())) refuse_saved("a tetrahedron refers to a missing vertex");
    if (has_reversed_tetrahedra(saved)) refuse_saved("a tetrahedron is inside out");
    const std::vector<std::array<int32_t, 4>> neighbors = find_neighbors(saved.tetrahedra);
    size_t outer = 0;
    for (const auto& of_tet : neighbors) outer += static_cast<size_t>(std::count(of_tet.begin(), of_tet.end(), -1));
    if (outer == 0 || outer != saved.outer_faces.size()) refuse_saved("its surface is not that of its tetrahedra");
}

void check_faces(const SavedHierarchy& saved) {
    for (const int32_t l : saved.leaf)
        if (!is_below(l, saved.tetrahedra.size())) refuse_saved("a face refers to a missing tetrahedron");
    for (const double a : saved.face_area)
        if (!is_measure(a)) refuse_saved("an area is impossible");
    for (const int32_t f : saved.outer_faces)
        if (f != -1 && !is_below(f, saved.leaf.size())) refuse_saved("a facet refers to a missing face");
    if (!std::isfinite(std::reduce(saved.face_area.begin(), saved.face_area.end())))
        refuse_saved("its measures are impossible");
}

void check_merges(const SavedHierarchy& saved) {
    double sum = 0;  // of all; if it is finite, so are partial sums
    for (const double concavity : saved.concavities) {
        if (!is_measure(concavity)) refuse_saved("a volume is impossible");
        sum += concavity;
    }
    if (!is_measure(saved.summary.hull_volume) || !std::isfinite(sum)) refuse_saved("its measures are impossible");
}

void check_scores(const SavedHierarchy& saved) {
    // One for each part and each merge that joins them; with no parts there is none.
    const std::vector<double>& scores = saved.scores;
    if (!scores.empty() && (scores.size() % 2 == 0 || scores.size() > 2 * saved.tetrahedra.size() - 1))
        refuse_saved("the number of scores is wrong");
    for (size_t i = 0; i < scores.size(); ++i) {
        // 0 marks intermediate merges.
        const bool may_be_step = i > scores.size() / 2 && i + 1 < scores.size();
        if (!(may_be_step ? scores[i] >= 0 : scores[i] > 0) || scores[i] > 1) refuse_saved("a score is impossible");
    }
}

void check_summary(const SavedHierarchy& saved) {
    if (saved.summary.proxy_triangles > PW_MAX_COUNT) refuse_saved("its counts are impossible");
    uint8_t method = 0, proxies = 0;
    for (const uint8_t fill : saved.shell_fills) {
        const uint8_t own = fill & ~is_proxy;
        if (!std::has_single_bit(own) || own > PW_FILL_SHEET) refuse_saved("a shell's fill method is unknown");
        method = std::max(method, own);
        proxies |= fill & is_proxy;
    }
    if (method == 0 || method != saved.summary.fill_method || (proxies != 0) != (saved.summary.proxy_triangles > 0))
        refuse_saved("its fill method is unknown");
    if (saved.shell_fills.size() > std::min(saved.scores.size() / 2 + 1, saved.tetrahedra.size()))
        refuse_saved("its number of shells is impossible");
    const bool exact = saved.summary.fill_method == PW_FILL_EXACT && saved.summary.proxy_triangles == 0;
    const auto added = static_cast<size_t>(std::count(saved.source.begin(), saved.source.end(), -1));
    if (saved.summary.components < saved.shell_fills.size() || saved.summary.components > saved.tetrahedra.size() ||
        (exact ? saved.summary.added_vertices != added : saved.summary.added_vertices > added))
        refuse_saved("its counts are impossible");
    if (!is_measure(saved.summary.deviation) || (exact && saved.summary.deviation != 0))
        refuse_saved("its deviation is impossible");
    if ((saved.notes.empty() && !exact) || !std::ranges::all_of(saved.notes, is_printable))
        refuse_saved("its notes can't be read");
}

}  // namespace

std::vector<uint8_t> SavedHierarchy::pack(Progress& progress) const {
    Header header;
    header.faces = leaf.size();
    header.tetrahedra = tetrahedra.size();
    header.vertices = vertices.size();
    header.notes = notes.size();
    header.outer = outer_faces.size();
    header.scores = scores.size();
    header.fill_method = summary.fill_method;
    shared_fields(header) = shared_fields(summary);
    Packer out;
    out.put(header);
    out.put(uint64_t{summary.proxy_triangles});
    out.put(uint64_t{shell_fills.size()});
    out.put_bytes(shell_fills.data(), shell_fills.size());
    out.put_bytes(notes.data(), notes.size());
    progress.reach(0.1);
    out.put_integers(borders);
    out.put_doubles(concavities);
    progress.reach(0.4);
    out.put_doubles(numbers(vertices));
    progress.reach(0.6);
    out.put_integers(source);
    out.put_integers(numbers(tetrahedra));
    progress.reach(0.8);
    out.put_integers(leaf);
    out.put_doubles(face_area);
    out.put_integers(outer_faces);
    out.put_doubles(scores);
    return out.finish();
}

SavedHierarchy SavedHierarchy::unpack(std::span<const uint8_t> bytes) {
    if (bytes.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin()))
        refuse_saved("it is not one of Partwheel's");
    // Every version of the format has its number behind the magic bytes. The rest, and its hash, may differ.
    uint32_t version;
    if (bytes.size() < magic.size() + sizeof version) refuse_saved("it is truncated");
    std::memcpy(&version, bytes.data() + magic.size(), sizeof version);
    if (version > saved_format) refuse_saved("it was written by a newer version of Partwheel, which can read it");
    if (version < oldest_saved_format) refuse_saved("it was written by an older version of Partwheel");
    Unpacker in(bytes);
    const auto header = in.get<Header>();
    for (uint64_t n : {header.faces, header.tetrahedra, header.vertices})
        if (n == 0 || n > PW_MAX_COUNT) refuse_saved("its sizes are impossible");

    SavedHierarchy saved;
    if (header.fill_method > PW_FILL_SHEET) refuse_saved("its fill method is unknown");
    saved.summary.fill_method = static_cast<pw_fill_method>(header.fill_method);
    shared_fields(saved.summary) = shared_fields(header);
    constexpr uint32_t coarse = 8;
    if (version > 5) {
        saved.summary.proxy_triangles = in.get<uint64_t>();
    } else if (header.fill_method == coarse) {  // that was all that format 5 had of a proxy
        saved.summary.proxy_triangles = header.outer;
        saved.summary.fill_method = PW_FILL_EXACT;
    }
    if (version > 6) {
        const std::string fills = in.get_text(in.get<uint64_t>());
        saved.shell_fills.assign(fills.begin(), fills.end());
    } else {
        const uint8_t proxy = saved.summary.proxy_triangles > 0 ? is_proxy : 0;
        saved.shell_fills = {static_cast<uint8_t>(saved.summary.fill_method | proxy)};
    }
    saved.notes = in.get_text(header.notes);
    saved.borders = in.get_integers(header.tetrahedra - 1);
    saved.concavities = in.get_doubles(header.tetrahedra - 1);
    saved.vertices = in.get_doubles<Point>(header.vertices);
    saved.source = in.get_integers(header.vertices);
    saved.tetrahedra = in.get_integers<Tetrahedron>(header.tetrahedra);
    saved.leaf = in.get_integers(header.faces);
    saved.face_area = in.get_doubles(header.faces);
    saved.outer_faces = in.get_integers(header.outer);
    saved.scores = in.get_doubles(header.scores);
    if (!in.at_end()) refuse_saved("there is data after its end");
    return saved;
}

std::vector<std::array<int32_t, 4>> find_neighbors(std::span<const Tetrahedron> tetrahedra) {
    for (Tetrahedron t : tetrahedra) {
        std::ranges::sort(t);
        if (std::ranges::adjacent_find(t) != t.end()) refuse_saved("a tetrahedron has a vertex twice");
    }
    const auto neighbors = neighbors_across_facets(tetrahedra);
    if (!neighbors) refuse_saved("more than two tetrahedra share a facet");
    return *neighbors;
}

bool has_reversed_tetrahedra(const HierarchyData& data) {
    const double rounding = rounding_of_volumes(data.vertices, Frame::around(data.vertices));
    const std::vector<Point> points = data.working_vertices();
    return std::ranges::any_of(data.tetrahedra, [&](const Tetrahedron& t) { return signed_volume6(points, t) < -rounding; });
}

void SavedHierarchy::check() const {
    check_vertices(*this);
    check_tetrahedra(*this);
    check_faces(*this);
    check_merges(*this);
    check_scores(*this);
    check_summary(*this);
}

}  // namespace partwheel
