#include "ingest/geoid.h"

#include <cpl_conv.h>
#include <fmt/format.h>
#include <gdal_priv.h>
#include <proj.h>

#include <GeographicLib/Geoid.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "core/errors.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {
namespace {

/// A raster in degrees, bilinear between its posts, as PROJ reads it.
class GeoidGrid final : public Geoid {
 public:
  explicit GeoidGrid(const std::string& file) : Geoid(file) {
    const GdalScope gdal;
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
    if (!dataset) {
      throw InputError(
          fmt::format("{}: is no geoid that GDAL can read ({}). Give egm96, none, or "
                      "a grid like those of PROJ",
                      file, gdal.reason()));
    }
    columns_ = dataset->GetRasterXSize();
    rows_ = dataset->GetRasterYSize();
    double t[6];
    if (dataset->GetGeoTransform(t) != CE_None || t[2] != 0 || t[4] != 0 || std::abs(t[0]) > 361 ||
        std::abs(t[3]) > 91) {
      throw InputError(
          fmt::format("{}: is no geoid in longitudes and latitudes. Reproject it with gdalwarp "
                      "-t_srs EPSG:4326",
                      file));
    }
    west_deg_ = t[0] + t[1] / 2;
    north_deg_ = t[3] + t[5] / 2;
    column_deg_ = t[1];
    row_deg_ = t[5];
    values_m_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, columns_, rows_, values_m_.data(),
                                            columns_, rows_, GDT_Float32, 0, 0,
                                            nullptr) != CE_None) {
      throw InputError(fmt::format("{}: cannot be read ({}). Get it again", file, gdal.reason()));
    }
  }

  double undulation_m(LonLat place) const override {
    const double turn = 360 / std::abs(column_deg_);
    double column = (place.longitude_deg - west_deg_) / column_deg_;
    column -= std::floor(column / turn) * turn;
    const double row = std::clamp((place.latitude_deg - north_deg_) / row_deg_, 0.0,
                                  static_cast<double>(rows_ - 1));
    const auto c = static_cast<int>(column), r = std::min(static_cast<int>(row), rows_ - 2);
    const bool goes_round = columns_ >= static_cast<int>(std::lround(turn));
    if (!goes_round && c > columns_ - 1) {
      throw InputError(
          fmt::format("{}: holds nothing at longitude {:.3f}, latitude {:.3f}. Give a "
                      "geoid that covers the DEM",
                      name(), place.longitude_deg, place.latitude_deg));
    }
    const int next =
        goes_round ? (c + 1) % static_cast<int>(std::lround(turn)) : std::min(c + 1, columns_ - 1);
    const double x = column - c, y = row - r;
    return (1 - y) * ((1 - x) * at(c, r) + x * at(next, r)) +
           y * ((1 - x) * at(c, r + 1) + x * at(next, r + 1));
  }

 private:
  double at(int column, int row) const {
    return values_m_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                     static_cast<std::size_t>(column)];
  }

  int columns_ = 0, rows_ = 0;
  double west_deg_ = 0, north_deg_ = 0, column_deg_ = 1, row_deg_ = -1;
  std::vector<float> values_m_;
};

class InstalledGeoid final : public Geoid {
 public:
  explicit InstalledGeoid(const std::string& name)
      : Geoid("GeographicLib " + name), geoid_(name, "", /*cubic=*/true, /*threadsafe=*/true) {}

  double undulation_m(LonLat place) const override {
    return geoid_(place.latitude_deg, place.longitude_deg);
  }

 private:
  GeographicLib::Geoid geoid_;
};

/// A file among those of PROJ; empty if it is not there.
std::string file_of_proj(const std::string& file) {
  std::string folders = proj_info().searchpath;
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    const auto path = std::filesystem::path(folders.substr(begin, end - begin)) / file;
    std::error_code error;
    if (std::filesystem::exists(path, error)) return path.string();
    begin = end + 1;
  }
  return {};
}

}  // namespace

std::unique_ptr<Geoid> open_geoid(const std::string& wanted) {
  if (wanted == "egm96") {
    const std::string file = file_of_proj("egm96_15.gtx");
    if (file.empty()) {
      throw ConfigError(
          "--geoid egm96: PROJ's egm96_15.gtx is not installed. Install proj-data, or give a file");
    }
    return std::make_unique<GeoidGrid>(file);
  }
  std::error_code error;
  if (std::filesystem::exists(wanted, error)) return std::make_unique<GeoidGrid>(wanted);
  if (const std::string file = file_of_proj(wanted); !wanted.empty() && !file.empty()) {
    return std::make_unique<GeoidGrid>(file);
  }
  try {
    return std::make_unique<InstalledGeoid>(wanted);
  } catch (const GeographicLib::GeographicErr&) {
    throw ConfigError(
        fmt::format("--geoid {}: is neither a file nor a geoid of PROJ or GeographicLib that is "
                    "installed. Give egm96, none, or a file",
                    wanted));
  }
}

}  // namespace terrane::ingest
