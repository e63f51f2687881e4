#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "spherical_springs/sphere.h"

namespace spherical_springs::core {

using Json = nlohmann::json;

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
  /// Counts a field as taken.
  void pass(const std::string& field) {
    names_.push_back(field);
    ++taken_;
  }

  void requireNothingLeft() const {
    if (taken_ == object_.size()) return;
    for (const auto& item : object_.items()) {
      if (std::find(names_.begin(), names_.end(), item.key()) == names_.end()) {
        throw std::invalid_argument(name_ + " has no field '" + item.key() + "'");
      }
    }
  }

  static std::invalid_argument fault(const std::string& object, const std::string& field,
                                     const Json& json, const std::string& allowed) {
    constexpr std::size_t kLongest = 60;
    const std::string value = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return std::invalid_argument(object + "." + field + " is " + value.substr(0, kLongest) +
                                 "; allowed: " + allowed);
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
    throw fault(name_, field, json, allowed);
  }

  const Json& object_;
  const std::string name_;
  std::vector<std::string> names_;
  std::size_t taken_ = 0;
};

}  // namespace spherical_springs::core
