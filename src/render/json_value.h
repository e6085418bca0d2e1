// json_value.h: values of a JSON file, together with where they stand, so that errors can say it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pbnbrdf/base/error.h"
#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// The text parsed. Throws Error if it isn't JSON or a key is there twice in an object.
nlohmann::ordered_json ParseJson(const std::string& text);

class JsonValue {
 public:
  // json must outlive this.
  JsonValue(const nlohmann::ordered_json& json, std::string place)
      : json_(&json), place_(std::move(place)) {}

  // Throws Error "place: message".
  template <typename... Parts>
  [[noreturn]] void Refuse(const Parts&... parts) const {
    Fail(place_.empty() ? "" : place_ + ": ", parts...);
  }

  // All throw Error, with the place, if the value is another.
  std::string Text() const;
  double Number() const;
  double Positive() const;
  double NotNegative() const;
  int Whole(int least, int most) const;
  Vec3 Vector() const;     // three numbers
  Vec3 Direction() const;  // of any length but 0
  Rgb Color() const;       // a number >= 0, or three

  // Of an object.
  void CheckKeys(const std::vector<std::string>& known) const;  // that it has no others
  bool Has(const std::string& key) const { return json_->contains(key); }
  JsonValue At(const std::string& key) const;  // which it must have
  std::vector<std::pair<std::string, JsonValue>> Members() const;

  std::vector<JsonValue> Elements() const;  // of an array
  bool IsArray() const { return json_->is_array(); }

 private:
  double Finite(const nlohmann::ordered_json& json) const;
  void RequireObject() const;

  const nlohmann::ordered_json* json_;
  std::string place_;  // "shapes[2].radius"; "" at the top
};

}  // namespace pbnbrdf
