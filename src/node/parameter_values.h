// Values of parameters as people write them: YAML takes `1e-3` for a text, and `1.0e6` for a real
// number where a whole one is wanted.
#pragma once

#include <ros/node_handle.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

namespace spherical_springs {

/// Returns the number that a text is, as a whole.
inline std::optional<double> numberIn(const std::string& text) {
  if (text.empty()) return {};
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) return {};
  return number;
}

/// Returns a parameter's value as the type `Value`; none where it is of another type.
template <class Value>
std::optional<Value> valueIn(const XmlRpc::XmlRpcValue& raw);

template <>
inline std::optional<double> valueIn(const XmlRpc::XmlRpcValue& raw) {
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeDouble) return static_cast<const double&>(raw);
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeInt) return static_cast<const int&>(raw);
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeString) {
    return numberIn(static_cast<const std::string&>(raw));
  }
  return {};
}

template <>
inline std::optional<int> valueIn(const XmlRpc::XmlRpcValue& raw) {
  const std::optional<double> number = valueIn<double>(raw);
  constexpr double kMost = std::numeric_limits<int>::max();
  if (!number || std::floor(*number) != *number || std::abs(*number) > kMost) return {};
  return static_cast<int>(*number);
}

template <>
inline std::optional<bool> valueIn(const XmlRpc::XmlRpcValue& raw) {
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<const bool&>(raw);
  if (raw.getType() != XmlRpc::XmlRpcValue::TypeString) return {};
  const std::string& text = raw;
  if (text == "true" || text == "True") return true;
  if (text == "false" || text == "False") return false;
  return {};
}

template <>
inline std::optional<std::string> valueIn(const XmlRpc::XmlRpcValue& raw) {
  if (raw.getType() != XmlRpc::XmlRpcValue::TypeString) return {};
  return static_cast<const std::string&>(raw);
}

/// Returns words for a value that `valueIn<Value>` does not take: how its type is wrong, or nothing
/// where that is right.
template <class Value>
std::string typeFault(const XmlRpc::XmlRpcValue& raw) {
  constexpr bool kWantsText = std::is_same_v<Value, std::string>;
  constexpr bool kWantsTruth = std::is_same_v<Value, bool>;
  std::string type = "a value of another type";
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeBoolean) type = "a truth value";
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeString) type = "a text";
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeArray) type = "a list";
  if (raw.getType() == XmlRpc::XmlRpcValue::TypeInt ||
      raw.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
    if (!kWantsText && !kWantsTruth) return "";
    type = "a number";
  }
  const std::string wanted = kWantsText    ? "a text is wanted (in YAML, quote it)"
                             : kWantsTruth ? "a truth value is wanted"
                                           : "a number is wanted";
  return ", " + type + " where " + wanted;
}

}  // namespace spherical_springs
