// Names of files to read.
#pragma once

#include <filesystem>
#include <string>

namespace spherical_springs::relax_mesh {

/// Returns the file that a path, with `~` or `~user` in front, a URL `file:///PATH` or a URL
/// `package://PACKAGE/PATH` names.
/// @throw std::invalid_argument where there is no such user or package, or the URL names another
/// host.
std::filesystem::path inputPath(const std::string& text);

}  // namespace spherical_springs::relax_mesh
