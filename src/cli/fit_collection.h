// fit_collection.h: `fit` for many materials: a folder of networks, finished fits kept, and a table of all.
#pragma once

#include "fit_material.h"

namespace pbnbrdf::cli {

enum class ProgressStyle { kTerminal, kJson };

inline constexpr NameTable<ProgressStyle, 2> kProgressStyles = {
    {{"terminal", ProgressStyle::kTerminal}, {"json", ProgressStyle::kJson}}};

struct CollectionOptions {
  std::string out_dir;
  std::string only;  // names of materials, between semicolons; "": all
  int jobs = 0;      // fits at a time; 0: one for each core
  ProgressStyle progress = ProgressStyle::kTerminal;
  bool quiet = false;
  std::function<void()> when_done = {};  // all fits that can be made are, and the table is written
};

// Fits each of the sources that request.material.source stands for (sources/source_list.h), and writes
//
//   OUT_DIR/NAME.safetensors, OUT_DIR/NAME.json     network and summary, as for one material
//   OUT_DIR/fits.csv, OUT_DIR/fits.json             a table of all: state, measures, why a fit failed
//
// Fits that the folder has are kept if material, problem and version are the same. A material that fails is
// recorded, and the others go on. Whenever the program is killed, the same call goes on where it was. Returns the
// exit status: 1 if a material failed or Ctrl-C ended it early. With options.only several processes, also of several
// machines, fill one folder, and none writes the table: a call without it does, once they are done.
int FitCollection(const FitRequest& request, const CollectionOptions& options);

// The names of the materials of the collection, in order.
std::vector<std::string> CollectionNames(const std::string& source);

}  // namespace pbnbrdf::cli
