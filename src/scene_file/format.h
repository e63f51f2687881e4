#pragma once

#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace spherical_springs::core {

constexpr const char* kSceneFormat = "spherical_springs scene 1";

[[noreturn]] inline void failTo(const char* what, const std::filesystem::path& path) {
  throw std::runtime_error(std::string("cannot ") + what + " " + path.string() + ": " +
                           std::system_category().message(errno));
}

}  // namespace spherical_springs::core
