#include "surfaces/assimp_file.h"

#include <assimp/scene.h>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <new>
#include <stdexcept>
#include <string>

namespace spherical_springs::mesh {
namespace {

/// Keeps the first warning or error that the library logs: it reads on behind many faults.
class FirstComplaint : public Assimp::LogStream {
 public:
  explicit FirstComplaint(std::string& text) : text_(text) {}

  void write(const char* message) override {
    if (!text_.empty()) return;
    text_ = message;  // "Error, T0: OFF: ..."
    const std::size_t begin = text_.find(": ");
    if (begin != std::string::npos) text_.erase(0, begin + 2);
    while (!text_.empty() && text_.back() == '\n') text_.pop_back();
  }

 private:
  std::string& text_;
};

/// Keeps complaints for as long as it lives. The library has one logger for all threads.
class Listening {
 public:
  explicit Listening(std::string& first_complaint) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(  // which the logger deletes at its end
        new FirstComplaint(first_complaint), Assimp::Logger::Warn | Assimp::Logger::Err);
  }
  ~Listening() { Assimp::DefaultLogger::kill(); }
  Listening(const Listening&) = delete;
  Listening& operator=(const Listening&) = delete;
};

const aiScene& read(const std::filesystem::path& path, Assimp::Importer& importer) {
  std::string complaint;
  const Listening listening(complaint);
  const aiScene* const scene = importer.ReadFile(path.string(), 0);
  const std::string error = importer.GetErrorString();
  if (error.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
  if (scene == nullptr) throw std::invalid_argument(error);
  if (!complaint.empty()) throw std::invalid_argument(complaint);
  return *scene;
}

std::int32_t cornerOf(const PolygonMesh& mesh, const aiMesh& part, unsigned index,
                      std::size_t first_vertex) {
  if (index >= part.mNumVertices) {
    throw std::invalid_argument("face " + std::to_string(mesh.faces() + mesh.first_number) +
                                " has vertex " + std::to_string(static_cast<std::int32_t>(index)) +
                                "; allowed: 0 to " +
                                std::to_string(static_cast<std::int64_t>(part.mNumVertices) - 1));
  }
  return static_cast<std::int32_t>(first_vertex + index);
}

void append(const aiMesh& part, PolygonMesh& mesh) {
  const std::size_t first_vertex = mesh.vertices.size();
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D& place = part.mVertices[v];
    mesh.vertices.push_back({place.x, place.y, place.z});
    if (!mesh.vertices.back().allFinite()) {
      throw std::invalid_argument("vertex " + std::to_string(v + first_vertex) + " is not finite");
    }
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3) continue;  // a point or a line
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      mesh.corners.push_back(cornerOf(mesh, part, face.mIndices[k], first_vertex));
    }
    mesh.ends.push_back(mesh.corners.size());
  }
}

}  // namespace

PolygonMesh readByAssimp(const std::filesystem::path& path, bool numbers_vertices) {
  Assimp::Importer importer;
  const aiScene& scene = read(path, importer);
  PolygonMesh mesh;
  mesh.numbers_vertices = numbers_vertices;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) append(*scene.mMeshes[m], mesh);
  if (mesh.ends.empty()) throw std::invalid_argument("it has no face");
  return mesh;
}

}  // namespace spherical_springs::mesh
