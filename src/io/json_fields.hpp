#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "relative_map/io/whole_file.hpp"

// Reading values out of JSON objects: what is wrong is a sentence that says where.
namespace relative_map::core::json_fields {

using Json = nlohmann::json;

[[noreturn]] inline void fail(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + " " + what);
}

/// The file as a JSON object.
inline Json read_object(const std::string& path) {
  Json value;
  try {
    value = Json::parse(read_whole_file(path));
  } catch (const Json::parse_error& error) {
    fail(path + ":", "not valid JSON near byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {
    fail(path + ":", "not valid JSON: a number is out of range");
  }
  if (!value.is_object()) fail(path + ":", "must be a JSON object");
  return value;
}

inline double number(const Json& value, const std::string& where) {
  if (!value.is_number()) fail(where, "must be a number");
  return value.get<double>();
}

inline std::string text(const Json& value, const std::string& where) {
  if (!value.is_string()) fail(where, "must be a text");
  return value.get<std::string>();
}

/// A key that may be missing or null.
inline const Json* optional(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

inline const Json& required(const Json& object, const char* key, const std::string& where) {
  const Json* value = optional(object, key);
  if (value == nullptr) fail(where, std::string("lacks '") + key + "'");
  return *value;
}

inline double number_or(const Json& object, const char* key, double otherwise, const std::string& where) {
  const Json* value = optional(object, key);
  return value == nullptr ? otherwise : number(*value, where + " '" + key + "'");
}

inline std::string text_or(const Json& object, const char* key, const std::string& otherwise,
                           const std::string& where) {
  const Json* value = optional(object, key);
  return value == nullptr ? otherwise : text(*value, where + " '" + key + "'");
}

/// The elements of a list; none where the key is missing.
inline const Json& list_or_none(const Json& object, const char* key, const std::string& where) {
  static const Json kNone = Json::array();
  const Json* value = optional(object, key);
  if (value == nullptr) return kNone;
  if (!value->is_array()) fail(where, std::string("'") + key + "' must be a list");
  return *value;
}

inline const Json& list(const Json& object, const char* key, const std::string& where) {
  required(object, key, where);
  return list_or_none(object, key, where);
}

/// An element that is itself a list of two.
inline const Json& pair(const Json& value, const std::string& where) {
  if (!value.is_array() || value.size() != 2) fail(where, "must be a list of pairs");
  return value;
}

inline std::vector<std::string> texts(const Json& object, const char* key, const std::string& where) {
  std::vector<std::string> result;
  for (const Json& value : list_or_none(object, key, where)) {
    result.push_back(text(value, where + " '" + key + "'"));
  }
  return result;
}

}  // namespace relative_map::core::json_fields
