// source_list.h: many sources of reflectance from one text, and what they are made of.
#pragma once

#include <string>
#include <vector>

namespace pbnbrdf {

// "sgd:FILE#MATERIAL" or "FILE#MATERIAL" in its parts; of any other source, a file whose own name has a # too, all
// of it as `file`.
struct SourceParts {
  explicit SourceParts(const std::string& source);

  bool is_sgd;
  std::string file, material;  // material: "" if there is none
};

// The sources that a text stands for, parts between semicolons, each once, in order:
//
//   merl/*.binary       the files, by name; *, ? and [...] as the shell has them
//   sgd:FILE#*          the materials of the file; builtin:* those that come with the program
//   FILE#*              those of a file that holds several (collection_file.h)
//   anything else       itself
//
// Throws Error if a pattern stands for nothing.
std::vector<std::string> ExpandSources(const std::string& text);

// A name for what is made of a source: the file's without its ending, or the material's.
std::string NameOfSource(const std::string& source);

// The names of several: where two would be the same, the folder's name, "sgd" or "builtin" comes before them, as in
// "sgd-nylon". Throws Error if two are the same all the same.
std::vector<std::string> NamesOfSources(const std::vector<std::string>& sources);

// A number for the source and the content of its files (base/hash.h). Throws Error if one can't be read.
std::uint64_t SourceFingerprint(const std::string& source);

}  // namespace pbnbrdf
