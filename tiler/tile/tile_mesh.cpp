#include "tiler/tile/tile_mesh.h"

#include "tiler/files/work_file.h"

namespace terrane::tiler {
namespace {

constexpr std::uint64_t kMagic = 0x34656c6974727274;  // "trrtile4"

}  // namespace

void write_finished_tile(const FinishedTile& tile, const std::filesystem::path& file) {
  WorkFileWriter writer;
  writer.add(kMagic);
  writer.add(tile.descendants);
  writer.add(tile.mesh.points);
  writer.add(tile.mesh.borders);
  writer.add(tile.mesh.water_m);
  writer.add(tile.mesh.normals);
  writer.add(tile.mesh.grounds);
  writer.add(tile.mesh.triangles);
  writer.add(tile.mesh.in_water);
  writer.add(tile.mesh.lines);
  writer.add(tile.mesh.error);
  writer.write(file);
}

FinishedTile read_finished_tile(const std::filesystem::path& file) {
  WorkFileReader reader(file);
  if (reader.get<std::uint64_t>() != kMagic) reader.refuse();
  FinishedTile tile;
  tile.descendants = reader.get_vector<TileRecord>();
  tile.mesh.points = reader.get_vector<LatticePoint>();
  tile.mesh.borders = reader.get_vector<hierarchy::BorderPlace>();
  tile.mesh.water_m = reader.get_vector<float>();
  tile.mesh.normals = reader.get_vector<Eigen::Vector3f>();
  tile.mesh.grounds = reader.get_vector<Ground>();
  tile.mesh.triangles = reader.get_vector<hierarchy::Corners>();
  tile.mesh.in_water = reader.get_vector<std::uint8_t>();
  tile.mesh.lines = reader.get_vector<hierarchy::LineEdge>();
  tile.mesh.error = reader.get<MeasuredError>();
  return tile;
}

}  // namespace terrane::tiler
