// hash.h: a number that tells contents apart.
#pragma once

#include <cstdint>
#include <string_view>

namespace pbnbrdf {

// FNV-1a (Fowler, Noll, Vo 1991) of 64 bits: against accidents, not against intent.
class Fingerprint {
 public:
  // What is added in several parts gives what all of it gives at once.
  void Add(std::string_view bytes) {
    for (const char byte : bytes)
      value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  }

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace pbnbrdf
