// Files read whole, and files that are whole at every moment.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

#include "spherical_springs/range.h"

namespace spherical_springs::core {

/// @throw std::runtime_error: "cannot `what` `path`: " and what the system says.
[[noreturn]] void failTo(const std::string& what, const std::filesystem::path& path);

/// Returns `use()`.
/// @throw what `use` throws, with a std::filesystem_error worded as by `failTo`.
template <class Use>
auto orFailTo(const std::string& what, const std::filesystem::path& path, const Use& use) {
  try {
    return use();
  } catch (const std::filesystem::filesystem_error& fault) {
    throw std::runtime_error("cannot " + what + " " + onOneLine(path) + ": " +
                             fault.code().message());
  }
}

/// @throw std::runtime_error for what is not a regular file, or cannot be read.
std::ifstream openToRead(const std::filesystem::path& path);

/// The file that the symbolic links at the end of `path` lead to, whether it exists or not.
/// @throw std::filesystem::filesystem_error for links that lead round in circles.
std::filesystem::path linksFollowed(std::filesystem::path path);

/// Returns a path with a leading `~` or `~name` replaced by a home directory, as a shell would do.
/// @throw std::invalid_argument where no user has that name.
std::filesystem::path homeExpanded(const std::string& path);

/// Writes a file beside the one that `path` leads to, puts it on the disk, and gives it that name:
/// what was there before stays until then, and for good where anything fails. The new file has the
/// permissions of the old one, and its owner and group where the system allows it.
/// @throw std::runtime_error for what is there and no regular file, where the file cannot be
/// written, or what `write` throws.
void replaceFile(const std::filesystem::path& path,
                 const std::function<void(std::ostream&)>& write);

}  // namespace spherical_springs::core
