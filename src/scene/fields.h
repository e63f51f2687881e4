#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "spherical_springs/id_table.h"
#include "spherical_springs/range.h"
#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

using Json = nlohmann::json;

/// The fields of one object as they come, each given and taken once; what is left at the end has no
/// meaning.
class Fields {
 public:
  /// Begins an object; memory of the one before is used again.
  void restart(const std::string& name) {
    name_ = name;
    count_ = 0;
  }

  /// Begins a field. @throw std::invalid_argument for one of a name that another has, and for one
  /// of so many that some must be without meaning: each is compared with all others.
  void begin(const std::string& name) {
    constexpr std::size_t kMost = 32;
    if (find(name) != nullptr) {
      throw std::invalid_argument(name_ + " has two fields " + quoted(name));
    }
    if (count_ == kMost) {
      throw std::invalid_argument(name_ + " has more than " + std::to_string(kMost) + " fields");
    }
    if (++count_ > fields_.size()) fields_.emplace_back();
    present_ = &fields_[count_ - 1];
    present_->name = name;
    present_->is_list = present_->taken = false;
  }
  /// Whoever takes the parts of the field that was begun, it is not left at the end.
  void leaveToOthers() { present_->taken = true; }
  const std::string& nameOfPresent() const { return present_->name; }
  void beginList() {
    present_->is_list = true;
    present_->list.clear();
  }
  /// To the field that was begun, or to its list.
  void add(Json value) {
    if (present_->is_list) {
      present_->list.push_back(std::move(value));
    } else {
      present_->value = std::move(value);
    }
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
    takeIf(field, &Json::is_number, kIds, [&](const Json& j) { value = toId(j, field); });
  }
  void take(const char* field, Vector3& value) {
    takeList(field, 3, "three numbers", [&](const std::vector<Json>& list) {
      for (int i = 0; i < 3; ++i) {
        if (!list[i].is_number()) refuse(field, list, "three numbers");
        value[i] = list[i].get<double>();
      }
    });
  }
  template <std::size_t N>
  void take(const char* field, std::array<std::uint32_t, N>& value) {
    takeList(field, N, kIds, [&](const std::vector<Json>& list) {
      for (std::size_t i = 0; i < N; ++i) {
        value[i] = toId(list[i], field + ("[" + std::to_string(i) + "]"));
      }
    });
  }

  void requireNothingLeft() const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (!fields_[i].taken) {
        throw std::invalid_argument(name_ + " has no field " + quoted(fields_[i].name));
      }
    }
  }

  static std::invalid_argument fault(const std::string& object, const std::string& field,
                                     const Json& json, const std::string& allowed) {
    const std::string value = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return std::invalid_argument(object + "." + field + " is " + shortened(value) +
                                 "; allowed: " + allowed);
  }

 private:
  static constexpr const char* kIds = "whole numbers from 0 to 4294967294";

  struct Field {
    std::string name;
    Json value;
    std::vector<Json> list;
    bool is_list = false, taken = false;

    Json json() const { return is_list ? Json(list) : value; }
  };

  template <class Use>
  void takeIf(const char* name, bool (Json::*is)() const noexcept, const char* allowed,
              const Use& use) {
    Field* const field = find(name);
    if (field == nullptr) return;
    if (field->is_list || !(field->value.*is)()) refuse(name, field->json(), allowed);
    use(field->value);
    field->taken = true;
  }

  template <class Use>
  void takeList(const char* name, std::size_t size, const char* allowed, const Use& use) {
    Field* const field = find(name);
    if (field == nullptr) return;
    if (!field->is_list) refuse(name, field->value, allowed);
    if (field->list.size() != size) {
      refuse(name, field->json(), ("a list of " + std::to_string(size)).c_str());
    }
    use(field->list);
    field->taken = true;
  }

  Field* find(std::string_view name) {
    const auto end = fields_.begin() + static_cast<std::ptrdiff_t>(count_);
    const auto found =
        std::find_if(fields_.begin(), end, [&](const Field& f) { return f.name == name; });
    return found == end ? nullptr : &*found;
  }

  std::uint32_t toId(const Json& json, const std::string& field) const {
    const double id = json.is_number() ? json.get<double>() : -1;
    if (id < 0 || id > kLargestId || id != std::floor(id)) refuse(field, json, kIds);
    return static_cast<std::uint32_t>(id);
  }

  [[noreturn]] void refuse(const std::string& field, const Json& json, const char* allowed) const {
    throw fault(name_, field, json, allowed);
  }

  std::string name_;
  std::vector<Field> fields_;  // the first `count_` are those of this object
  std::size_t count_ = 0;
  Field* present_ = nullptr;
};

}  // namespace spherical_springs::core
