#include <cpl_string.h>
#include <fmt/format.h>

#include "core/errors.h"
#include "ingest/raster_file.h"

namespace terrane::ingest {
namespace {

bool is_picture_band(GDALRasterBand& band) {
  if (band.GetRasterDataType() != GDT_Byte) return false;
  const GDALColorInterp meaning = band.GetColorInterpretation();
  return band.GetColorTable() != nullptr || meaning == GCI_PaletteIndex || meaning == GCI_RedBand ||
         meaning == GCI_GreenBand || meaning == GCI_BlueBand;
}

std::string without_bands_message(GDALDataset& dataset, const std::string& file) {
  char** parts = dataset.GetMetadata("SUBDATASETS");
  const char* first = CSLFetchNameValue(parts, "SUBDATASET_1_NAME");
  if (first == nullptr)
    return fmt::format("{}: holds no raster band. Give a file with heights", file);
  return fmt::format("{}: holds {} rasters; name the one with the heights, e.g. {}", file,
                     CSLCount(parts) / 2, first);
}

}  // namespace

GDALRasterBand& choose_band(GDALDataset& dataset, const std::string& file,
                            const std::optional<int>& wanted) {
  const int count = dataset.GetRasterCount();
  if (count == 0) throw InputError(without_bands_message(dataset, file));
  if (wanted) {
    if (*wanted >= 1 && *wanted <= count) return *dataset.GetRasterBand(*wanted);
    throw InputError(
        fmt::format("{}: has no band {}; --band takes 1 to {} here", file, *wanted, count));
  }
  GDALRasterBand& first = *dataset.GetRasterBand(1);
  const bool is_picture = is_picture_band(first);
  if (count == 1 && !is_picture) return first;
  if (count == 1) {
    throw InputError(
        fmt::format("{}: looks like an image, not a DEM (its Byte band holds colours); "
                    "if it does hold heights, say so with --band 1",
                    file));
  }
  throw InputError(
      fmt::format("{}: has {} bands{}; pick the one with the heights with --band N (1 "
                  "to {})",
                  file, count, is_picture ? " and looks like an image, not a DEM" : "", count));
}

}  // namespace terrane::ingest
