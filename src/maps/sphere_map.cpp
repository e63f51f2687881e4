#include "spherical_springs/maps/sphere_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "maps/coverage.h"
#include "maps/mapping.h"
#include "maps/topological_sphere.h"
#include "spherical_springs/maps/mesh_map.h"

namespace spherical_springs::mesh {
namespace {

std::string text(double value) {
  std::ostringstream stream;
  stream << value;
  return stream.str();
}

/// Three great circles cannot enclose half of the sphere, and come near to that only in a circle.
constexpr double kLargestShare = 0.45;  // of the sphere

void requireShares(const TriangleMesh& mesh, const ValuesRef& shares) {
  if (shares.size() != mesh.faces.cols()) {
    throw std::invalid_argument("there are " + std::to_string(shares.size()) + " shares for " +
                                std::to_string(mesh.faces.cols()) + " faces");
  }
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    if (!(shares[f] > 0 && std::isfinite(shares[f]))) {
      throw std::invalid_argument("share of face " + std::to_string(f) + " is " + text(shares[f]) +
                                  "; allowed: above 0 [sr]");
    }
  }
  Eigen::Index largest = 0;
  const double share = shares.maxCoeff(&largest) / (4 * core::kPi);
  if (share > kLargestShare) {
    throw std::invalid_argument("face " + std::to_string(largest) + " is to have " +
                                text(100 * share) + " % of the sphere; allowed: up to " +
                                text(100 * kLargestShare) +
                                " %, as a triangle on the sphere has less than half of it");
  }
}

void requireOptions(const MapOptions& options) {
  const auto require = [](bool allowed, const std::string& name, double value,
                          const std::string& range) {
    if (!allowed) {
      throw std::invalid_argument(name + " is " + text(value) + "; allowed: " + range);
    }
  };
  core::requireInside(kAngleWeights, options.angle_weight, "angle_weight");
  require(options.tolerance >= 0, "tolerance", options.tolerance, "0 or more");
  require(options.max_time >= 0, "max_time", options.max_time, "0 or more [s]");
  require(options.threads >= 1, "threads", options.threads, "1 or more");
}

Points directions(const TriangleMesh& mesh, const Points& start) {
  if (start.cols() != mesh.vertices.cols()) {
    throw std::invalid_argument("the start has " + std::to_string(start.cols()) +
                                " vertices, the mesh " + std::to_string(mesh.vertices.cols()));
  }
  Points result(3, start.cols());
  for (Eigen::Index v = 0; v < start.cols(); ++v) {
    if (!start.col(v).allFinite() || start.col(v).isZero(0)) {
      throw std::invalid_argument("vertex " + std::to_string(v) +
                                  " of the start is zero or not finite");
    }
    result.col(v) = core::direction(start.col(v));
  }
  return result;
}

/// Returns the projection from the middle where that leaves nothing to be found, as it does for a
/// sphere or a cube.
std::optional<Points> goodProjection(const TriangleMesh& mesh, const Eigen::VectorXd& shares,
                                     const MapOptions& options) {
  if (options.angle_weight > 0) return std::nullopt;
  Points projection = centralProjection(mesh);
  if (!coversOnce(mesh.faces, projection) ||
      spreadOf(mesh.faces, shares, projection) > options.tolerance) {
    return std::nullopt;
  }
  return projection;
}

}  // namespace

Values faceShares(const ValuesRef& areas) {
  constexpr double kLeast = 1e-6;  // of the mean
  double largest = 0;
  for (Eigen::Index f = 0; f < areas.size(); ++f) {
    if (!(areas[f] >= 0 && std::isfinite(areas[f]))) {
      throw std::invalid_argument("the area of face " + std::to_string(f) +
                                  ", with its density, is " + text(areas[f]) +
                                  "; allowed: 0 or more, finite");
    }
    largest = std::max(largest, areas[f]);
  }
  if (largest == 0) throw std::invalid_argument("the areas of all faces are 0");
  const Eigen::VectorXd scaled = areas / largest;
  const Eigen::VectorXd shares = scaled.cwiseMax(kLeast * scaled.mean());
  return shares * (4 * core::kPi / shares.sum());
}

Points sphereMap(const TriangleMesh& mesh, const ValuesRef& shares, const MapOptions& options) {
  requireTopologicalSphere(mesh);
  requireShares(mesh, shares);
  requireOptions(options);
  const Eigen::VectorXd wanted = shares;
  return Mapping(mesh.faces, wanted, static_cast<std::int32_t>(mesh.vertices.cols()), options)
      .run(goodProjection(mesh, wanted, options));
}

Points sphereMap(const TriangleMesh& mesh, const ValuesRef& shares, const Points& start,
                 const MapOptions& options) {
  requireTopologicalSphere(mesh);
  requireShares(mesh, shares);
  requireOptions(options);
  Points own = directions(mesh, start);
  if (!coversOnce(mesh.faces, own)) return sphereMap(mesh, shares, options);
  const Eigen::VectorXd wanted = shares;
  return Mapping(mesh.faces, wanted, static_cast<std::int32_t>(mesh.vertices.cols()), options)
      .run(std::move(own));
}

}  // namespace spherical_springs::mesh
