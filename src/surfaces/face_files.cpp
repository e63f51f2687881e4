#include "surfaces/face_files.h"

#include <iomanip>
#include <limits>
#include <stdexcept>
#include <string>

#include "spherical_springs/range.h"
#include "surfaces/byte_order_mark.h"

namespace spherical_springs::mesh {

Values readDensities(std::istream& in, Eigen::Index faces, const core::Checkpoint& checkpoint) {
  const core::Range allowed{0, std::numeric_limits<double>::max(), "a positive number", true};
  Values densities(faces);
  Eigen::Index count = 0;
  skipByteOrderMark(in);
  for (std::string text; in >> text; ++count) {
    checkpoint();
    char* end;
    const double density = std::strtod(text.c_str(), &end);
    if (*end != '\0' || !allowed.contains(density)) {
      throw std::invalid_argument("density " + std::to_string(count) + " is " +
                                  core::shortened(text) + "; allowed: " + allowed.allowed);
    }
    if (count < faces) densities[count] = density;
  }
  if (count != faces) {
    throw std::invalid_argument("it has " + std::to_string(count) +
                                (count == 1 ? " number" : " numbers") +
                                "; allowed: " + std::to_string(faces) + ", one a face");
  }
  return densities;
}

void writeMetrics(std::ostream& out, const ValuesRef& shares, const FaceDistortion& faces,
                  const core::Checkpoint& checkpoint) {
  out << "face,share_sr,area_sr,log_area_ratio,angle_change_1_rad,angle_change_2_rad,"
         "angle_change_3_rad\n"
      << std::setprecision(std::numeric_limits<double>::max_digits10);
  for (Eigen::Index f = 0; f < shares.size(); ++f) {
    checkpoint();
    out << f << ',' << shares[f] << ',' << faces.areas[f] << ',' << faces.log_area_ratios[f];
    for (int k = 0; k < 3; ++k) out << ',' << faces.angle_changes(k, f);
    out << '\n';
  }
}

}  // namespace spherical_springs::mesh
