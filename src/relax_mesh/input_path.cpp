#include "relax_mesh/input_path.h"

#include <ros/package.h>

#include <cctype>
#include <stdexcept>

#include "base/files.h"
#include "spherical_springs/range.h"

namespace spherical_springs::relax_mesh {
namespace {

/// Returns what follows `scheme`, or nullptr where a text begins otherwise.
const char* after(const std::string& scheme, const std::string& text) {
  return text.compare(0, scheme.size(), scheme) == 0 ? text.c_str() + scheme.size() : nullptr;
}

/// Replaces %20 and the like (RFC 3986, 2.1).
std::string decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         std::isxdigit(static_cast<unsigned char>(text[i + 1])) != 0 &&
                         std::isxdigit(static_cast<unsigned char>(text[i + 2])) != 0;
    result += is_code ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
    if (is_code) i += 2;
  }
  return result;
}

std::filesystem::path fileOfUrl(const std::string& text, const std::string& host_and_path) {
  const std::size_t slash = host_and_path.find('/');
  const std::string host = host_and_path.substr(0, slash);
  if (slash == std::string::npos || !(host.empty() || host == "localhost")) {
    throw std::invalid_argument(core::quoted(text) + " names no file here; allowed: file:///PATH");
  }
  return decoded(host_and_path.substr(slash));
}

std::filesystem::path fileOfPackage(const std::string& text, const std::string& name_and_path) {
  const std::size_t slash = name_and_path.find('/');
  const std::string name = name_and_path.substr(0, slash);
  const std::string directory = name.empty() ? "" : ros::package::getPath(name);
  if (directory.empty() || slash == std::string::npos) {
    throw std::invalid_argument(core::quoted(text) + ": ROS knows no package " +
                                core::quoted(name) + "; allowed: package://PACKAGE/PATH");
  }
  return directory + decoded(name_and_path.substr(slash));
}

}  // namespace

std::filesystem::path inputPath(const std::string& text) {
  if (const char* rest = after("file://", text)) return fileOfUrl(text, rest);
  if (const char* rest = after("package://", text)) return fileOfPackage(text, rest);
  return core::homeExpanded(text);
}

}  // namespace spherical_springs::relax_mesh
