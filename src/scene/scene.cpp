#include "spherical_springs/scene.h"

#include <cstdint>
#include <limits>

#include "scene/checks.h"

namespace spherical_springs::core {
namespace {

bool differOnlyInMotion(const Particle& a, const Particle& b) {
  return a.mass == b.mass && a.damping == b.damping && a.pinned == b.pinned;
}

// Indices of 32 bits number the longest lists that are made of a scene; one of them means none. The
// blocks of the Hessian are one a particle and one for each ordered pair of ends of a spring. The
// rows of stepping are the particles, filled up to a multiple of 8 in patches of a thousand, and in
// each patch the ends in others of the springs that it shares with them.
constexpr std::uint64_t kMostIndices = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t kMostParticles = SceneLimits::kMostParticles;
constexpr std::uint64_t kMostPairs =
    kMostEnds * (kMostEnds - 1) * std::uint64_t{SceneLimits::kMostSprings};
static_assert(kMostParticles + kMostParticles / 64 + kMostPairs < kMostIndices);
// Rows of a patch are named by where they begin, four numbers each.
static_assert(4 * (kMostParticles + 8) < kMostIndices);

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
  particles_.makeRoomFor(particles.size());
  for (const Particle& particle : particles) ids.push_back(particles_.add(particle));
  return ids;
}

Scene::Setting Scene::setParticles(const Ids& ids, std::vector<Particle> particles) {
  requireSameLength("ids", ids.size(), "particles", particles.size());
  Setting setting;
  setting.indices = indicesOf(particles_, ids, "ids", "a particle");
  checkParticles(particles);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Particle& present = particles_.item(setting.indices[i]);
    setting.only_moved = setting.only_moved && differOnlyInMotion(present, particles[i]);
    present = particles[i];
  }
  return setting;
}

Scene::Removal Scene::removeParticles(const Ids& ids) {
  Removal removal;
  removal.particles.assign(particles_.size(), false);
  for (const std::size_t index : indicesOf(particles_, ids, "ids", "a particle")) {
    removal.particles[index] = true;
  }
  PerKind<Marks> doomed;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& table = springs_.get<Spring>();
    auto& marks = doomed.get<Spring>().values;
    marks.assign(table.size(), false);
    for (std::size_t s = 0; s < table.size(); ++s) {
      const auto& ends = table.item(s).particles;
      marks[s] = std::any_of(ends.begin(), ends.end(), [&](std::uint32_t id) {
        return removal.particles[*particles_.find(id)];
      });
      removal.springs += marks[s];
    }
  });
  remove(doomed);
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
    ids.get<Spring>().reserve(springs.get<Spring>().size());
    springs_.get<Spring>().makeRoomFor(springs.get<Spring>().size());
  });
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    for (const Spring& spring : springs.get<Spring>()) {
      ids.get<Spring>().push_back(springs_.get<Spring>().add(spring));
    }
  });
  return ids;
}

bool Scene::setSprings(const SpringIds& ids, SpringLists springs, const Points& positions) {
  PerKind<Indices> indices;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    requireSameLength(idListName<Spring>(), ids.get<Spring>().size(), Spring::kTable,
                      springs.get<Spring>().size());
    indices.get<Spring>() = {indicesOf(springs_.get<Spring>(), ids.get<Spring>(),
                                       idListName<Spring>(), oneOf<Spring>())};
  });
  checkSprings(springs, positions);
  bool same_particles = true;
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    const auto& list = springs.get<Spring>();
    for (std::size_t i = 0; i < list.size(); ++i) {
      Spring& present = springs_.get<Spring>().item(indices.get<Spring>().values[i]);
      same_particles = same_particles && present.particles == list[i].particles;
      present = list[i];
    }
  });
  return same_particles;
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
  remove(doomed);
}

void Scene::remove(const PerKind<Marks>& doomed) {
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
  Scene empty(limits_);
  empty.reserveIdsOf(*this);
  *this = std::move(empty);  // gives its memory back
}

Scene::Scene(SceneLimits limits, const Ids& particle_ids, std::vector<Particle> particles,
             const SpringIds& spring_ids, SpringLists springs)
    : limits_(limits.heldByIndices()) {
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
  requireIdsForOthers(particles_, earlier.particles_.nextId(), "particles");
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    requireIdsForOthers(springs_.get<Spring>(), earlier.springs<Spring>().nextId(), Spring::kTable);
  });
  particles_.reserveIdsBelow(earlier.particles_.nextId());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    springs_.get<Spring>().reserveIdsBelow(earlier.springs<Spring>().nextId());
  });
}

}  // namespace spherical_springs::core
