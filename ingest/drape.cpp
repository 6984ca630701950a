#include "ingest/drape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "ingest/drape_image.h"
#include "ingest/gdal_scope.h"
#include "ingest/picture_bytes.h"

namespace terrane::ingest {
namespace {

/// That of tiles without a texture.
constexpr unsigned char kGround[] = {206, 203, 196};

constexpr int kProbes = 33;  // along each side of the DEM

std::string hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211U;
  return fmt::format("{:016x}", hash);
}

GDALDatasetUniquePtr new_picture(int columns, int rows, int bands) {
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr picture(memory->Create("", columns, rows, bands, GDT_Byte, nullptr));
  if (bands == 4) picture->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  return picture;
}

class Drape final : public TextureSource {
 public:
  Drape(const DrapeOptions& options, const Georeference& place, GridShape shape)
      : is_webp_(options.format == PictureFormat::kWebp),
        media_type_(is_webp_ ? "image/webp" : "image/jpeg") {
    const GdalScope gdal;
    std::string text = media_type_;
    for (const std::string& file : options.images) {
      images_.push_back(std::make_unique<DrapeImage>(file, place));
      text += images_.back()->describe();
    }
    fingerprint_ = hash_of(text);
    find_resolution(shape);
  }

  double texels_per_cell() const override { return texels_per_cell_; }
  const std::string& media_type() const override { return media_type_; }
  const std::string& fingerprint() const override { return fingerprint_; }

  std::string cut(const Window& samples, int columns_px, int rows_px) const override {
    const GdalScope gdal;
    const GDALDatasetUniquePtr picture = new_picture(columns_px, rows_px, 4);
    const double cells_per_texel = static_cast<double>(samples.columns - 1) / (columns_px - 1);
    for (const auto& image : images_) {
      image->draw(*picture, samples, texels_per_cell_ * cells_per_texel);
    }
    const GDALDatasetUniquePtr opaque = over_ground(*picture, gdal);
    return is_webp_ ? picture_bytes(*opaque, "WEBP", {"QUALITY=80"})
                    : picture_bytes(*opaque, "JPEG", {"QUALITY=85"});
  }

 private:
  /// How dense the images are where they lie over the DEM.
  void find_resolution(GridShape shape) {
    std::vector<GridPosition> probes;
    for (int r = 0; r < kProbes; ++r) {
      for (int c = 0; c < kProbes; ++c) {
        // both ends of half a cell, inside the DEM
        const double column = c * (static_cast<double>(shape.columns) - 1.5) / (kProbes - 1);
        const double row = r * static_cast<double>(shape.rows - 1) / (kProbes - 1);
        probes.push_back({column, row});
        probes.push_back({column + 0.5, row});
      }
    }
    for (const auto& image : images_) {
      const auto pixels = image->pixels_of(probes);
      for (std::size_t n = 0; n < pixels.size(); n += 2) {
        if (!pixels[n] || !pixels[n + 1] || !is_inside(*pixels[n], image->shape())) continue;
        const double half_cell_px =
            std::hypot(pixels[n + 1]->x - pixels[n]->x, pixels[n + 1]->y - pixels[n]->y);
        texels_per_cell_ = std::max(texels_per_cell_, 2 * half_cell_px);
      }
    }
    if (texels_per_cell_ > 0) return;
    throw InputError(fmt::format("{}: does not lie over the DEM. Check its CRS and corners",
                                 images_.front()->file()));
  }

  static bool is_inside(const PlanPosition& pixel, GridShape shape) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x <= static_cast<double>(shape.columns) &&
           pixel.y <= static_cast<double>(shape.rows);
  }

  /// The picture with what is transparent in the colour of the ground.
  static GDALDatasetUniquePtr over_ground(GDALDataset& picture, const GdalScope& gdal) {
    const int columns = picture.GetRasterXSize(), rows = picture.GetRasterYSize();
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    GDALDatasetUniquePtr opaque = new_picture(columns, rows, 3);
    std::vector<unsigned char> alpha(count), colour(count);
    const auto transfer = [&](GDALDataset& dataset, int band, GDALRWFlag way,
                              std::vector<unsigned char>& values) {
      const CPLErr status = dataset.GetRasterBand(band)->RasterIO(
          way, 0, 0, columns, rows, values.data(), columns, rows, GDT_Byte, 0, 0, nullptr);
      if (status != CE_None) throw InputError("a texture cannot be made: " + gdal.reason());
    };
    transfer(picture, 4, GF_Read, alpha);
    for (int band = 1; band <= 3; ++band) {
      transfer(picture, band, GF_Read, colour);
      for (std::size_t n = 0; n < count; ++n) {
        const int ground = kGround[band - 1];
        const int mixed = colour[n] * alpha[n] + ground * (255 - alpha[n]);
        colour[n] = static_cast<unsigned char>((mixed + 127) / 255);
      }
      transfer(*opaque, band, GF_Write, colour);
    }
    return opaque;
  }

  std::vector<std::unique_ptr<DrapeImage>> images_;  // used by one thread at a time: GdalScope
  bool is_webp_;
  std::string media_type_;
  std::string fingerprint_;
  double texels_per_cell_ = 0;
};

}  // namespace

std::unique_ptr<TextureSource> open_drape(const DrapeOptions& options, const Georeference& place,
                                          GridShape shape) {
  return std::make_unique<Drape>(options, place, shape);
}

}  // namespace terrane::ingest
