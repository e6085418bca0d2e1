#include "sources/hdf5_texts.h"

#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace pbnbrdf {
namespace {

// Sections IV.A.2.b, d and m, and III.E of the HDF5 File Format Specification, version 2.0.
constexpr std::size_t kAttributeHeader = 8, kVectorSize = 16, kHeapHeader = 16, kObjectHeader = 16;
constexpr unsigned kStringClass = 3, kVariableClass = 9;
constexpr std::uint64_t kMaxTexts = 4096;

// All that reads beyond the bytes throws std::out_of_range.
template <typename Integer>
Integer Load(std::string_view bytes, std::uint64_t at) {
  Integer value;
  if (bytes.size() < sizeof(value) || at > bytes.size() - sizeof(value)) {
    throw std::out_of_range("HDF5");
  }
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

std::string Text(std::string_view bytes, std::uint64_t at, std::uint64_t size) {
  const std::string_view text = bytes.substr(at, size);
  if (text.size() != size) throw std::out_of_range("HDF5");
  return std::string(text.substr(0, text.find('\0')));
}

std::uint64_t Padded(std::uint64_t size) { return (size + 7) / 8 * 8; }

// The text that a vector's length, its collection's address and its index there stand for.
std::string TextOfHeap(std::string_view bytes, std::uint64_t vector) {
  const auto length = Load<std::uint32_t>(bytes, vector);
  const auto heap = Load<std::uint64_t>(bytes, vector + 4);
  const auto wanted = Load<std::uint32_t>(bytes, vector + 12);
  if (Load<std::uint32_t>(bytes, heap) != Load<std::uint32_t>("GCOL", 0)) {
    throw std::out_of_range("HDF5");
  }
  std::uint64_t at = heap + kHeapHeader;
  while (Load<std::uint16_t>(bytes, at) != wanted) {
    const auto size = Load<std::uint64_t>(bytes, at + 8);
    if (Load<std::uint16_t>(bytes, at) == 0 || size > bytes.size()) {
      throw std::out_of_range("HDF5");
    }
    at += kObjectHeader + Padded(size);
  }
  return Text(bytes, at + kObjectHeader, length);
}

// The number of elements of a list, from its dataspace message.
std::uint64_t CountOf(std::string_view bytes, std::uint64_t space) {
  const auto version = Load<std::uint8_t>(bytes, space),
             rank = Load<std::uint8_t>(bytes, space + 1);
  if (rank != 1 || version < 1 || version > 2) return 0;
  return Load<std::uint64_t>(bytes, space + (version == 1 ? 8 : 4));
}

// Of the attribute message whose name is at `name_at`.
std::vector<std::string> ParseAttribute(std::string_view bytes, std::uint64_t name_at) {
  const std::uint64_t begin = name_at - kAttributeHeader;
  const std::uint64_t type = name_at + Padded(Load<std::uint16_t>(bytes, begin + 2));
  const std::uint64_t space = type + Padded(Load<std::uint16_t>(bytes, begin + 4));
  std::uint64_t at = space + Padded(Load<std::uint16_t>(bytes, begin + 6));
  const unsigned type_class = Load<std::uint8_t>(bytes, type) & 15u;
  const bool fixed = type_class == kStringClass;
  const std::uint64_t size = Load<std::uint32_t>(bytes, type + 4), count = CountOf(bytes, space);
  if (!fixed && (type_class != kVariableClass || size != kVectorSize)) return {};
  if (count > kMaxTexts) return {};
  std::vector<std::string> texts;
  for (std::uint64_t k = 0; k < count; ++k, at += size) {
    texts.push_back(fixed ? Text(bytes, at, size) : TextOfHeap(bytes, at));
  }
  return texts;
}

}  // namespace

std::vector<std::string> TextsOfAttribute(std::string_view bytes, std::string_view name) {
  // Its header: version 1, a reserved byte, and the name's size with its NUL.
  std::string start = {1, 0, static_cast<char>(name.size() + 1), 0};
  const std::string named = std::string(name) + '\0';
  std::uint64_t found = 0;
  for (std::size_t at = bytes.find(named); at != bytes.npos; at = bytes.find(named, at + 1)) {
    if (at < kAttributeHeader || bytes.substr(at - kAttributeHeader, start.size()) != start)
      continue;
    if (found != 0) return {};
    found = at;
  }
  try {
    return found == 0 ? std::vector<std::string>() : ParseAttribute(bytes, found);
  } catch (const std::out_of_range&) {
    return {};
  }
}

}  // namespace pbnbrdf
