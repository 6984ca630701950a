// Stands for the engine of the page of merge trees in a build without it (TERRANE_WASM=OFF).
#include "viewer/server/viewer_files.h"

namespace terrane::viewer {

std::span<const ViewerFile> engine_files() { return {}; }

}  // namespace terrane::viewer
