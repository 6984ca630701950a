#pragma once

#include <string>
#include <vector>

#include "tiler/verify/output.h"
#include "tiler/verify/report.h"
#include "tiler/verify/valid_domain.h"
#include "tiler/verify/world.h"

namespace terrane::verify {

/// Checks what tileset.json says against itself, the DEM's terrain and the files on disk: which
/// tiles exist, their tree, errors and boxes, and the root's transform. Counts go into \p report.
///
/// \returns a line per problem.
std::vector<std::string> check_listing(const Output& output, const World& world,
                                       const ValidDomain& domain, VerifyReport& report);

}  // namespace terrane::verify
