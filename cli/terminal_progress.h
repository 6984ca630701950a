#pragma once

#include <memory>

#include "core/progress.h"

namespace terrane::cli {

/// Progress on standard error: a bar with rate and time left on a terminal, a plain line for each
/// stage otherwise, nothing at all if quiet.
std::unique_ptr<Progress> make_progress(bool quiet);

}  // namespace terrane::cli
