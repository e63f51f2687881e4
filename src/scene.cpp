#include "spherical_springs/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace spherical_springs::core {
namespace {

using Ids = std::vector<std::uint32_t>;

[[noreturn]] void refuse(const std::string& field, const std::string& value,
                         const std::string& allowed) {
  throw std::invalid_argument(field + " is " + value + "; allowed: " + allowed);
}

std::string itemName(const std::string& list, std::size_t index) {
  return list + "[" + std::to_string(index) + "]";
}

std::string toText(const Vector3& v) {
  using core::toText;
  return "(" + toText(v.x()) + ", " + toText(v.y()) + ", " + toText(v.z()) + ")";
}

template <class Item>
void checkFields(const Item& item) {
  Item::visitFields(item, [](const char* field, double value, const Range& range) {
    requireInside(range, value, field);
  });
}

/// Puts the item's name before what `check` has to say against it.
template <class Item, class Check>
void checkEach(std::vector<Item>& items, const char* list, Check&& check) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    try {
      check(items[i]);
    } catch (const std::invalid_argument& fault) {
      throw std::invalid_argument(itemName(list, i) + "." + fault.what());
    }
  }
}

/// Drops the part of `angular_velocity` along the position; one that is normal to it to rounding
/// stays as it is, to the last bit.
Vector3 tangentPart(const Vector3& position, const Vector3& angular_velocity) {
  constexpr double kNormalTolerance = 4 * std::numeric_limits<double>::epsilon();
  Vector3 tangent = angular_velocity;
  for (int i = 0; i < 3; ++i) {  // more than once where little is left beside what is dropped
    const double along = position.dot(tangent);
    if (std::abs(along) <= kNormalTolerance * tangent.norm()) break;
    tangent -= along * position;
  }
  return tangent;
}

void checkParticle(Particle& particle) {
  if (!particle.position.allFinite() || particle.position.isZero(0)) {
    refuse("position", toText(particle.position), "any finite non-zero vector");
  }
  if (!(particle.angular_velocity.array().abs() <= kFastest).all()) {
    refuse("angular_velocity", toText(particle.angular_velocity), "finite, up to 1e100 [rad/s]");
  }
  if (particle.mass == 0) particle.mass = 1;
  checkFields(particle);
  particle.position = direction(particle.position);
  particle.angular_velocity = particle.pinned
                                  ? Vector3(Vector3::Zero())
                                  : tangentPart(particle.position, particle.angular_velocity);
}

void checkParticles(std::vector<Particle>& particles) {
  checkEach(particles, "particles", checkParticle);
}

template <class Item>
std::vector<std::size_t> indicesOf(const IdTable<Item>& table, const Ids& ids,
                                   const std::string& list, const std::string& what) {
  std::vector<std::size_t> indices(ids.size());
  std::vector<bool> seen(table.size(), false);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const auto index = table.find(ids[i]);
    if (!index) refuse(itemName(list, i), std::to_string(ids[i]), "the id of " + what);
    if (seen[*index]) refuse(itemName(list, i), std::to_string(ids[i]) + " again", "each id once");
    seen[*index] = true;
    indices[i] = *index;
  }
  return indices;
}

void requireSameLength(const std::string& ids, std::size_t id_count, const std::string& items,
                       std::size_t item_count) {
  if (id_count == item_count) return;
  throw std::invalid_argument(ids + " has " + std::to_string(id_count) + " items and " + items +
                              " has " + std::to_string(item_count) +
                              "; allowed: as many of one as of the other");
}

void requireRoom(const std::string& what, std::size_t present, std::size_t added,
                 std::size_t limit) {
  if (added <= limit && present <= limit - added) return;
  throw std::invalid_argument(what + " would be " + std::to_string(present + added) +
                              " in all; allowed: at most " + std::to_string(limit));
}

template <class Item>
void requireFreeIds(const IdTable<Item>& table, std::size_t added, const std::string& what) {
  if (added <= std::numeric_limits<std::uint32_t>::max() - table.nextId()) return;
  throw std::invalid_argument(what + ": no ids are left");
}

template <class Item>
void requireRisingIds(const IdTable<Item>& table, const Ids& ids, const std::string& list) {
  std::uint64_t least = table.nextId();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max() - 1;
    if (ids[i] < least || ids[i] > kMost) {
      refuse(itemName(list, i) + ".id", std::to_string(ids[i]),
             std::to_string(least) + " to " + std::to_string(kMost) + ", rising");
    }
    least = std::uint64_t(ids[i]) + 1;
  }
}

template <class Spring>
std::string idListName() {
  const std::string table = Spring::kTable;
  return table.substr(0, table.size() - 1) + "_ids";
}

template <class Spring>
std::string oneOf() {
  std::string name = Spring::kTable;
  std::replace(name.begin(), name.end(), '_', ' ');
  return "a spring among the " + name;
}

template <class Spring>
struct Indices {
  std::vector<std::size_t> values;
};

template <class Spring>
struct Marks {
  std::vector<bool> values;
};

template <class Spring>
std::array<std::size_t, Spring::kParticles> particleIndices(const IdTable<Particle>& particles,
                                                            const Spring& spring) {
  std::array<std::size_t, Spring::kParticles> indices;
  for (std::size_t j = 0; j < Spring::kParticles; ++j) {
    const std::uint32_t id = spring.particles[j];
    const auto index = particles.find(id);
    if (!index) refuse(itemName("particles", j), std::to_string(id), "the id of a particle");
    if (std::find(indices.begin(), indices.begin() + j, *index) != indices.begin() + j) {
      refuse(itemName("particles", j), std::to_string(id) + " again", "particles that differ");
    }
    indices[j] = *index;
  }
  return indices;
}

template <class Spring>
void checkSpring(Spring& spring, const IdTable<Particle>& particles, const Points& positions) {
  const auto indices = particleIndices(particles, spring);
  if (spring.at_rest) {
    std::array<Vector3, Spring::kParticles> points;
    for (std::size_t j = 0; j < Spring::kParticles; ++j) points[j] = positions.col(indices[j]);
    rest(spring, points);
    spring.at_rest = false;
  }
  checkFields(spring);
}

}  // namespace

std::size_t Scene::springCount() const {
  std::size_t count = 0;
  forEachKind([&](auto kind) { count += springs<typename decltype(kind)::type>().size(); });
  return count;
}

Ids Scene::addParticles(std::vector<Particle> particles) {
  requireRoom("particles", particles_.size(), particles.size(), limits_.particles);
  requireFreeIds(particles_, particles.size(), "particles");
  checkParticles(particles);
  Ids ids;
  ids.reserve(particles.size());
  for (const Particle& particle : particles) ids.push_back(particles_.add(particle));
  return ids;
}

std::vector<std::size_t> Scene::setParticles(const Ids& ids, std::vector<Particle> particles) {
  requireSameLength("ids", ids.size(), "particles", particles.size());
  const auto indices = indicesOf(particles_, ids, "ids", "a particle");
  checkParticles(particles);
  for (std::size_t i = 0; i < indices.size(); ++i) particles_.item(indices[i]) = particles[i];
  return indices;
}

Scene::Removal Scene::removeParticles(const Ids& ids) {
  Removal removal;
  removal.particles.assign(particles_.size(), false);
  for (const std::size_t index : indicesOf(particles_, ids, "ids", "a particle")) {
    removal.particles[index] = true;
  }
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    auto& table = springs_.get<Spring>();
    std::vector<bool> doomed(table.size(), false);
    for (std::size_t s = 0; s < table.size(); ++s) {
      const auto& ends = table.item(s).particles;
      doomed[s] = std::any_of(ends.begin(), ends.end(), [&](std::uint32_t id) {
        return removal.particles[*particles_.find(id)];
      });
      removal.springs += doomed[s];
    }
    table.remove(doomed);
  });
  particles_.remove(removal.particles);
  return removal;
}

void Scene::checkSprings(SpringLists& springs, const Points& positions) const {
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    checkEach(springs.get<Spring>(), Spring::kTable,
              [&](Spring& spring) { checkSpring(spring, particles_, positions); });
  });
}

SpringIds Scene::addSprings(SpringLists springs, const Points& positions) {
  std::size_t added = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    added += springs.get<Spring>().size();
    requireFreeIds(springs_.get<Spring>(), springs.get<Spring>().size(), Spring::kTable);
  });
  requireRoom("springs", springCount(), added, limits_.springs);
  checkSprings(springs, positions);
  SpringIds ids;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const Spring& spring : springs.get<Spring>()) {
      ids.get<Spring>().push_back(springs_.get<Spring>().add(spring));
    }
  });
  return ids;
}

void Scene::setSprings(const SpringIds& ids, SpringLists springs, const Points& positions) {
  PerKind<Indices> indices;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    requireSameLength(idListName<Spring>(), ids.get<Spring>().size(), Spring::kTable,
                      springs.get<Spring>().size());
    indices.get<Spring>() = {indicesOf(springs_.get<Spring>(), ids.get<Spring>(),
                                       idListName<Spring>(), oneOf<Spring>())};
  });
  checkSprings(springs, positions);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs.get<Spring>();
    for (std::size_t i = 0; i < list.size(); ++i) {
      springs_.get<Spring>().item(indices.get<Spring>().values[i]) = list[i];
    }
  });
}

void Scene::removeSprings(const SpringIds& ids) {
  PerKind<Marks> doomed;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    auto& marks = doomed.get<Spring>().values;
    marks.assign(springs_.get<Spring>().size(), false);
    for (const std::size_t index : indicesOf(springs_.get<Spring>(), ids.get<Spring>(),
                                             idListName<Spring>(), oneOf<Spring>())) {
      marks[index] = true;
    }
  });
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    springs_.get<Spring>().remove(doomed.get<Spring>().values);
  });
}

void Scene::place(const Points& positions, const Points& angular_velocities) {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.item(i).position = positions.col(i);
    particles_.item(i).angular_velocity = angular_velocities.col(i);
  }
}

void Scene::clear() {
  particles_.clear();
  forEachKind([&](auto kind) { springs_.get<typename decltype(kind)::type>().clear(); });
}

Scene::Scene(SceneLimits limits, const Ids& particle_ids, std::vector<Particle> particles,
             const SpringIds& spring_ids, SpringLists springs)
    : limits_(limits) {
  requireRoom("particles", particles_.size(), particles.size(), limits_.particles);
  requireRisingIds(particles_, particle_ids, "particles");
  std::size_t added = 0;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    added += springs.get<Spring>().size();
    requireRisingIds(springs_.get<Spring>(), spring_ids.get<Spring>(), Spring::kTable);
  });
  requireRoom("springs", springCount(), added, limits_.springs);
  checkParticles(particles);
  for (std::size_t i = 0; i < particles.size(); ++i) particles_.add(particle_ids[i], particles[i]);

  Points positions(3, particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    positions.col(i) = particles_.item(i).position;
  }
  checkSprings(springs, positions);
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs.get<Spring>();
    for (std::size_t i = 0; i < list.size(); ++i) {
      springs_.get<Spring>().add(spring_ids.get<Spring>()[i], list[i]);
    }
  });
}

void Scene::reserveIdsOf(const Scene& earlier) {
  particles_.reserveIdsBelow(earlier.particles_.nextId());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    springs_.get<Spring>().reserveIdsBelow(earlier.springs<Spring>().nextId());
  });
}

}  // namespace spherical_springs::core
