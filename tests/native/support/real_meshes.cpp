// The real models that the tests read.
#include "support/real_meshes.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace partwheel::test {

namespace {

// The next line that isn't empty or a comment.
std::istringstream next_line(std::istream& in, const std::filesystem::path& path) {
    for (std::string line; std::getline(in, line);) {
        line.resize(std::min(line.size(), line.find('#')));
        if (line.find_first_not_of(" \t\r") != std::string::npos) return std::istringstream(line);
    }
    throw std::runtime_error("the file ends early: " + path.string());
}

struct Header {
    size_t vertices = 0, faces = 0;
};

Header read_header(std::istream& in, const std::filesystem::path& path) {
    std::istringstream line = next_line(in, path);
    std::string word;
    line >> word;
    if (word != "OFF" && word != "COFF") throw std::runtime_error("not an OFF file: " + path.string());
    Header header;
    if (!(line >> header.vertices)) {
        line = next_line(in, path);
        line >> header.vertices;
    }
    if (!(line >> header.faces)) throw std::runtime_error("no counts in " + path.string());
    return header;
}

std::filesystem::path directory() {
    const std::filesystem::path path = PARTWHEEL_MESHES;
    if (!std::filesystem::is_directory(path))
        throw std::runtime_error("There is no directory " + path.string() + ". Run scripts/build, which fetches it.");
    return path;
}

}  // namespace

TriMesh real_mesh(const std::string& file) {
    const std::filesystem::path path = directory() / file;
    std::ifstream in(path);
    if (!in) throw std::runtime_error("can't open " + path.string());
    const Header header = read_header(in, path);
    TriMesh mesh;
    mesh.name = file;
    for (size_t v = 0; v < header.vertices; ++v) {
        std::istringstream line = next_line(in, path);
        Point p;
        if (!(line >> p[0] >> p[1] >> p[2])) throw std::runtime_error("a bad vertex in " + path.string());
        mesh.vertices.push_back(p);
    }
    for (size_t f = 0; f < header.faces; ++f) {
        std::istringstream line = next_line(in, path);
        size_t count = 0;
        line >> count;
        std::vector<int32_t> corners(count);
        for (int32_t& corner : corners) line >> corner;
        if (!line || count < 3) throw std::runtime_error("a bad face in " + path.string());
        for (size_t k = 2; k < count; ++k) {
            mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
            mesh.faces.push_back(static_cast<int32_t>(f));
        }
    }
    mesh.face_count = header.faces;
    return mesh;
}

std::vector<TriMesh> real_meshes(size_t most_faces) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(directory())) {
        if (entry.path().extension() != ".off") continue;
        std::ifstream in(entry.path());
        if (read_header(in, entry.path()).faces <= most_faces) names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    std::vector<TriMesh> meshes;
    for (const std::string& name : names) meshes.push_back(real_mesh(name));
    return meshes;
}

}  // namespace partwheel::test
