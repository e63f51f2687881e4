// Files read whole, and files that are whole at every moment.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace spherical_springs::core {

/// @throw std::runtime_error: "cannot `what` `path`: " and what the system says.
[[noreturn]] void failTo(const std::string& what, const std::filesystem::path& path);

/// @throw std::runtime_error for what is not a regular file, or cannot be read.
std::ifstream openToRead(const std::filesystem::path& path);

/// Writes a file beside `path`, puts it on the disk, and gives it that name: what was there before
/// stays until then, and for good where anything fails.
/// @throw std::runtime_error for what is there and no regular file, where the file cannot be
/// written, or what `write` throws.
void replaceFile(const std::filesystem::path& path,
                 const std::function<void(std::ostream&)>& write);

}  // namespace spherical_springs::core
