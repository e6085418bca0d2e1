// protobuf.h: writing messages in protobuf's wire format [1], as much of it as ONNX files need.
//
// [1] https://protobuf.dev/programming-guides/encoding
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pbnbrdf {

// Builds a message; fields are in the order in which they are added.
class ProtobufMessage {
 public:
  // int32, int64, enum; not negative.
  void Add(int field, std::uint64_t value) {
    Key(field, 0);
    Varint(value);
  }

  // string, bytes.
  void Add(int field, std::string_view value) {
    Key(field, 2);
    Varint(value.size());
    bytes_ += value;
  }

  void Add(int field, const ProtobufMessage& message) { Add(field, message.bytes()); }

  std::string_view bytes() const { return bytes_; }

 private:
  void Key(int field, unsigned wire_type) {
    Varint(static_cast<std::uint64_t>(field) << 3 | wire_type);
  }

  // Seven bits to a byte, the lowest first; the eighth says that more follow.
  void Varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

}  // namespace pbnbrdf
