// The report, transcribed to the letter: quaternions, logarithms, acos, explicit Euler. It shares
// no code with the package, so that one can be held against the other. Angelidis, "Spherical
// Springs", OUCS-2004-01; the numbers are those of its sections and equations.
#pragma once

#include <array>
#include <cmath>
#include <vector>

namespace report {

// A vector is the logarithm of a unit quaternion, or the vector part of one.
struct Vector {
  double x = 0, y = 0, z = 0;
};
inline Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vector operator*(double s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vector cross(Vector a, Vector b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(Vector a) { return std::sqrt(dot(a, a)); }

// Section 2.
struct Quaternion {
  double s = 0;
  Vector v;
};
inline Quaternion operator*(Quaternion p, Quaternion q) {
  return {p.s * q.s - dot(p.v, q.v), p.s * q.v + q.s * p.v + cross(p.v, q.v)};
}
inline Quaternion conjugate(Quaternion q) { return {q.s, -1.0 * q.v}; }
inline Quaternion exp(Vector log) {
  const double theta = norm(log);
  if (theta == 0) return {1, {}};
  return {std::cos(theta), (std::sin(theta) / theta) * log};
}

struct Particle {
  Vector position;
  Vector log_speed;  // of section 4
  double mass = 1;
  double damping = 0;  // k_d of section 3.4
};

struct AngleSpring {
  std::array<int, 2> particles;
  double rest, stiffness;
};

struct SolidAngleSpring {
  std::array<int, 3> particles;
  double rest, stiffness;
};

struct Scene {
  std::vector<Particle> particles;
  std::vector<AngleSpring> angle_springs;
  std::vector<SolidAngleSpring> solid_angle_springs;
};

// Equation 3: log of the force on i.
inline Vector angleForce(const AngleSpring& spring, Vector i, Vector j) {
  const double theta = spring.stiffness / 2 * (std::acos(dot(i, j)) - spring.rest);
  const Vector axis = cross(i, j);
  return (theta / norm(axis)) * axis;
}

// Section 3.2 and appendix A: log of the spherical gradient of the solid angle at i.
inline Vector logGradient(Vector half_gradient, Vector p) {
  const Vector other = std::abs(p.x) < 0.5 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  const Vector normal = cross(other, p);
  const Vector x = (1 / norm(normal)) * normal;
  const Vector y = cross(p, x);
  return dot(half_gradient, x) * y - dot(half_gradient, y) * x;
}

// Equation 4: log of the force on i.
inline Vector solidAngleForce(const SolidAngleSpring& spring, Vector i, Vector j, Vector k) {
  const double alpha = dot(i, cross(j, k));
  const double beta = 1 + dot(i, j) + dot(j, k) + dot(k, i);
  const double solid_angle = 2 * std::atan2(alpha, beta);
  const double squared = alpha * alpha + beta * beta;
  const Vector half_gradient = (1 / squared) * (beta * cross(j, k) - alpha * (j + k));
  return (-spring.stiffness * (solid_angle - spring.rest)) * logGradient(half_gradient, i);
}

// Sections 3.4 and 3.6.
inline std::vector<Vector> forces(const Scene& scene) {
  std::vector<Vector> sums(scene.particles.size());
  for (const AngleSpring& spring : scene.angle_springs) {
    const auto [i, j] = spring.particles;
    const Vector p = scene.particles[i].position;
    const Vector q = scene.particles[j].position;
    sums[i] = sums[i] + angleForce(spring, p, q);
    sums[j] = sums[j] + angleForce(spring, q, p);
  }
  for (const SolidAngleSpring& spring : scene.solid_angle_springs) {
    const auto [i, j, k] = spring.particles;
    const Vector p = scene.particles[i].position;
    const Vector q = scene.particles[j].position;
    const Vector r = scene.particles[k].position;
    sums[i] = sums[i] + solidAngleForce(spring, p, q, r);
    sums[j] = sums[j] + solidAngleForce(spring, q, r, p);
    sums[k] = sums[k] + solidAngleForce(spring, r, p, q);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    sums[i] = sums[i] - scene.particles[i].damping * scene.particles[i].log_speed;
  }
  return sums;
}

// Section 5.
inline void step(Scene& scene, double dt) {
  const std::vector<Vector> log_forces = forces(scene);
  for (std::size_t i = 0; i < scene.particles.size(); ++i) {
    Particle& particle = scene.particles[i];
    const Vector log_acceleration = (1 / particle.mass) * log_forces[i];
    particle.log_speed = particle.log_speed + dt * log_acceleration;
    const Quaternion turn = exp(dt * particle.log_speed);
    particle.position = (turn * Quaternion{0, particle.position} * conjugate(turn)).v;
  }
}

}  // namespace report
