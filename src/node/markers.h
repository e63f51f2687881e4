// A scene at one moment as markers for RViz. Headers are left to the caller.
#pragma once

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include "spherical_springs/system.h"

namespace spherical_springs {

/// Blue at -1 (shorter or smaller than at rest), white at 0, orange at 1 (longer or larger); linear
/// between, and told apart by the colour-blind. `shade`: from 0, black, to 1, the full colour.
std_msgs::ColorRGBA strainColour(double strain, double shade = 1);

/// The sphere itself, drawn a little smaller than `radius` [m], so that what lies on it shows.
visualization_msgs::Marker sphereMarker(double radius);

/// `positions`: unit vectors, one column a particle. One point a particle, in the order of ids;
/// pinned ones are black.
visualization_msgs::Marker particlesMarker(const core::System& system,
                                           const core::Points& positions, double radius);

/// Springs whose shape is an arc as pieces of great circles, coloured by strain. A piece is so
/// short that its chord lies within a tenth of the line's width of the sphere, unless there are too
/// many long springs for that.
visualization_msgs::Marker arcsMarker(const core::System& system, const core::Points& positions,
                                      double radius);

/// Springs whose shape is a triangle, likewise; a little below the arcs,
/// and a shade darker.
visualization_msgs::Marker trianglesMarker(const core::System& system,
                                           const core::Points& positions, double radius);

}  // namespace spherical_springs
