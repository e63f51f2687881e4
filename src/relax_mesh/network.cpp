#include "relax_mesh/network.h"

#include <cmath>

namespace spherical_springs::relax_mesh {
namespace {

/// The stiffness at which a spring holds 1/2 J where its angle, or solid angle, is off by all of
/// `rest`.
double stiffnessAt(double rest) { return 1 / (rest * rest); }

}  // namespace

AddParticles::Request particlesOf(const Network& network) {
  AddParticles::Request request;
  request.particles.resize(network.start.cols());
  for (Eigen::Index i = 0; i < network.start.cols(); ++i) {
    auto& position = request.particles[i].position;
    position.x = network.start(0, i);
    position.y = network.start(1, i);
    position.z = network.start(2, i);
  }
  return request;
}

/// Each edge of a closed surface rises in one of its two faces.
AddSprings::Request springsOf(const Network& network, const Ids& ids) {
  AddSprings::Request request;
  for (Eigen::Index f = 0; f < network.faces.cols(); ++f) {
    const auto face = network.faces.col(f);
    SolidAngleSpring area;
    area.particles = {ids[face[0]], ids[face[1]], ids[face[2]]};
    area.rest_solid_angle = network.rests[f];
    area.stiffness = stiffnessAt(area.rest_solid_angle);
    request.solid_angle_springs.push_back(area);
    for (int i = 0; i < 3; ++i) {
      const auto from = face[i], to = face[(i + 1) % 3];
      if (from > to) continue;
      AngleSpring arc;
      arc.particles = {ids[from], ids[to]};
      arc.rest_angle = core::arc(network.start.col(from), network.start.col(to)).angle;
      arc.stiffness = network.arc_weight * stiffnessAt(arc.rest_angle);
      request.angle_springs.push_back(arc);
    }
  }
  return request;
}

double torqueOf(double share, const Network& network) {
  return share * std::sqrt(network.faces.cols() / (4 * core::kPi));
}

}  // namespace spherical_springs::relax_mesh
