// export.h: a fitted network as a file for something else: a renderer, a compiler, a runtime.
#pragma once

#include <string>
#include <vector>

#include "pbnbrdf/base/files.h"
#include "pbnbrdf/base/names.h"
#include "pbnbrdf/network/neural_brdf.h"

namespace pbnbrdf {

enum class ExportFormat {
  kNpy,      // six NumPy files, as NBRDF's Mitsuba plugin reads them (nbrdf_files.h)
  kH5,       // a Keras file, as NBRDF's are (nbrdf_files.h)
  kMerl,     // a table in the format of the MERL database (merl.h)
  kCsv,      // a table of angles and values
  kC,        // a C99 header
  kGlsl,     // a function for GLSL ES 3.00
  kMitsuba,  // a BSDF for Mitsuba 3
  kOnnx,     // an ONNX model
};

inline constexpr NameTable<ExportFormat, 8> kExportFormats = {{{"npy", ExportFormat::kNpy},
                                                               {"h5", ExportFormat::kH5},
                                                               {"merl", ExportFormat::kMerl},
                                                               {"csv", ExportFormat::kCsv},
                                                               {"c", ExportFormat::kC},
                                                               {"glsl", ExportFormat::kGlsl},
                                                               {"mitsuba", ExportFormat::kMitsuba},
                                                               {"onnx", ExportFormat::kOnnx}}};

// The file, or files, of which `path` names the main one: NumPy's are ...fc1.npy and five beside
// it, the plugin for Mitsuba ....py and its weights, ..._weights.safetensors. name: how the
// functions of source code are called; empty: as the file is, up to its first dot, with characters
// that an identifier can't have replaced by '_'. Throws Error if the format can't hold this
// network, or if a name isn't what the format needs. The same network gives the same bytes.
std::vector<FileContent> ExportedFiles(const NeuralBrdf& network, ExportFormat format,
                                       const std::string& path, const std::string& name = "");

// Writes them: whole, or not at all. Throws Error, also if a file can't be written.
void Export(const NeuralBrdf& network, ExportFormat format, const std::string& path,
            const std::string& name = "");

}  // namespace pbnbrdf
