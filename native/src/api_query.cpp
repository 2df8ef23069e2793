// The C functions of rays and indexes: argument checks and calls into the layers, nothing else.
#include "api_common.h"
#include "base/parallel.h"
#include "mesh/rays.h"
#include "query/part_index.h"

#include <atomic>

using namespace partwheel;

struct pw_ray_target : RayTarget {
    using RayTarget::RayTarget;
};

struct pw_index {
    PartIndex parts;
    size_t threads;
};

namespace {

// Calls answer(i) for queries 0 to count - 1 in parallel. Each call must write only its own result.
template <class Answer>
void answer_all(const pw_index& index, size_t count, Progress& progress, const Answer& answer) {
    constexpr size_t chunk_size = 256;
    std::atomic<size_t> done{0};
    ThreadPool(index.threads, count / chunk_size).parallel_for(count, chunk_size, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            if (i % 16 == 0) progress.reach(static_cast<double>(done) / static_cast<double>(count));
            answer(i);
        }
        done += last - first;
    });
}

// items(), whose numbers must be finite and at most 1e100 in size.
template <class Item>
std::span<const Item> measurable_items(const double* numbers, size_t count, const char* name) {
    constexpr double largest = 1e100;
    const auto rows = items<Item>(numbers, count, name, "count");
    for (size_t i = 0; i < rows.size(); ++i)
        if (!std::ranges::all_of(rows[i], [](double x) { return std::fabs(x) <= largest; }))
            throw Error(PW_ERROR_NOT_FINITE, std::string(name) + ", row " + std::to_string(i) +
                                                 ", has a number that is NaN, infinite, or larger than 1e100.");
    return rows;
}

}  // namespace

pw_status pw_ray_target_create(pw_context* context, const pw_mesh_view* mesh, pw_ray_target** target) {
    return with_progress(context, {{"mesh", mesh}, {"target", target}}, [&](Progress& progress) {
        const MeshInput input = mesh_input(*mesh);
        *target = new pw_ray_target(without_faces(input), progress);
    });
}

void pw_ray_target_free(pw_ray_target* target) { delete target; }

pw_status pw_ray_target_first(const pw_ray_target* target, const double* origin, const double* direction,
                              double min_distance, int32_t* triangle, double* distance) {
    return guarded({{"target", target}, {"origin", origin}, {"direction", direction}, {"triangle", triangle},
                    {"distance", distance}}, [&] {
        const Point from = *as_points(origin, 1).data(), along = *as_points(direction, 1).data();
        const double size = length(along);
        if (!std::isfinite(length(from)) || !std::isfinite(size) || size == 0 || std::isnan(min_distance))
            throw Error(PW_ERROR_NOT_FINITE, "The ray needs a finite origin, and a finite direction that is not 0.");
        const RayHit hit = target->first_hit(from, along, min_distance);
        *triangle = hit.triangle;
        *distance = hit.distance;
    });
}

pw_status pw_index_create(pw_context* context, const pw_hierarchy* hierarchy, const int32_t* bounds,
                          size_t bound_count, int32_t threads, pw_index** index) {
    return with_progress(context, {{"hierarchy", hierarchy}, {"index", index}}, [&](Progress& progress) {
        require(threads >= 0, "threads must be 0 or more.");
        *index = new pw_index{PartIndex(*hierarchy, items<int32_t>(bounds, bound_count, "bounds", "bound_count"),
                                        progress),
                              static_cast<size_t>(threads)};
    });
}

void pw_index_free(pw_index* index) { delete index; }

pw_status pw_index_locate(pw_context* context, const pw_index* index, const double* points, size_t count,
                          int32_t* parts) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto queries = measurable_items<Point>(points, count, "points");
        require(parts || count == 0, "parts must not be null.");
        answer_all(*index, count, progress, [&](size_t i) { parts[i] = index->parts.locate(queries[i]); });
    });
}

pw_status pw_index_first_hits(pw_context* context, const pw_index* index, const double* origins, const double* directions,
                              size_t count, int32_t* parts, double* distances) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto from = measurable_items<Point>(origins, count, "origins");
        const auto along = measurable_items<Point>(directions, count, "directions");
        require((parts && distances) || count == 0, "parts and distances must not be null.");
        for (const Point& d : along)
            if (d == Point{}) throw Error(PW_ERROR_NOT_FINITE, "The direction of a ray must not be 0, 0, 0.");
        answer_all(*index, count, progress, [&](size_t i) {
            const RayHit hit = index->parts.first_hit(from[i], along[i]);
            parts[i] = hit.triangle;
            distances[i] = hit.distance;
        });
    });
}

pw_status pw_index_nearest(pw_context* context, const pw_index* index, const double* points, size_t count, int32_t* parts,
                           double* distances, double* nearest) {
    return with_progress(context, {{"index", index}}, [&](Progress& progress) {
        const auto queries = measurable_items<Point>(points, count, "points");
        require((parts && distances && nearest) || count == 0, "parts, distances and nearest must not be null.");
        answer_all(*index, count, progress, [&](size_t i) {
            const NearestPart near = index->parts.nearest(queries[i]);
            parts[i] = near.part;
            distances[i] = near.distance;
            std::ranges::copy(near.point, nearest + 3 * i);
        });
    });
}

pw_status pw_index_intersects(pw_context* context, const pw_index* index, const pw_index* other, const double* matrices,
                              size_t count, int32_t* parts, double* points) {
    return with_progress(context, {{"index", index}, {"other", other}}, [&](Progress& progress) {
        const auto transforms = measurable_items<Affine>(matrices, count, "matrices");
        require((parts && points) || count == 0, "parts and points must not be null.");
        for (const Affine& m : transforms)
            if (!is_finite(compose_with_inverse(identity, m)))
                throw Error(PW_ERROR_NOT_FINITE, "A matrix scales the other hierarchy to zero volume.");
        answer_all(*index, count, progress, [&](size_t i) {
            const IntersectingParts contact = index->parts.intersect(other->parts, transforms[i]);
            std::ranges::copy(contact.parts, parts + 2 * i);
            std::ranges::copy(contact.point, points + 3 * i);
        });
    });
}
