#include "surfaces/surface_file.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "base/files.h"
#include "surfaces/assimp_file.h"
#include "surfaces/obj_file.h"

namespace spherical_springs::mesh {
namespace {

std::string endingOf(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

}  // namespace

PolygonMesh readPolygons(const std::filesystem::path& path, const core::Checkpoint& checkpoint) {
  std::ifstream in = core::openToRead(path);
  const std::string ending = endingOf(path);
  try {
    if (ending == ".stl") return readByAssimp(path, false);
    if (ending == ".ply" || ending == ".off") return readByAssimp(path, true);
    return readObj(in, checkpoint);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(core::onOneLine(path) + ": " + fault.what());
  }
}

}  // namespace spherical_springs::mesh
