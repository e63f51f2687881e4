#include <cmath>
#include <new>
#include <set>
#include <stdexcept>

#include "../files.h"
#include "../scene_checks.h"
#include "fields.h"
#include "format.h"
#include "item_lists.h"
#include "spherical_springs/scene_file.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;
using Event = Json::parse_event_t;

void requireFormat(const std::string& format) {
  if (format == kSceneFormat) return;
  throw std::invalid_argument("format is '" + format + "'; allowed: " + kSceneFormat);
}

/// Reads item by item: the memory holds the items, and never the whole text.
class SceneReader {
 public:
  SceneReader(std::istream& in, const SceneLimits& limits) : in_(in), lists_(limits) {}

  SceneFile read() {
    try {
      const Json rest = Json::parse(
          in_, [this](int depth, Event event, Json& value) { return keep(depth, event, value); });
      const double time = timeOf(rest);
      finished_ = true;
      return {lists_.scene(), time};
    } catch (const Json::parse_error& fault) {
      throw std::invalid_argument("at byte " + std::to_string(fault.byte) + ": " + fault.what());
    } catch (const ItemFault& fault) {
      throw std::invalid_argument(before(lists_.endOf(fault.list, fault.index)) + fault.what());
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& fault) {
      if (finished_) throw;
      throw std::invalid_argument(before(offset()) + fault.what());
    }
  }

 private:
  /// Of what the parser has come to, whether it shall keep it: items are taken and let go.
  bool keep(int depth, Event event, const Json& value) {
    if (event == Event::object_end || event == Event::array_end) {
      if (depth == 1) list_.clear();
      if (depth != 2) return true;
      lists_.take(list_, value, offset());
      return false;
    }
    if (depth == 0 && event != Event::object_start) {
      throw std::invalid_argument("the scene is not an object");
    }
    if (depth == 1) enter(event, value);
    if (depth == 2 && event != Event::key && event != Event::object_start) {
      throw std::invalid_argument(list_ + "[" + std::to_string(lists_.size(list_)) +
                                  "] is not an object");
    }
    if (depth >= 4 && event != Event::value) {
      throw std::invalid_argument("lists in lists, or objects, where values should be");
    }
    return true;
  }

  /// What stands in the scene itself: the name of a field, then what the field is.
  void enter(Event event, const Json& value) {
    if (event == Event::key) {
      field_ = value.get<std::string>();
      if (!seen_.insert(field_).second) {
        throw std::invalid_argument("the scene has two fields '" + field_ + "'");
      }
      return;
    }
    const bool is_list = ItemLists::isList(field_);
    if (event == Event::value) {
      if (is_list) throw Fields::fault("the scene", field_, value, "a list");
      if (field_ == "format" && value.is_string()) requireFormat(value.get<std::string>());
      return;
    }
    if (!is_list) {
      throw std::invalid_argument("the scene has no field '" + field_ + "' that holds others");
    }
    if (event != Event::array_start) {
      throw std::invalid_argument("the scene." + field_ + " is an object; allowed: a list");
    }
    list_ = field_;
  }

  double timeOf(const Json& rest) const {
    Fields fields(rest, "the scene");
    std::string format;
    double time = 0;
    fields.take("format", format);
    fields.take("time", time);
    for (const auto& item : rest.items()) {
      if (ItemLists::isList(item.key())) fields.pass(item.key());
    }
    fields.requireNothingLeft();
    requireFormat(format);
    requireInside(Range{0, kLargest, "0 to 1e30 [s]"}, time, "time");
    return time;
  }

  std::size_t offset() const { return in_.rdbuf()->pubseekoff(0, std::ios::cur, std::ios::in); }
  static std::string before(std::size_t offset) {
    return "before byte " + std::to_string(offset) + ": ";
  }

  std::istream& in_;
  ItemLists lists_;
  std::set<std::string> seen_;
  std::string field_;  // of the scene, which is being read
  std::string list_;   // likewise, where it is a list
  bool finished_ = false;
};

}  // namespace

SceneFile readScene(const fs::path& path, SceneLimits limits) {
  std::ifstream in = openToRead(path);
  try {
    return readScene(in, limits);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(path.string() + " is not a scene: " + fault.what());
  }
}

SceneFile readScene(std::istream& in, SceneLimits limits) { return SceneReader(in, limits).read(); }

}  // namespace spherical_springs::core
