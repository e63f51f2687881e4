#include <nlohmann/json.hpp>

#include "../files.h"
#include "format.h"
#include "spherical_springs/scene_file.h"

namespace spherical_springs::core {
namespace {

using Json = nlohmann::json;

/// One object on one line, its fields in the order in which they are written.
class ObjectWriter {
 public:
  explicit ObjectWriter(std::ostream& out) : out_(out) { out_ << '{'; }
  ~ObjectWriter() { out_ << '}'; }
  ObjectWriter(const ObjectWriter&) = delete;
  ObjectWriter& operator=(const ObjectWriter&) = delete;

  void write(const char* field, const Json& value) {
    out_ << (first_ ? "\"" : ",\"") << field << "\":" << value.dump();
    first_ = false;
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

Json toJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

void writeFields(ObjectWriter& object, const Particle& particle) {
  object.write("position", toJson(particle.position));
  object.write("angular_velocity", toJson(particle.angular_velocity));
  object.write("pinned", particle.pinned);
}

template <class Spring>
void writeFields(ObjectWriter& object, const Spring& spring) {
  object.write("particles", spring.particles);
}

template <class Item>
void writeItems(std::ostream& out, const char* name, const IdTable<Item>& table) {
  out << ",\n\"" << name << "\": [";
  for (std::size_t i = 0; i < table.size(); ++i) {
    out << (i > 0 ? ",\n " : "\n ");
    ObjectWriter object(out);
    object.write("id", table.ids()[i]);
    writeFields(object, table.item(i));
    Item::visitFields(table.item(i), [&](const char* field, double value, const Range&) {
      object.write(field, value);
    });
  }
  out << "\n]";
}

}  // namespace

void writeScene(std::ostream& out, const Scene& scene, double time) {
  out << "{\"format\": \"" << kSceneFormat << "\",\n\"time\": " << Json(time).dump();
  writeItems(out, "particles", scene.particles());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    writeItems(out, Spring::kTable, scene.springs<Spring>());
  });
  out << "}\n";
}

void writeScene(const std::filesystem::path& path, const Scene& scene, double time) {
  replaceFile(path, [&](std::ostream& out) { writeScene(out, scene, time); });
}

}  // namespace spherical_springs::core
