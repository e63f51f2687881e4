#pragma once

#include <filesystem>
#include <string>

namespace spherical_springs {

/// The one directory in which services may read and write files.
class SceneDirectory {
 public:
  /// A leading `~` or `~name` is a home directory, here and in `inside`.
  explicit SceneDirectory(const std::string& directory);

  /// @return the whole path of `path`, which is relative to the directory and inside it, links
  /// followed. @throw std::invalid_argument for any other.
  std::filesystem::path inside(const std::string& path) const;

  /// Makes the directory where it is missing. @throw std::runtime_error where it cannot be made.
  void make() const;

  const std::filesystem::path& path() const { return directory_; }

 private:
  std::filesystem::path directory_;
};

}  // namespace spherical_springs
