#pragma once

#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace terrane::model {

/// A surface of a model file: one of dem, level and mesh.
struct SurfaceSettings {
  std::string name;
  std::vector<std::string> dem;  ///< heights; of several the first that has data speaks
  std::string nodata;      ///< of all of them, as `terrane build --nodata`; empty: as they say
  double level_m = 0;      ///< with inside: water at this height
  std::string inside;      ///< vector file with polygons
  std::string mesh;        ///< closed triangle mesh (OBJ, PLY, OFF, STL)
  std::string over;        ///< a surface of heights that this one must not dip under
  double tolerance_m = 0;  ///< largest error, above 0
};

struct MaterialSettings {
  std::string name;
  std::string where;  ///< "below A and above B"; empty: everywhere else
  bool is_empty = false;
};

/// Where a field's values in one material come from: one of formula, raster and grid; with none of
/// them they are 0.
struct FieldSource {
  std::string formula;           ///< of x, y and z
  std::string raster;            ///< one band for each level
  std::vector<double> levels_m;  ///< heights of the bands, rising; empty for a raster of one band
  std::string nodata;            ///< of the raster, as `terrane build --nodata`; empty: as it says
  std::string grid;              ///< VTK rectilinear grid (.vtr), in metres of the model
  std::string array;             ///< of the grid; empty: its only one
};

struct FieldSettings {
  std::string name;
  std::string unit;
  double tolerance = std::numeric_limits<double>::infinity();
  std::array<int, 3> samples = {2, 2, 2};
  std::vector<std::pair<std::string, FieldSource>> sources;  ///< material, where from
};

/// A cross-section: the places p with normal . p = offset_m.
struct SectionSettings {
  std::string name;
  std::array<double, 3> normal = {1, 0, 0};
  double offset_m = 0;
};

/// What is in a box: in degrees on Earth, else in metres.
struct BoxSettings {
  bool is_geographic = false;
  double west = 0, east = 0, south = 0, north = 0;
  double bottom_m = 0, top_m = 0;
};

/// A model file as it stands.
struct ModelSettings {
  std::string file;
  BoxSettings box;
  std::vector<SurfaceSettings> surfaces;
  std::vector<MaterialSettings> materials;
  std::vector<FieldSettings> fields;
  std::vector<SectionSettings> sections;
  std::size_t most_cells = 20'000'000;
};

/// Reads CONFIG.toml of `terrane volume`; config/volume/crater_lake.toml explains every key.
/// \throws InputError if the file cannot be read; ConfigError naming file, line and key for what is
///         unknown, missing, of the wrong type or out of range.
ModelSettings read_model_file(const std::filesystem::path& file);

}  // namespace terrane::model
