#include "spherical_springs/scene_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>

namespace spherical_springs::core {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* kFormat = "spherical_springs scene 1";

// --- reading ---

/// The fields of one object, each taken once; what is left at the end has no meaning.
class Fields {
 public:
  Fields(const Json& object, std::string name) : object_(object), name_(std::move(name)) {
    if (!object.is_object()) throw std::invalid_argument(name_ + " is not an object");
  }

  void take(const char* field, double& value) {
    takeIf(field, &Json::is_number, "a number", [&](const Json& j) { value = j.get<double>(); });
  }
  void take(const char* field, bool& value) {
    takeIf(field, &Json::is_boolean, "true or false",
           [&](const Json& j) { value = j.get<bool>(); });
  }
  void take(const char* field, std::string& value) {
    takeIf(field, &Json::is_string, "a text", [&](const Json& j) { value = j.get<std::string>(); });
  }
  void take(const char* field, std::uint32_t& value) {
    takeIf(field, &Json::is_number_unsigned, "an id",
           [&](const Json& j) { value = toId(j, field); });
  }
  void take(const char* field, Vector3& value) {
    takeIf(field, &Json::is_array, "three numbers", [&](const Json& j) {
      requireSize(j, 3, field);
      for (int i = 0; i < 3; ++i) {
        if (!j[i].is_number()) refuse(field, j, "three numbers");
        value[i] = j[i].get<double>();
      }
    });
  }
  template <std::size_t N>
  void take(const char* field, std::array<std::uint32_t, N>& value) {
    takeIf(field, &Json::is_array, "ids", [&](const Json& j) {
      requireSize(j, N, field);
      for (std::size_t i = 0; i < N; ++i) value[i] = toId(j[i], field);
    });
  }
  const Json& takeList(const char* field) {
    static const Json kEmpty = Json::array();
    const Json* list = &kEmpty;
    takeIf(field, &Json::is_array, "a list", [&](const Json& j) { list = &j; });
    return *list;
  }

  void requireNothingLeft() const {
    if (taken_ == object_.size()) return;
    for (const auto& item : object_.items()) {
      if (std::find(names_.begin(), names_.end(), item.key()) == names_.end()) {
        throw std::invalid_argument(name_ + " has no field '" + item.key() + "'");
      }
    }
  }

 private:
  template <class Use>
  void takeIf(const char* field, bool (Json::*is)() const noexcept, const char* allowed,
              const Use& use) {
    names_.push_back(field);
    const auto found = object_.find(field);
    if (found == object_.end()) return;
    if (!((*found).*is)()) refuse(field, *found, allowed);
    use(*found);
    ++taken_;
  }

  std::uint32_t toId(const Json& json, const char* field) const {
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() > 0xfffffffeu) {
      refuse(field, json, "ids from 0 to 4294967294");
    }
    return json.get<std::uint32_t>();
  }

  void requireSize(const Json& json, std::size_t size, const char* field) const {
    if (json.size() != size) refuse(field, json, (std::to_string(size) + " of them").c_str());
  }

  [[noreturn]] void refuse(const char* field, const Json& json, const char* allowed) const {
    constexpr std::size_t kLongest = 60;
    const std::string value = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    throw std::invalid_argument(name_ + "." + field + " is " + value.substr(0, kLongest) +
                                "; allowed: " + allowed);
  }

  const Json& object_;
  const std::string name_;
  std::vector<std::string> names_;
  std::size_t taken_ = 0;
};

void takeFields(Fields& fields, Particle& particle) {
  fields.take("position", particle.position);
  fields.take("angular_velocity", particle.angular_velocity);
  fields.take("pinned", particle.pinned);
}

template <class Spring>
void takeFields(Fields& fields, Spring& spring) {
  fields.take("particles", spring.particles);
  fields.take("at_rest", spring.at_rest);
}

template <class Item>
void takeItems(Fields& scene, const char* name, std::vector<Item>& items,
               std::vector<std::uint32_t>& ids) {
  const Json& list = scene.takeList(name);
  items.reserve(list.size());
  ids.reserve(list.size());
  for (const Json& object : list) {
    Fields fields(object, std::string(name) + "[" + std::to_string(items.size()) + "]");
    std::uint32_t id = ids.empty() ? 0 : ids.back() + 1;
    Item item;
    fields.take("id", id);
    takeFields(fields, item);
    Item::visitFields(
        item, [&](const char* field, double& value, const Range&) { fields.take(field, value); });
    fields.requireNothingLeft();
    ids.push_back(id);
    items.push_back(item);
  }
}

// --- writing ---

Json toJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

void writeFields(Json& object, const Particle& particle) {
  object["position"] = toJson(particle.position);
  object["angular_velocity"] = toJson(particle.angular_velocity);
  object["pinned"] = particle.pinned;
}

template <class Spring>
void writeFields(Json& object, const Spring& spring) {
  object["particles"] = spring.particles;
}

template <class Item>
void writeItems(std::ostream& out, const char* name, const IdTable<Item>& table) {
  out << ",\n\"" << name << "\": [";
  for (std::size_t i = 0; i < table.size(); ++i) {
    Json object;
    object["id"] = table.ids()[i];
    writeFields(object, table.item(i));
    Item::visitFields(table.item(i), [&](const char* field, double value, const Range&) {
      object[field] = value;
    });
    out << (i > 0 ? ",\n " : "\n ") << object.dump();
  }
  out << "\n]";
}

[[noreturn]] void failTo(const char* what, const fs::path& path) {
  throw std::runtime_error(std::string("cannot ") + what + " " + path.string() + ": " +
                           std::strerror(errno));
}

/// Puts the file's content on the disk before it gets its name.
void flushToDisk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) failTo("open", path);
  const bool done = ::fsync(file) == 0;
  ::close(file);
  if (!done) failTo("write", path);
}

}  // namespace

SceneFile readScene(const fs::path& path, SceneLimits limits) {
  if (!fs::is_regular_file(path)) {
    throw std::runtime_error("cannot read " + path.string() + ": not a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) failTo("read", path);
  try {
    const Json json = Json::parse(in);
    Fields fields(json, "the scene");
    std::string format;
    double time = 0;
    fields.take("format", format);
    fields.take("time", time);
    if (format != kFormat) {
      throw std::invalid_argument("format is '" + format + "'; allowed: " + kFormat);
    }
    requireInside(Range{0, kLargest, "0 to 1e30 [s]"}, time, "time");

    std::vector<Particle> particles;
    std::vector<std::uint32_t> particle_ids;
    takeItems(fields, "particles", particles, particle_ids);
    SpringLists springs;
    SpringIds spring_ids;
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      takeItems(fields, Spring::kTable, springs.get<Spring>(), spring_ids.get<Spring>());
    });
    fields.requireNothingLeft();
    return {Scene(limits, particle_ids, std::move(particles), spring_ids, std::move(springs)),
            time};
  } catch (const Json::exception& fault) {
    throw std::invalid_argument(path.string() + " is not a scene: " + fault.what());
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(path.string() + " is not a scene: " + fault.what());
  }
}

void writeScene(const fs::path& path, const Scene& scene, double time) {
  const fs::path beside = path.string() + ".part" + std::to_string(::getpid());
  try {
    std::ofstream out(beside, std::ios::binary | std::ios::trunc);
    if (!out) failTo("write", beside);
    out << "{\"format\": \"" << kFormat << "\",\n\"time\": " << Json(time).dump();
    writeItems(out, "particles", scene.particles());
    forEachKind([&](auto kind) {
      using Spring = typename decltype(kind)::type;
      writeItems(out, Spring::kTable, scene.springs<Spring>());
    });
    out << "}\n";
    out.close();
    if (!out) failTo("write", beside);
    flushToDisk(beside);
    fs::rename(beside, path);
  } catch (const std::exception& fault) {
    std::error_code ignored;
    fs::remove(beside, ignored);
    throw std::runtime_error(fault.what());
  }
}

}  // namespace spherical_springs::core
