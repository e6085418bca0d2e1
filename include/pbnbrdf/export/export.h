// export.h: a fitted network, or a table of any source, as a file for something else: a renderer, a compiler, a
// runtime.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pbnbrdf/base/files.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

// What a format holds.
enum class ExportSource {
  kNetwork,      // a NeuralBrdf
  kHalfNetwork,  // a NeuralBrdf with weights of half precision (solve/half_weights.h)
  kAny,          // a table of any source
  kPrincipled,   // an AnalyticBrdf of the principled model
};

// One of the formats, by its name.
struct ExportFormat {
  std::string_view name;
  std::string_view help;  // what is written
  ExportSource source;
  std::vector<FileContent> (*files)(const Brdf& source, const std::string& path,
                                    const std::string& identifier);
};

std::span<const ExportFormat> ExportFormats();

// The file, or files, of which `path` names the main one: NumPy's are ...fc1.npy and five beside it, the plugin
// for Mitsuba ....py and what it reads, ..._weights.safetensors and ..._proposal.safetensors. name: how functions of
// source code, or materials, are called; empty: as the file is, up to its first dot, with characters that an
// identifier can't have replaced by '_'. Throws Error if the format can't hold this source, if a name isn't what the
// format needs, or if there is no such format. The same source gives the same bytes.
std::vector<FileContent> ExportedFiles(const Brdf& source, std::string_view format,
                                       const std::string& path, const std::string& name = "");

// Writes them: whole, or not at all. Throws Error, also if a file can't be written.
void Export(const Brdf& source, std::string_view format, const std::string& path,
            const std::string& name = "");

}  // namespace pbnbrdf
