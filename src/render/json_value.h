// json_value.h: a value of a JSON file that knows its place there, for error messages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/fields.h"
#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// Throws Error if the text is not JSON, or an object has a key twice.
nlohmann::ordered_json ParseJson(const std::string& text);

// Its message begins with a place in the file.
struct PlacedError : Error {
  using Error::Error;
};

class JsonValue {
 public:
  // json must outlive this.
  JsonValue(const nlohmann::ordered_json& json, std::string place)
      : json_(&json), place_(std::move(place)) {}

  // Throws PlacedError "place: message".
  template <typename... Parts>
  [[noreturn]] void Refuse(const Parts&... parts) const {
    throw PlacedError(StrCat(place_.empty() ? "" : place_ + ": ", parts...));
  }

  // Calls the function, and refuses the value with the message of any other Error.
  template <typename Function>
  auto Check(Function function) const {
    try {
      return function();
    } catch (const PlacedError&) {
      throw;
    } catch (const Error& error) {
      Refuse(error.what());
    }
  }

  // Each refuses a value of another type or out of its range.
  std::string Text() const;
  double Number(const Range& range = Any()) const;
  int Whole(int min, int max) const;
  Vec3 Vector() const;     // three numbers
  Vec3 Direction() const;  // three numbers, not all 0, normalized
  Rgb Color() const;       // a number >= 0, or three

  // Of an object.
  void CheckKeys(const std::vector<std::string>& known) const;  // refuses all others
  bool Has(const std::string& key) const { return json_->contains(key); }
  JsonValue At(const std::string& key) const;  // refuses an object without the key
  std::vector<std::pair<std::string, JsonValue>> Members() const;

  // Of an array.
  bool IsArray() const { return json_->is_array(); }
  std::vector<JsonValue> Elements() const;

 private:
  void RequireObject() const;

  const nlohmann::ordered_json* json_;
  std::string place_;  // "shapes[2].radius"; "" at the top
};

}  // namespace pbnbrdf
