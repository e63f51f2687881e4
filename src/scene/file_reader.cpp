#include <cmath>
#include <new>
#include <stdexcept>

#include "base/files.h"
#include "scene/checks.h"
#include "scene/counting_buffer.h"
#include "scene/fields.h"
#include "scene/file_format.h"
#include "scene/item_lists.h"
#include "spherical_springs/scene_file.h"

namespace spherical_springs::core {
namespace {

namespace fs = std::filesystem;

void requireFormat(const std::string& format) {
  if (format == kSceneFormat) return;
  throw std::invalid_argument("format is " + quoted(format) + "; allowed: " + kSceneFormat);
}

constexpr const char* kMore = "there is more after the end of the scene";

/// Where the text is no JSON.
struct TextFault : std::invalid_argument {
  TextFault(std::size_t byte, const std::string& reason)
      : std::invalid_argument("at byte " + std::to_string(byte) + ": " + reason) {}
};

/// Returns the end of the text read so far, with control characters replaced.
std::string lastOf(const std::string& read) {
  constexpr std::size_t kShown = 30;
  std::string last = read.size() > kShown ? read.substr(read.size() - kShown) : read;
  for (char& c : last) {
    if (c < ' ' || c > '~') c = '?';
  }
  return last;
}

/// Takes what a parser comes to, item by item: the memory holds the items, and never the whole
/// text.
class SceneEvents {
 public:
  SceneEvents(const CountingBuffer& source, ItemLists& lists) : source_(source), lists_(lists) {
    scene_.restart(kScene);
  }

  bool null() { return value(nullptr); }
  bool boolean(bool v) { return value(v); }
  bool number_integer(Json::number_integer_t v) { return value(v); }
  bool number_unsigned(Json::number_unsigned_t v) { return value(v); }
  bool number_float(Json::number_float_t v, const std::string&) { return value(v); }
  bool string(std::string& v) { return value(v); }
  template <class Binary>
  bool binary(Binary&) {
    return true;  // JSON has none
  }

  bool key(const std::string& name) {
    if (depth_ > kInScene) {
      item_.begin(name);
      return true;
    }
    field_ = name;
    scene_.begin(name);
    if (ItemLists::isList(name)) scene_.leaveToOthers();
    return true;
  }

  bool start_object(std::size_t) {
    if (depth_ == kInScene) {
      requireList();
      throw std::invalid_argument("the scene." + field_ + " is an object; allowed: a list");
    }
    if (depth_ > kInList) refuseNesting();
    if (depth_ == kInList) item_.restart(nameOfItem());
    ++depth_;
    return true;
  }

  bool end_object() {
    --depth_;
    closed_ = depth_ == kOutside;
    if (depth_ == kInList) lists_.take(field_, item_, source_.offset());
    return true;
  }

  bool start_array(std::size_t) {
    if (depth_ == kOutside) refuseOther();
    if (depth_ == kInScene) requireList();
    if (depth_ == kInList) refuseItem();
    if (depth_ == kInItem) item_.beginList();
    if (depth_ > kInItem) refuseNesting();
    ++depth_;
    return true;
  }

  bool end_array() {
    --depth_;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& read, const Json::exception& fault) {
    constexpr int kOverflow = 406;  // the library's number of it
    if (fault.id == kOverflow)
      throw TextFault(byte, "the number " + shortened(read) + " is too large");
    if (closed_) throw TextFault(byte, kMore);
    if (source_.hasEnded()) throw TextFault(byte, "the text ends before the scene does");
    throw TextFault(byte, "this is not JSON: " + quoted(lastOf(read)));
  }

  /// Returns the scene's time [s]; to be called once all lists have been read.
  double time() {
    std::string format;
    double time = 0;
    scene_.take("format", format);
    scene_.take("time", time);
    scene_.requireNothingLeft();
    requireFormat(format);
    // No number of steps changes a time this large, so that every scene that was saved is accepted.
    constexpr double kLatest = 1e300;
    requireInside(Range{0, kLatest, "0 to 1e300 [s]"}, time, "time");
    return time;
  }

 private:
  static constexpr const char* kScene = "the scene";
  enum Depth { kOutside, kInScene, kInList, kInItem };  // and in a list of an item

  bool value(Json v) {
    if (depth_ == kOutside) refuseOther();
    if (depth_ == kInList) refuseItem();
    if (depth_ >= kInItem) {
      item_.add(std::move(v));
      return true;
    }
    if (ItemLists::isList(field_)) throw Fields::fault(kScene, field_, v, "a list");
    if (field_ == "format" && v.is_string()) requireFormat(v.get<std::string>());
    scene_.add(std::move(v));
    return true;
  }

  std::string nameOfItem() const {
    return field_ + "[" + std::to_string(lists_.size(field_)) + "]";
  }

  void requireList() const {
    if (ItemLists::isList(field_)) return;
    throw std::invalid_argument("the scene has no field " + quoted(field_) + " that holds others");
  }
  [[noreturn]] void refuseItem() const {
    throw std::invalid_argument(nameOfItem() + " is not an object");
  }
  [[noreturn]] static void refuseOther() {
    throw std::invalid_argument("the scene is not an object");
  }
  [[noreturn]] void refuseNesting() const {
    throw std::invalid_argument(nameOfItem() + "." + item_.nameOfPresent() +
                                " has a list or an object inside; allowed: values");
  }

  const CountingBuffer& source_;
  ItemLists& lists_;
  int depth_ = kOutside;
  bool closed_ = false;
  std::string field_;  // of the scene, which is being read
  Fields scene_, item_;
};

SceneFile read(std::istream& in, const SceneLimits& limits) {
  const auto before = [](std::size_t offset) {
    return "before byte " + std::to_string(offset) + ": ";
  };
  CountingBuffer source(in);
  std::istream counted(&source);
  ItemLists lists(limits);
  bool finished = false;
  try {
    SceneEvents events(source, lists);
    Json::sax_parse(counted, &events);
    // The parser takes a byte that is 0 for the end of the text.
    if (!source.hasEnded()) throw TextFault(source.offset(), kMore);
    const double time = events.time();
    finished = true;
    return {lists.scene(), time};
  } catch (const TextFault&) {
    throw;
  } catch (const ItemFault& fault) {
    throw std::invalid_argument(before(lists.endOf(fault.list, fault.index)) + fault.what());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& fault) {
    if (finished) throw;
    throw std::invalid_argument(before(source.offset()) + fault.what());
  }
}

}  // namespace

SceneFile readScene(const fs::path& path, SceneLimits limits) {
  std::ifstream in = openToRead(path);
  try {
    return readScene(in, limits);
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(onOneLine(path) + " is not a scene: " + fault.what());
  }
}

SceneFile readScene(std::istream& in, SceneLimits limits) { return read(in, limits); }

}  // namespace spherical_springs::core
