#include "scene_directory.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace spherical_springs {

namespace fs = std::filesystem;

SceneDirectory::SceneDirectory(const std::string& directory) : directory_(directory) {
  const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (directory == "~" || directory.rfind("~/", 0) == 0) {
    directory_ = fs::path(home != nullptr ? home : "/") /
                 directory.substr(std::min<std::size_t>(2, directory.size()));
  }
  directory_ = fs::weakly_canonical(fs::absolute(directory_));
  if (fs::exists(directory_) && !fs::is_directory(directory_)) {
    throw std::invalid_argument("parameter ~scene_directory is '" + directory +
                                "'; allowed: a directory, or a name that is free");
  }
}

fs::path SceneDirectory::inside(const std::string& path) const {
  const auto refuse = [&](const std::string& allowed) {
    throw std::invalid_argument("path is '" + path + "'; allowed: " + allowed);
  };
  if (path.find('\0') != std::string::npos) {
    throw std::invalid_argument("path has a zero byte; allowed: the name of a file");
  }
  if (path.empty()) refuse("the name of a file");
  fs::path whole = fs::weakly_canonical(directory_ / path);
  const fs::path from_here = whole.lexically_relative(directory_);
  if (from_here.empty() || *from_here.begin() == "..") {
    refuse("files inside " + directory_.string());
  }
  if (from_here == "." || fs::is_directory(whole)) refuse("the name of a file, not a directory");
  return whole;
}

}  // namespace spherical_springs
