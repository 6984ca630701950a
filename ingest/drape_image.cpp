#include "ingest/drape_image.h"

#include <fmt/format.h>
#include <gdal_utils.h>
#include <gdalwarper.h>

#include <cmath>

#include "core/errors.h"
#include "ingest/file_contents.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {
namespace {

GDALDatasetUniquePtr open_image(const std::string& file, const char* const* options,
                                const GdalScope& gdal) {
  GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                                 nullptr, options, nullptr));
  if (dataset == nullptr) {
    throw InputError(
        fmt::format("{}: cannot be opened as an image ({}). Check --texture", file, gdal.reason()));
  }
  return dataset;
}

/// An image with a palette as one of red, green, blue and alpha.
GDALDatasetUniquePtr expanded(GDALDatasetUniquePtr dataset, const std::string& file) {
  if (dataset->GetRasterCount() == 0) throw InputError(fmt::format("{}: holds no image", file));
  if (dataset->GetRasterBand(1)->GetColorTable() == nullptr) return dataset;
  const char* arguments[] = {"-of", "VRT", "-expand", "rgba", nullptr};
  const std::unique_ptr<GDALTranslateOptions, void (*)(GDALTranslateOptions*)> options(
      GDALTranslateOptionsNew(const_cast<char**>(arguments), nullptr), GDALTranslateOptionsFree);
  GDALDatasetUniquePtr result(GDALDataset::FromHandle(
      GDALTranslate("", GDALDataset::ToHandle(dataset.get()), options.get(), nullptr)));
  if (result == nullptr) throw InputError(fmt::format("{}: its palette cannot be read", file));
  dataset.release()->ReleaseRef();  // the virtual image reads from it, and has a reference
  return result;
}

/// The files that GDAL reads an image from.
std::vector<std::string> files_of(GDALDataset& dataset) {
  std::vector<std::string> files;
  char** const list = dataset.GetFileList();
  for (char** name = list; name != nullptr && *name != nullptr; ++name) {
    VSIStatBufL status;
    if (VSIStatL(*name, &status) == 0 && VSI_ISREG(status.st_mode)) files.emplace_back(*name);
  }
  CSLDestroy(list);
  return files;
}

void check_depth(GDALDataset& dataset, const std::string& file) {
  for (auto* band : dataset.GetBands()) {
    if (band->GetRasterDataType() == GDT_Byte) continue;
    throw InputError(fmt::format(
        "{}: has {} values, and a texture has 8 bits. Convert it: gdal_translate -ot Byte -scale",
        file, GDALGetDataTypeName(band->GetRasterDataType())));
  }
}

constexpr double kApproximation_px = 0.125;

}  // namespace

/// One picture to be drawn.
struct DrapeImage::Cut {
  const DrapeImage& image;
  Window samples;
  int columns_px, rows_px;
  double factor;  ///< pixels of the image in one of the overview
};

DrapeImage::DrapeImage(const std::string& file, const Georeference& place)
    : file_(file), place_(place) {
  const GdalScope gdal;
  GDALDatasetUniquePtr image = open_image(file, nullptr, gdal);
  files_ = files_of(*image);
  dataset_ = expanded(std::move(image), file);
  check_depth(*dataset_, file);
  shape_ = {dataset_->GetRasterXSize(), dataset_->GetRasterYSize()};
  Geotransform transform;
  if (dataset_->GetGeoTransform(transform.data()) != CE_None ||
      !GDALInvGeoTransform(transform.data(), to_pixel_.data())) {
    throw InputError(fmt::format(
        "{}: does not say where it lies. Give it corners: gdal_translate -a_ullr", file));
  }
  if (place.crs_wkt().empty()) return;  // both in the same plain metres
  const OGRSpatialReference* crs = dataset_->GetSpatialRef();
  if (crs == nullptr) {
    throw InputError(fmt::format("{}: has no CRS. Give it one: gdal_translate -a_srs", file));
  }
  OGRSpatialReference earth, own(*crs);
  earth.SetWellKnownGeogCS("WGS84");
  earth.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  own.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  to_image_crs_.reset(OGRCreateCoordinateTransformation(&earth, &own));
  if (to_image_crs_ == nullptr) {
    throw InputError(
        fmt::format("{}: no way leads from longitudes to its CRS ({})", file, gdal.reason()));
  }
}

std::vector<std::optional<PlanPosition>> DrapeImage::pixels_of(
    std::span<const GridPosition> positions) const {
  std::vector<std::optional<PlanPosition>> pixels(positions.size());
  std::vector<double> x, y;
  if (to_image_crs_ == nullptr) {
    for (const GridPosition& position : positions) {
      const PlanPosition plan = place_.to_plan(position);
      x.push_back(plan.x);
      y.push_back(plan.y);
    }
  } else {
    for (const LonLat& at : place_.to_lon_lat(positions)) {
      x.push_back(at.longitude_deg);
      y.push_back(at.latitude_deg);
    }
    to_image_crs_->Transform(static_cast<int>(x.size()), x.data(), y.data());
  }
  for (std::size_t n = 0; n < positions.size(); ++n) {
    if (!std::isfinite(x[n]) || !std::isfinite(y[n])) continue;
    const Geotransform& t = to_pixel_;
    pixels[n] = {t[0] + t[1] * x[n] + t[2] * y[n], t[3] + t[4] * x[n] + t[5] * y[n]};
  }
  return pixels;
}

/// GDAL's callback: from texels to pixels. The way back is never asked for.
int DrapeImage::transform(void* pointer, int to_source, int count, double* x, double* y, double*,
                          int* success) {
  const Cut& cut = *static_cast<const Cut*>(pointer);
  std::fill_n(success, count, FALSE);
  if (to_source == FALSE) return FALSE;
  try {
    std::vector<GridPosition> positions;
    for (int n = 0; n < count; ++n) {
      const auto along = [](std::int64_t first, std::int64_t samples, double at, int texels) {
        return static_cast<double>(first) +
               (at - 0.5) / (texels - 1) * static_cast<double>(samples - 1);
      };
      positions.push_back({along(cut.samples.column, cut.samples.columns, x[n], cut.columns_px),
                           along(cut.samples.row, cut.samples.rows, y[n], cut.rows_px)});
    }
    const auto pixels = cut.image.pixels_of(positions);
    for (int n = 0; n < count; ++n) {
      const auto& pixel = pixels[static_cast<std::size_t>(n)];
      if (!pixel) continue;
      x[n] = pixel->x / cut.factor;
      y[n] = pixel->y / cut.factor;
      success[n] = TRUE;
    }
  } catch (const std::exception&) {
    return FALSE;  // a position without a place: nothing is drawn there
  }
  return TRUE;
}

/// The image, or the coarsest overview that is still finer than what is drawn.
GDALDataset& DrapeImage::level_for(double pixels_per_texel, double& factor) {
  factor = 1;
  int best = -1;
  GDALRasterBand& band = *dataset_->GetRasterBand(1);
  for (int n = 0; n < band.GetOverviewCount(); ++n) {
    const double own = static_cast<double>(shape_.columns) / band.GetOverview(n)->GetXSize();
    if (own > pixels_per_texel || own <= factor) continue;
    factor = own;
    best = n;
  }
  if (best < 0) return *dataset_;
  if (!overviews_.contains(best)) {
    const GdalScope gdal;
    const std::string level = fmt::format("OVERVIEW_LEVEL={}", best);
    const char* options[] = {level.c_str(), nullptr};
    overviews_[best] = expanded(open_image(file_, options, gdal), file_);
  }
  return *overviews_.at(best);
}

/// Bands with red, green, blue and alpha; alpha may be 0: none.
std::array<int, 4> DrapeImage::bands() const {
  const int count = dataset_->GetRasterCount();
  const auto is_alpha = [&](int n) {
    return dataset_->GetRasterBand(n)->GetColorInterpretation() == GCI_AlphaBand;
  };
  if (count < 3) return {1, 1, 1, count == 2 && is_alpha(2) ? 2 : 0};
  return {1, 2, 3, count > 3 && is_alpha(4) ? 4 : 0};
}

void DrapeImage::draw(GDALDataset& picture, const Window& samples, double pixels_per_texel) {
  const GdalScope gdal;
  Cut cut{*this, samples, picture.GetRasterXSize(), picture.GetRasterYSize(), 1};
  GDALDataset& source = level_for(pixels_per_texel, cut.factor);
  const std::unique_ptr<GDALWarpOptions, void (*)(GDALWarpOptions*)> options(
      GDALCreateWarpOptions(), GDALDestroyWarpOptions);
  const std::array<int, 4> from = bands();
  options->hSrcDS = GDALDataset::ToHandle(&source);
  options->hDstDS = GDALDataset::ToHandle(&picture);
  options->nBandCount = 3;
  options->panSrcBands = static_cast<int*>(CPLCalloc(3, sizeof(int)));
  options->panDstBands = static_cast<int*>(CPLCalloc(3, sizeof(int)));
  for (int n = 0; n < 3; ++n) {
    options->panSrcBands[n] = from[static_cast<std::size_t>(n)];
    options->panDstBands[n] = n + 1;
  }
  options->nSrcAlphaBand = from[3];
  options->nDstAlphaBand = 4;
  int has_nodata = FALSE;
  const double nodata = source.GetRasterBand(1)->GetNoDataValue(&has_nodata);
  if (has_nodata && from[3] == 0) {
    options->padfSrcNoDataReal = static_cast<double*>(CPLCalloc(3, sizeof(double)));
    for (int n = 0; n < 3; ++n) options->padfSrcNoDataReal[n] = nodata;
    options->papszWarpOptions =
        CSLSetNameValue(options->papszWarpOptions, "UNIFIED_SRC_NODATA", "YES");
  }
  options->eResampleAlg = pixels_per_texel / cut.factor > 1.5 ? GRA_Average : GRA_Bilinear;
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "SAMPLE_GRID", "YES");
  options->pfnTransformer = GDALApproxTransform;
  void* approximation =
      GDALCreateApproxTransformer(&DrapeImage::transform, &cut, kApproximation_px);
  options->pTransformerArg = approximation;

  GDALWarpOperation operation;
  const bool is_drawn = operation.Initialize(options.get()) == CE_None &&
                        operation.ChunkAndWarpImage(0, 0, cut.columns_px, cut.rows_px) == CE_None;
  GDALDestroyApproxTransformer(approximation);
  if (!is_drawn) {
    throw InputError(fmt::format("{}: cannot be read ({})", file_, gdal.reason()));
  }
}

std::string DrapeImage::describe() const {
  std::string text = fmt::format("{} {}", shape_.columns, shape_.rows);
  for (const double number : to_pixel_) text += fmt::format(" {}", number);
  if (const OGRSpatialReference* crs = dataset_->GetSpatialRef()) {
    char* wkt = nullptr;
    crs->exportToWkt(&wkt);
    text += wkt;
    CPLFree(wkt);
  }
  if (!files_.empty()) return text + hash_of_files(files_);
  // a service and no file: a sample of the pixels has to do
  constexpr int kSide = 256;
  std::vector<unsigned char> sample(kSide * kSide);
  for (int n = 1; n <= dataset_->GetRasterCount(); ++n) {
    if (dataset_->GetRasterBand(n)->RasterIO(GF_Read, 0, 0, static_cast<int>(shape_.columns),
                                             static_cast<int>(shape_.rows), sample.data(), kSide,
                                             kSide, GDT_Byte, 0, 0, nullptr) == CE_None) {
      text.append(sample.begin(), sample.end());
    }
  }
  return text;
}

}  // namespace terrane::ingest
