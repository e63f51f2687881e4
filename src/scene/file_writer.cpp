#include <array>

#include "base/files.h"
#include "scene/file_format.h"
#include "scene/text_writer.h"
#include "spherical_springs/scene_file.h"

namespace spherical_springs::core {
namespace {

/// One object on one line, its fields in the order in which they are written.
class ObjectWriter {
 public:
  explicit ObjectWriter(TextWriter& out) : out_(out) { out_ << "{"; }
  ~ObjectWriter() { out_ << "}"; }
  ObjectWriter(const ObjectWriter&) = delete;
  ObjectWriter& operator=(const ObjectWriter&) = delete;

  template <class Value>
  void write(const char* field, const Value& value) {
    begin(field);
    out_ << value;
  }
  template <class List>
  void writeList(const char* field, const List& values) {
    begin(field);
    const char* separator = "[";
    for (const auto& value : values) {
      out_ << separator << value;
      separator = ",";
    }
    out_ << "]";
  }

 private:
  void begin(const char* field) {
    out_ << (first_ ? "\"" : ",\"") << field << "\":";
    first_ = false;
  }

  TextWriter& out_;
  bool first_ = true;
};

std::array<double, 3> listOf(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

void writeFields(ObjectWriter& object, const Particle& particle) {
  object.writeList("position", listOf(particle.position));
  object.writeList("angular_velocity", listOf(particle.angular_velocity));
  object.write("pinned", particle.pinned);
}

template <class Spring>
void writeFields(ObjectWriter& object, const Spring& spring) {
  object.writeList("particles", spring.particles);
}

template <class Item>
void writeItems(TextWriter& out, const char* name, const IdTable<Item>& table) {
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
  TextWriter text(out);
  text << "{\"format\": \"" << kSceneFormat << "\",\n\"time\": " << time;
  writeItems(text, "particles", scene.particles());
  forEachKind([&](auto kind) {
    using Spring = typename decltype(kind)::type;
    writeItems(text, Spring::kTable, scene.springs<Spring>());
  });
  text << "}\n";
}

void writeScene(const std::filesystem::path& path, const Scene& scene, double time) {
  replaceFile(path, [&](std::ostream& out) { writeScene(out, scene, time); });
}

}  // namespace spherical_springs::core
