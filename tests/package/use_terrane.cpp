// Tiles a synthetic DEM and judges the result, with the installed libraries alone.
#include <cstdio>
#include <filesystem>

#include "core/errors.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "ingest/dem.h"
#include "ingest/scan.h"
#include "tiler/build.h"
#include "tiler/files/output_folder.h"
#include "tiler/verify/verify.h"
#include "viewer/server/serve.h"
#include "viewer/server/viewer_files.h"

namespace fs = std::filesystem;

bool tile_and_verify(const fs::path& out) {
  terrane::NoProgress quiet;
  const auto dem = terrane::ingest::open_dem({"synthetic:caldera?size=129&seed=1"}, {}, quiet);
  const auto statistics = terrane::ingest::scan_heights(*dem, quiet);
  terrane::tiler::OutputFolder(out).claim(/*force=*/true);
  terrane::tiler::build(dem->heights(), dem->place(), statistics, {.tolerance_m = 5}, out, quiet);
  terrane::viewer::write_viewer(out);
  const auto report = terrane::verify::verify(out, dem->heights(), dem->place(), {}, quiet);
  std::fputs(terrane::verify::to_text(report).c_str(), stdout);
  return report.holds();
}

int main(int, char** arguments) {
  try {
    if (!tile_and_verify(arguments[1])) return 1;
    const terrane::viewer::Server server({.data = {arguments[1]}, .port = 0});
    std::printf("would be served at %s\n", server.url().c_str());
    return 0;
  } catch (const terrane::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_status();
  }
}
