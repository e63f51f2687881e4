#pragma once

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace spherical_springs::core {

constexpr const char* kSceneFormat = "spherical_springs scene 1";

[[noreturn]] inline void failTo(const char* what, const std::filesystem::path& path) {
  throw std::runtime_error(std::string("cannot ") + what + " " + path.string() + ": " +
                           std::strerror(errno));
}

}  // namespace spherical_springs::core
