#include "maps/coverage.h"

#include <algorithm>
#include <cmath>

namespace spherical_springs::mesh {

bool surelyPositive(const Vector3& a, const Vector3& b, const Vector3& c) {
  // Covers differences of unit vectors, their products, and points that are rays from the centre.
  constexpr double kRounding = 3e-15;
  const double edges = (b - a).norm() * (c - a).norm();
  return core::tripleProduct(a, b, c) > kRounding * edges;
}

bool coversOnce(const Faces& faces, const Points& points) {
  double sum = 0;
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    const Vector3 a = points.col(faces(0, f)), b = points.col(faces(1, f)),
                  c = points.col(faces(2, f));
    if (!surelyPositive(a, b, c)) return false;
    sum += core::solidAngle(a, b, c);
  }
  return std::abs(sum - 4 * core::kPi) < 1;
}

double spreadOf(const Faces& faces, const Eigen::VectorXd& shares, const Points& points) {
  double sum = 0, squares = 0;  // the mean of the logarithms is small beside their deviation
  for (Eigen::Index f = 0; f < faces.cols(); ++f) {
    const double area =
        core::solidAngle(points.col(faces(0, f)), points.col(faces(1, f)), points.col(faces(2, f)));
    const double log = std::log(area / shares[f]);
    sum += log;
    squares += log * log;
  }
  const double mean = sum / faces.cols();
  return std::sqrt(std::max(0., squares / faces.cols() - mean * mean));
}

}  // namespace spherical_springs::mesh
