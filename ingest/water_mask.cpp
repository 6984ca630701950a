#include "ingest/water_mask.h"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>

#include <algorithm>

#include "core/errors.h"
#include "ingest/fingerprint.h"
#include "ingest/gdal_scope.h"
#include "ingest/layer_place.h"
#include "ingest/vector_layer.h"

namespace terrane::ingest {
namespace {

class PolygonMask final : public WaterMask {
 public:
  explicit PolygonMask(const std::vector<std::string>& sources) {
    for (const std::string& source : sources) {
      VectorLayer layer = read_vector_layer(source, WantedGeometry::kPolygons);
      place_on_earth(layer);
      for (OGRGeometryUniquePtr& part : layer.parts) {
        OGREnvelope box;
        part->getEnvelope(&box);
        boxes_.push_back(box);
        polygons_.push_back(std::move(part));
      }
    }
  }

  std::string bytes(double west_deg, double south_deg, double east_deg,
                    double north_deg) const override {
    OGREnvelope wanted;
    wanted.MinX = west_deg;
    wanted.MaxX = east_deg;
    wanted.MinY = south_deg;
    wanted.MaxY = north_deg;
    std::vector<OGRGeometryH> inside;
    for (std::size_t k = 0; k < polygons_.size(); ++k) {
      if (boxes_[k].Intersects(wanted)) inside.push_back(OGRGeometry::ToHandle(polygons_[k].get()));
    }
    if (inside.empty()) return {'\0'};
    std::string mask(static_cast<std::size_t>(kCells) * kCells, '\0');
    rasterize(inside, wanted, mask);
    if (std::ranges::all_of(mask, [&](char c) { return c == mask.front(); })) mask.resize(1);
    return mask;
  }

  std::string fingerprint() const override {
    Fingerprint fingerprint;
    for (const OGRGeometryUniquePtr& polygon : polygons_) {
      std::vector<unsigned char> bytes(polygon->WkbSize());
      polygon->exportToWkb(wkbNDR, bytes.data());
      fingerprint.add(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    }
    return fingerprint.hex();
  }

 private:
  static void rasterize(std::vector<OGRGeometryH>& polygons, const OGREnvelope& box,
                        std::string& mask) {
    const GdalScope gdal;
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
    const GDALDatasetUniquePtr raster(driver->Create("", kCells, kCells, 1, GDT_Byte, nullptr));
    double transform[6] = {box.MinX, (box.MaxX - box.MinX) / kCells, 0, box.MaxY,
                           0,        (box.MinY - box.MaxY) / kCells};
    raster->SetGeoTransform(transform);
    int band = 1;
    const std::vector<double> water(polygons.size(), 255);
    const bool is_done =
        GDALRasterizeGeometries(GDALDataset::ToHandle(raster.get()), 1, &band,
                                static_cast<int>(polygons.size()), polygons.data(), nullptr,
                                nullptr, water.data(), nullptr, nullptr, nullptr) == CE_None &&
        raster->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, kCells, kCells, mask.data(), kCells,
                                           kCells, GDT_Byte, 0, 0, nullptr) == CE_None;
    if (!is_done) {
      throw InputError(fmt::format("--water: cannot be drawn into a mask ({})", gdal.reason()));
    }
  }

  std::vector<OGRGeometryUniquePtr> polygons_;
  std::vector<OGREnvelope> boxes_;
};

}  // namespace

std::shared_ptr<const WaterMask> open_water_mask(const std::vector<std::string>& sources) {
  return std::make_shared<PolygonMask>(sources);
}

}  // namespace terrane::ingest
