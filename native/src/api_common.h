// What the C functions share: handles, argument checks, errors, structs of other versions.
#pragma once

#include "base/error.h"
#include "base/progress.h"
#include "edit/solid.h"
#include "mesh/mesh_input.h"
#include "partwheel_edit.h"
#include "tree/hierarchy.h"

#include <atomic>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <mutex>
#include <new>

struct pw_context {
    partwheel::Progress progress;
    std::atomic<pw_fill_method> fill_method{PW_FILL_EXACT};
};

struct pw_hierarchy : partwheel::Hierarchy {
    explicit pw_hierarchy(partwheel::Hierarchy&& hierarchy) : Hierarchy(std::move(hierarchy)) {}

    const partwheel::SolidBuilder& solids(partwheel::Progress& progress) const {
        const std::lock_guard lock(mutex_);
        if (!solids_) solids_.emplace(tetrahedra(), vertices(), outer_faces(), leaves(), exact_tetrahedra(), progress);
        progress.reach(0.4);
        return *solids_;
    }

private:
    // Built on first use, by any thread. Not with std::call_once: an exception can't propagate through the system's C
    // library with a static C++ runtime.
    mutable std::mutex mutex_;
    mutable std::optional<partwheel::SolidBuilder> solids_;
};

struct pw_mesh : partwheel::TriangleMesh {};

namespace partwheel {

inline constexpr size_t max_struct_size = 4096;  // bytes; a caller who passes more has not set struct_size

// Sets the error of this thread's last call. Allocates nothing, because memory may have run out.
pw_status fail(pw_status status, const ErrorLocation& location, const char* format, const char* detail = "") noexcept;

inline void require(bool condition, const std::string& message) {
    if (!condition) throw Error(PW_ERROR_ARGUMENT, message);
}

// An argument that must not be null.
struct RequiredPointer {
    const char* name;
    const void* pointer;
};

inline void require_all(std::initializer_list<RequiredPointer> required) {
    if (std::ranges::all_of(required, [](const RequiredPointer& argument) { return argument.pointer != nullptr; })) return;
    std::string names;
    for (const RequiredPointer& argument : required) {
        const bool first = &argument == required.begin(), last = &argument == required.end() - 1;
        names.append(first ? "" : last ? " and " : ", ").append(argument.name);
    }
    require(false, names + " must not be null.");
}

// Runs the body of a function if no required pointer is null; turns exceptions into a status and a message.
template <class Body>
pw_status guarded(std::initializer_list<RequiredPointer> required, Body&& body) noexcept {
    try {
        require_all(required);
        body();
        return PW_OK;
    } catch (const Error& e) {
        return fail(e.status(), e.location(), "%s", e.what());
    } catch (const std::bad_alloc&) {
        return fail(PW_ERROR_MEMORY, {}, "There is not enough memory. Close other programs, or decimate the mesh.");
    } catch (const std::exception& e) {
        return fail(PW_ERROR_INTERNAL, {}, "An unexpected error occurred (%s). Please report this mesh.", e.what());
    } catch (...) {
        return fail(PW_ERROR_INTERNAL, {}, "An unexpected error occurred. Please report this mesh.");
    }
}

// Runs the body of a function that takes a context, with the context's progress. Ignores a cancellation after the body
// has returned.
template <class Body>
pw_status with_progress(pw_context* context, std::initializer_list<RequiredPointer> required, Body&& body) noexcept {
    return guarded(required, [&] {
        Progress unobserved;
        Progress& progress = context ? context->progress : unobserved;
        struct Watch {
            Progress& progress;
            explicit Watch(Progress& watched_progress) : progress(watched_progress) { progress.begin(); }
            ~Watch() { progress.end(); }
        } watch(progress);
        body(progress);
        progress.finish();
    });
}

template <class Struct>
size_t size_of(const Struct& caller_struct) {
    const size_t size = caller_struct.struct_size;
    require(size >= sizeof size && size <= max_struct_size && size % alignof(Struct) == 0,
            "struct_size must be the struct's sizeof. Set it before the call.");
    return size;
}

// Converts the caller's struct, of any version, to this version.
template <class Struct>
Struct read_struct(const Struct& caller_struct) {
    Struct own{};
    const size_t size = size_of(caller_struct);
    const auto* bytes = reinterpret_cast<const unsigned char*>(&caller_struct);
    std::memcpy(&own, bytes, std::min(size, sizeof own));
    require(std::all_of(bytes + std::min(size, sizeof own), bytes + size, [](unsigned char byte) { return byte == 0; }),
            "The call uses options of a later version of Partwheel's library. Install that version, or leave the new "
            "members at 0.");
    return own;
}

// The caller's array as `count` items of several numbers each.
template <class Item, class Number>
std::span<const Item> items(const Number* numbers, size_t count, const char* name, const char* count_name) {
    if (!numbers && count != 0)
        throw Error(PW_ERROR_ARGUMENT, std::string(name) + " is null, but " + count_name + " is not 0.");
    require_countable(count, count_name);
    return {reinterpret_cast<const Item*>(numbers), count};
}

inline std::span<const Point> as_points(const double* vertices, size_t count) {
    return items<Point>(vertices, count, "vertices", "vertex_count");
}

// The mesh with each triangle as a face of its own.
inline MeshView without_faces(const MeshView& mesh) { return {mesh.vertices, mesh.triangles, {}, mesh.triangles.size()}; }

// The caller's mesh, of any version.
inline MeshInput mesh_input(const pw_mesh_view& mesh) { return MeshInput(read_struct(mesh)); }

}  // namespace partwheel
