// json_value.h: a value of a JSON file that knows its place there, for error messages.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/fields.h"
#include "base/json.h"
#include "pbnbrdf/brdf/direction.h"

namespace pbnbrdf {

// Its message begins with a place in the file.
struct PlacedError : Error {
  using Error::Error;
};

class JsonValue {
 public:
  // Throws Error if the text is not JSON, or an object has a key twice.
  static JsonValue Parse(const std::string& text);

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
  bool Has(const std::string& key) const;
  JsonValue At(const std::string& key) const;  // refuses an object without the key
  std::vector<std::pair<std::string, JsonValue>> Members() const;

  // Of an array.
  bool IsArray() const;
  std::vector<JsonValue> Elements() const;

 private:
  JsonValue(std::shared_ptr<const Json> json, std::string place)
      : json_(std::move(json)), place_(std::move(place)) {}
  JsonValue Child(const Json& json, std::string place) const;
  void RequireObject() const;

  std::shared_ptr<const Json> json_;  // shares the whole file's
  std::string place_;                 // "shapes[2].radius"; "" at the top
};

}  // namespace pbnbrdf
