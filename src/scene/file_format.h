#pragma once

namespace spherical_springs::core {

inline constexpr const char* kSceneFormat = "spherical_springs scene 1";

}  // namespace spherical_springs::core
