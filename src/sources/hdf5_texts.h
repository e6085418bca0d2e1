// hdf5_texts.h: a list of texts that is an attribute, from the bytes of an HDF5 file: HDF5 1.10 itself reads beyond
// its memory where an attribute is damaged.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pbnbrdf {

// The only attribute of that name, if it is a list of texts, of a fixed or a variable length, in the layout of
// files with addresses of 8 bytes that HDF5 writes by default (attribute messages of version 1). Else none.
std::vector<std::string> TextsOfAttribute(std::string_view bytes, std::string_view name);

}  // namespace pbnbrdf
