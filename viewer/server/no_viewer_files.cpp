// Stands for the embedded viewer in a build without it (TERRANE_WEB=OFF).
#include "viewer/server/viewer_files.h"

namespace terrane::viewer {

std::span<const ViewerFile> viewer_files() { return {}; }
std::span<const ViewerFile> volume_page_files() { return {}; }
std::span<const ViewerFile> tree_page_files() { return {}; }

}  // namespace terrane::viewer
