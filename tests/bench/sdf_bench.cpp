// CGAL's segmentation by the shape diameter function, to compare with: its time and memory, as JSON.
//
//   sdf_bench MODEL.off [LABELS]
//
// LABELS receives each face's segment, one a line. `parts` are the segments it finds with its defaults; `seconds` are
// [wall, cpu], the reading of the file not counted.
#include "measured.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/mesh_segmentation.h>

#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

int main(int argc, char** argv) {
    using namespace partwheel::bench;
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
    try {
        if (argc != 2 && argc != 3) throw std::runtime_error("usage: sdf_bench MODEL.off [LABELS]");
        const Model model = read_off(argv[1]);
        Mesh mesh;
        for (size_t v = 0; v < model.vertices.size(); v += 3)
            mesh.add_vertex({model.vertices[v], model.vertices[v + 1], model.vertices[v + 2]});
        const auto vertex = [&](size_t i) {
            return Mesh::Vertex_index(static_cast<Mesh::size_type>(model.triangles[i]));
        };
        for (size_t t = 0; t < model.triangles.size(); t += 3)
            if (mesh.add_face(vertex(t), vertex(t + 1), vertex(t + 2)) == Mesh::null_face())
                throw std::runtime_error("the surface is not manifold");
        Stopwatch watch;
        const auto sdf = mesh.add_property_map<Mesh::Face_index, double>("f:sdf").first;
        CGAL::sdf_values(mesh, sdf);
        const auto segment = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:segment").first;
        const std::size_t parts = CGAL::segmentation_from_sdf_values(mesh, sdf, segment);
        const Seconds seconds = watch.lap();
        if (argc == 3) {
            std::ofstream labels(argv[2]);
            for (const auto face : mesh.faces()) labels << segment[face] << '\n';
            if (!labels.flush()) throw std::runtime_error(std::string("can't write ") + argv[2]);
        }
        std::printf("{\"parts\": %zu, \"seconds\": [%.6f, %.6f], \"peak\": %zu}\n", parts, seconds.wall, seconds.cpu,
                    peak_memory());
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
