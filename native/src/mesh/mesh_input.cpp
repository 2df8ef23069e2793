// A caller's mesh of any layout -> packed doubles and int32.
#include "mesh/mesh_input.h"

#include "partwheel.h"

#include <cstring>
#include <type_traits>

namespace partwheel {

namespace {

// One of the caller's arrays: `count` items, `stride` bytes apart; 0: packed.
struct Array {
    const void* data;
    size_t count, stride;
    const char *name, *count_name;
};

template <class From, class To>
To convert(From number, const Array& array, size_t item) {
    if constexpr (std::is_integral_v<From>) {
        if (!std::in_range<To>(number))
            throw Error(PW_ERROR_INDEX, std::string(array.name) + ", row " + std::to_string(item) + ", has the index " +
                                            std::to_string(number) + ", which does not exist. The mesh is damaged: export it again.",
                        {.triangle = static_cast<int64_t>(item)});
    }
    return static_cast<To>(number);
}

template <class From, class To, class Item>
std::span<const Item> read(const Array& array, std::vector<Item>& copy) {
    constexpr size_t numbers = sizeof(Item) / sizeof(To), size = numbers * sizeof(From);
    if (array.stride != 0 && array.stride < size)
        throw Error(PW_ERROR_ARGUMENT, "The stride of " + std::string(array.name) + " is " +
                                           std::to_string(array.stride) + " bytes, but an item has " +
                                           std::to_string(size) + ". Set it to 0 for a packed array.");
    const size_t stride = array.stride ? array.stride : size;
    const bool aligned = reinterpret_cast<uintptr_t>(array.data) % alignof(Item) == 0;
    if (std::is_same_v<From, To> && stride == size && aligned)
        return {static_cast<const Item*>(array.data), array.count};
    copy.resize(array.count);
    To* out = reinterpret_cast<To*>(copy.data());
    for (size_t i = 0; i < array.count; ++i) {
        From item[numbers];
        std::memcpy(item, static_cast<const unsigned char*>(array.data) + i * stride, size);
        for (const From number : item) *out++ = convert<From, To>(number, array, i);
    }
    return copy;
}

template <class Item>
std::span<const Item> read_indices(const Array& array, int32_t type, std::vector<Item>& copy) {
    switch (type) {
        case PW_INT32: return read<int32_t, int32_t>(array, copy);
        case PW_UINT32: return read<uint32_t, int32_t>(array, copy);
        case PW_INT64: return read<int64_t, int32_t>(array, copy);
        default: throw Error(PW_ERROR_ARGUMENT, "index_type must be PW_INT32, PW_UINT32 or PW_INT64.");
    }
}

std::span<const Point> read_vertices(const Array& array, int32_t type, std::vector<Point>& copy) {
    switch (type) {
        case PW_DOUBLE: return read<double, double>(array, copy);
        case PW_FLOAT: return read<float, double>(array, copy);
        default: throw Error(PW_ERROR_ARGUMENT, "vertex_type must be PW_DOUBLE or PW_FLOAT.");
    }
}

}  // namespace

void require_countable(size_t count, const char* name) {
    if (count > PW_MAX_COUNT)
        throw Error(PW_ERROR_ARGUMENT, std::string(name) + " is " + std::to_string(count) + ", but at most " +
                                           std::to_string(PW_MAX_COUNT) + " are allowed. Decimate the mesh first.");
}

MeshInput::MeshInput(const pw_mesh_view& mesh) {
    const Array vertices{mesh.vertices, mesh.vertex_count, mesh.vertex_stride, "vertices", "vertex_count"};
    const Array triangles{mesh.triangles, mesh.triangle_count, mesh.triangle_stride, "triangles", "triangle_count"};
    const Array faces{mesh.faces, mesh.faces ? mesh.triangle_count : 0, mesh.face_stride, "faces", "face_count"};
    for (const Array& array : {vertices, triangles}) {
        if (!array.data && array.count != 0)
            throw Error(PW_ERROR_ARGUMENT, std::string(array.name) + " is null, but " + array.count_name + " is not 0.");
        require_countable(array.count, array.count_name);
    }
    require_countable(mesh.face_count, "face_count");
    view_.vertices = read_vertices(vertices, mesh.vertex_type, vertices_);
    view_.triangles = read_indices(triangles, mesh.index_type, triangles_);
    view_.faces = read_indices(faces, mesh.index_type, faces_);
    view_.face_count = mesh.faces || mesh.face_count ? mesh.face_count : mesh.triangle_count;
}

}  // namespace partwheel
