#include "node/scene_directory.h"

#include <stdexcept>
#include <system_error>

#include "base/files.h"
#include "spherical_springs/range.h"

namespace spherical_springs {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& value,
                         const std::string& allowed) {
  throw std::invalid_argument(what + " is " + core::quoted(value) + "; allowed: " + allowed);
}

}  // namespace

SceneDirectory::SceneDirectory(const std::string& directory) {
  constexpr auto kParameter = "parameter ~scene_directory";
  constexpr auto kAllowed = "a directory, or a name that is free; ";
  try {
    directory_ =
        fs::weakly_canonical(core::linksFollowed(fs::absolute(core::homeExpanded(directory))));
  } catch (const fs::filesystem_error& fault) {
    refuse(kParameter, directory, kAllowed + fault.code().message());
  } catch (const std::invalid_argument& fault) {
    refuse(kParameter, directory, std::string(kAllowed) + fault.what());
  }
  std::error_code unknown;
  if (fs::exists(directory_, unknown) && !fs::is_directory(directory_, unknown)) {
    refuse(kParameter, directory, "a directory, or a name that is free");
  }
}

fs::path SceneDirectory::inside(const std::string& path) const {
  if (path.find('\0') != std::string::npos) {
    refuse("path", path, "the name of a file, without a zero byte");
  }
  if (path.empty()) refuse("path", path, "the name of a file");
  try {
    fs::path whole =
        fs::weakly_canonical(core::linksFollowed(directory_ / core::homeExpanded(path)));
    const fs::path from_here = whole.lexically_relative(directory_);
    if (from_here.empty() || *from_here.begin() == "..") {
      refuse("path", path, "files inside " + core::onOneLine(directory_));
    }
    if (from_here == "." || fs::is_directory(whole)) {
      refuse("path", path, "the name of a file, not a directory");
    }
    return whole;
  } catch (const fs::filesystem_error& fault) {
    refuse("path", path, "the name of a file; " + fault.code().message());
  }
}

void SceneDirectory::make() const {
  core::orFailTo("make", directory_, [&] { fs::create_directories(directory_); });
}

}  // namespace spherical_springs
