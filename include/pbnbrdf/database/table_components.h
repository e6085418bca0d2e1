// table_components.h: the principal components of a database.
#pragma once

#include <span>

#include "pbnbrdf/database/database_material.h"
#include "pbnbrdf/sources/table_pca.h"

namespace pbnbrdf {

// Each channel of each material, tabulated as a MERL table, is an observation; bins at which a material isn't
// known count as the median. components: 1 to 3 M - 1, at most TablePca::kMaxComponents. Takes 14 MB of memory a
// material. Throws Error if a material is anisotropic.
TablePca PrincipalComponents(std::span<const DatabaseMaterial> materials, int components);

}  // namespace pbnbrdf
