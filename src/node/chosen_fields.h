// The fields that a request of ~set_particles or ~set_springs names; the others keep their values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "node/kinds.h"
#include "spherical_springs/range.h"
#include "spherical_springs/scene.h"

namespace spherical_springs {

/// Names of fields; none stand for all of them.
class ChosenFields {
 public:
  explicit ChosenFields(const std::vector<std::string>& names) : names_(names) {}

  bool areAll() const { return names_.empty(); }

  bool contains(const char* name) const {
    return areAll() || std::find(names_.begin(), names_.end(), name) != names_.end();
  }

  /// @throw std::invalid_argument for a name that is not among `allowed`, fields of a `what`.
  void requireAmong(const std::vector<std::string>& allowed, const char* what) const {
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (std::find(allowed.begin(), allowed.end(), names_[i]) != allowed.end()) continue;
      std::string words;
      for (const std::string& name : allowed) words += (words.empty() ? "" : ", ") + name;
      throw std::invalid_argument("fields[" + std::to_string(i) + "] is " +
                                  core::quoted(names_[i]) + "; allowed for " + what + ": " + words +
                                  "; or no fields at all, for all of them");
    }
  }

 private:
  const std::vector<std::string>& names_;
};

/// The names of the fields of a particle.
inline std::vector<std::string> particleFields() {
  return {"position", "angular_velocity", "mass", "damping", "pinned"};
}

/// The names of the fields of a spring.
template <class Spring>
std::vector<std::string> springFields() {
  std::vector<std::string> names = {"particles"};
  Spring spring;
  Spring::visitFields(
      spring, [&](const char* name, double, const core::Range&) { names.emplace_back(name); });
  names.emplace_back("at_rest");
  return names;
}

/// @throw std::invalid_argument for a name that some spring of the request has no field of, or any
/// spring if there is none in the request.
template <class Request>
void requireSpringFields(const ChosenFields& chosen, const Request& request) {
  std::vector<std::string> of_any_kind;
  core::forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const std::vector<std::string> names = springFields<Spring>();
    of_any_kind.insert(of_any_kind.end(), names.begin(), names.end());
    if (KindInMessages<Spring>::springs(request).empty()) return;
    chosen.requireAmong(names, Spring::kTable);
  });
  chosen.requireAmong(of_any_kind, "springs");
}

/// Gives `wanted` the values of `present` in the fields that are not chosen.
inline void keepOthers(const ChosenFields& chosen, const core::Particle& present,
                       core::Particle& wanted) {
  if (!chosen.contains("position")) wanted.position = present.position;
  if (!chosen.contains("angular_velocity")) wanted.angular_velocity = present.angular_velocity;
  if (!chosen.contains("mass")) wanted.mass = present.mass;
  if (!chosen.contains("damping")) wanted.damping = present.damping;
  if (!chosen.contains("pinned")) wanted.pinned = present.pinned;
}

/// Gives `wanted` the values of `present` in the fields that are not chosen.
template <class Spring>
void keepOthers(const ChosenFields& chosen, const Spring& present, Spring& wanted) {
  if (!chosen.contains("particles")) wanted.particles = present.particles;
  if (!chosen.contains("at_rest")) wanted.at_rest = present.at_rest;
  Spring::visitFields(wanted, [&](const char* name, double& value, const core::Range&) {
    if (chosen.contains(name)) return;
    Spring::visitFields(present, [&](const char* other, double kept, const core::Range&) {
      if (std::string_view(other) == name) value = kept;
    });
  });
}

/// Gives items the values that they have now in the fields that are not chosen. Ids that there are
/// not are left to the scene, which refuses them.
template <class Item, class Present>
void keepOthersOfAll(const ChosenFields& chosen, const core::IdTable<Item>& table,
                     const std::vector<std::uint32_t>& ids, const Present& present,
                     std::vector<Item>& items) {
  if (chosen.areAll()) return;
  for (std::size_t i = 0; i < std::min(ids.size(), items.size()); ++i) {
    if (const auto index = table.find(ids[i])) keepOthers(chosen, present(*index), items[i]);
  }
}

}  // namespace spherical_springs
