#include "json_value.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/text.h"
#include "pbnbrdf/render/affine.h"

namespace pbnbrdf {
namespace {

constexpr int kMaxDepth = 64;          // scenes need 6; the parser's stack holds thousands
constexpr std::size_t kMaxQuote = 60;  // characters of a value in a message of one line
// Leaves room below the largest float, 3e38, for scales and for sums over lights.
constexpr double kMaxColor = 1e30;

std::string Quoted(const Json& json) {
  const std::string text = JsonLine(json);
  return text.size() > kMaxQuote ? text.substr(0, kMaxQuote) + "..." : text;
}

}  // namespace

JsonValue JsonValue::Parse(const std::string& text) {
  using Event = Json::parse_event_t;
  std::vector<std::set<std::string>> keys;  // of the objects around the current place
  const auto watch = [&](int depth, Event event, Json& parsed) {
    if (depth > kMaxDepth) Fail("not a scene: nested more than ", kMaxDepth, " deep");
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key && !keys.back().insert(parsed.get<std::string>()).second) {
      Fail("key ", Quoted(parsed), " is given twice");
    }
    return true;
  };
  try {
    return {std::make_shared<const Json>(Json::parse(text, watch)), ""};
  } catch (const Json::exception& error) {
    const std::string message = error.what();  // "[json.exception.NAME.NUMBER] WHAT"
    const std::size_t end = message.find("] ");
    Fail("not JSON: ", end == std::string::npos ? message : message.substr(end + 2));
  }
}

std::string JsonValue::Text() const {
  if (!json_->is_string()) Refuse("expected a text, found ", Quoted(*json_));
  return json_->get<std::string>();
}

double JsonValue::Number(const Range& range) const {
  if (!json_->is_number()) Refuse("expected a number, found ", Quoted(*json_));
  const double value = json_->get<double>();
  if (!std::isfinite(value)) Refuse("must be finite");
  if (!range.Holds(value)) Refuse("is ", value, "; must be ", range.Text());
  return value;
}

int JsonValue::Whole(int min, int max) const {
  const double value = Number();
  if (!(value >= min && value <= max && value == std::floor(value))) {
    Refuse("is ", value, "; must be a whole number from ", min, " to ", max);
  }
  return static_cast<int>(value);
}

Vec3 JsonValue::Vector() const {
  if (!json_->is_array() || json_->size() != 3) {
    Refuse("expected three numbers, found ", Quoted(*json_));
  }
  const std::vector<JsonValue> v = Elements();
  return {v[0].Number(), v[1].Number(), v[2].Number()};
}

Vec3 JsonValue::Direction() const {
  const Vec3 v = Vector();
  const double length = Length(v);
  if (!(length > 0.0) || !std::isfinite(length)) Refuse("must have a length that isn't 0");
  return Normalized(v);
}

Rgb JsonValue::Color() const {
  const bool grey = json_->is_number();
  const Vec3 v = grey ? Vec3{Number(), Number(), Number()} : Vector();
  const Rgb color = {v.x, v.y, v.z};
  for (double channel : color) {
    if (!(channel >= 0.0)) Refuse("has a channel of ", channel, "; must be >= 0");
    if (channel > kMaxColor) Refuse("has a channel of ", channel, "; must be <= ", kMaxColor);
  }
  return color;
}

JsonValue JsonValue::Child(const Json& json, std::string place) const {
  return {std::shared_ptr<const Json>(json_, &json), std::move(place)};
}

bool JsonValue::Has(const std::string& key) const { return json_->contains(key); }

bool JsonValue::IsArray() const { return json_->is_array(); }

void JsonValue::RequireObject() const {
  if (!json_->is_object()) Refuse("expected an object, {...}");
}

void JsonValue::CheckKeys(const std::vector<std::string>& known) const {
  for (const auto& [key, value] : Members()) {
    if (std::count(known.begin(), known.end(), key) > 0) continue;
    Refuse("key ", Quoted(key), " isn't known; did you mean \"", Nearest(known, key), "\"?");
  }
}

JsonValue JsonValue::At(const std::string& key) const {
  RequireObject();
  const auto found = json_->find(key);
  if (found == json_->end()) Refuse("has no \"", key, "\"");
  return Child(*found, place_.empty() ? key : place_ + "." + key);
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::Members() const {
  RequireObject();
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& item : json_->items()) members.emplace_back(item.key(), At(item.key()));
  return members;
}

std::vector<JsonValue> JsonValue::Elements() const {
  if (!json_->is_array()) Refuse("expected a list, [...]");
  std::vector<JsonValue> elements;
  for (std::size_t i = 0; i < json_->size(); ++i) {
    elements.push_back(Child((*json_)[i], StrCat(place_, "[", i, "]")));
  }
  return elements;
}

}  // namespace pbnbrdf
