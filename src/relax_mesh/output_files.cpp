#include "relax_mesh/output_files.h"

#include <filesystem>
#include <functional>
#include <new>
#include <ostream>
#include <stdexcept>
#include <string>

#include "base/checkpoint.h"
#include "base/files.h"
#include "surfaces/face_files.h"
#include "surfaces/obj_file.h"
#include "surfaces/placement.h"

namespace spherical_springs::relax_mesh {
namespace {

namespace fs = std::filesystem;

/// Adds to a list in words.
void add(std::string& list, const std::string& item, const char* separator) {
  list += (list.empty() ? "" : separator) + item;
}

/// Remembers which of several files have been written, and why others have not.
class Writing {
 public:
  /// `path`: may be empty, for no file.
  void write(const fs::path& path, const std::function<void(std::ostream&)>& content) {
    if (path.empty()) return;
    try {
      core::replaceFile(path, content);
      add(written_, core::onOneLine(path), ", ");
    } catch (const std::bad_alloc&) {
      add(faults_, "not enough memory to write " + core::onOneLine(path), "; ");
    } catch (const std::exception& fault) {
      add(faults_, fault.what(), "; ");
    }
  }

  const std::string& writtenFiles() const {
    if (faults_.empty()) return written_;
    throw std::runtime_error(
        faults_ + (written_.empty() ? "; no file has been written" : "; written: " + written_));
  }

 private:
  std::string written_, faults_;
};

}  // namespace

mesh::TexturedSurface textureOf(const Options& options, const Task& task, const Points& map) {
  return mesh::textured(task.surface, mesh::placed(task.surface, map, options.placement),
                        options.projection);
}

std::string writeFiles(const Options& options, const Task& task, const Points& map,
                       const mesh::FaceDistortion& faces) {
  Writing writing;
  writing.write(options.output, [&](std::ostream& out) {
    mesh::writeObj(
        out,
        mesh::TriangleMesh{mesh::placed(task.surface, map, options.placement), task.surface.faces},
        core::passAll);
  });
  writing.write(options.uv, [&](std::ostream& out) {
    mesh::writeObj(out, textureOf(options, task, map), core::passAll);
  });
  writing.write(options.metrics, [&](std::ostream& out) {
    mesh::writeMetrics(out, task.shares, faces, core::passAll);
  });
  return writing.writtenFiles();
}

}  // namespace spherical_springs::relax_mesh
