// How a compiler lays out what programs and the library hand to each other.
#pragma once

#include <cstddef>

#include "simulation/runner.h"
#include "spherical_springs/covariance.h"
#include "spherical_springs/maps/distortion.h"
#include "spherical_springs/maps/mesh_map.h"

namespace spherical_springs {

struct TypeLayout {
  const char* type;
  std::size_t size, alignment;
};

template <class T>
constexpr TypeLayout layoutOf(const char* type) {
  return {type, sizeof(T), alignof(T)};
}

/// Every type that crosses, as it is in the file that includes this.
constexpr TypeLayout kLayouts[] = {
    layoutOf<core::Vector2>("Vector2"),
    layoutOf<core::Vector3>("Vector3"),
    layoutOf<core::Matrix2>("Matrix2"),
    layoutOf<core::Matrix3>("Matrix3"),
    layoutOf<core::TangentFrame>("TangentFrame"),
    layoutOf<core::Points>("Points"),
    layoutOf<core::Values>("Values"),
    layoutOf<core::ValuesRef>("ValuesRef"),
    layoutOf<core::Arc>("Arc"),
    layoutOf<core::Condition<2>>("Condition<2>"),
    layoutOf<core::Condition<3>>("Condition<3>"),
    layoutOf<core::TangentCondition<2>>("TangentCondition<2>"),
    layoutOf<core::TangentCondition<3>>("TangentCondition<3>"),
    layoutOf<core::Particle>("Particle"),
    layoutOf<core::Scene>("Scene"),
    layoutOf<core::SceneFile>("SceneFile"),
    layoutOf<core::Damping>("Damping"),
    layoutOf<core::System>("System"),
    layoutOf<core::System::Workspace>("System::Workspace"),
    layoutOf<core::Plan>("Plan"),
    layoutOf<core::State>("State"),
    layoutOf<core::Account>("Account"),
    layoutOf<core::Measures>("Measures"),
    layoutOf<core::Simulation>("Simulation"),
    layoutOf<core::RelaxationOptions>("RelaxationOptions"),
    layoutOf<core::RelaxationResult>("RelaxationResult"),
    layoutOf<core::Relaxer>("Relaxer"),
    layoutOf<core::Runner>("Runner"),
    layoutOf<core::Runner::Snapshot>("Runner::Snapshot"),
    layoutOf<mesh::Faces>("Faces"),
    layoutOf<mesh::TriangleMesh>("TriangleMesh"),
    layoutOf<mesh::MapOptions>("MapOptions"),
    layoutOf<mesh::MeshMap>("MeshMap"),
    layoutOf<mesh::FaceDistortion>("FaceDistortion"),
    layoutOf<mesh::Distortion>("Distortion"),
};

/// `kLayouts` of a file that is compiled as the library is.
const TypeLayout* layoutsOfLibrary();

}  // namespace spherical_springs
