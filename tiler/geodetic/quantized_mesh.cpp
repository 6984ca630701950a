#include "tiler/geodetic/quantized_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>

#include "tiler/geodetic/grid_lattice.h"

namespace terrane::tiler {
namespace {

enum ExtensionId : std::uint8_t { kNormals = 1, kWaterMask = 2, kMetadata = 4 };

/// Little-endian bytes, as all machines that terrane is built for have them.
class Bytes {
 public:
  template <class T>
  void add(T value) {
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes_.append(raw, sizeof(T));
  }
  void add(const Eigen::Vector3d& v) {
    for (const double c : v) add(c);
  }
  void add_extension(ExtensionId id, const std::string& content) {
    add(static_cast<std::uint8_t>(id));
    add(static_cast<std::uint32_t>(content.size()));
    bytes_ += content;
  }
  void align(std::size_t size) { bytes_.resize((bytes_.size() + size - 1) / size * size); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

void add_header(Bytes& bytes, const TerrainTile& tile) {
  const TerrainFacts facts = facts_of(tile, ecef_of(tile));
  const HeightRange range = height_range(tile);
  bytes.add(facts.sphere.centre);
  bytes.add(range.min_m);
  bytes.add(range.max_m);
  bytes.add(facts.sphere.centre);
  bytes.add(facts.sphere.radius_m);
  bytes.add(facts.horizon);
}

/// Differences to the vertex before, zigzag: 0, -1, 1, -2, ... as 0, 1, 2, 3, ...
template <class Value>
void add_differences(Bytes& bytes, const TerrainTile& tile, Value value) {
  std::int32_t before = 0;
  for (const TerrainTile::Vertex& vertex : tile.vertices) {
    const std::int32_t now = value(vertex);
    assert(now >= 0 && now <= kTileSteps);
    const std::int32_t difference = now - before;
    before = now;
    bytes.add(static_cast<std::uint16_t>((difference << 1) ^ (difference >> 31)));
  }
}

void add_vertices(Bytes& bytes, const TerrainTile& tile) {
  const HeightRange range = height_range(tile);
  bytes.add(static_cast<std::uint32_t>(tile.vertices.size()));
  add_differences(bytes, tile, [](const auto& vertex) { return vertex.u; });
  add_differences(bytes, tile, [](const auto& vertex) { return vertex.v; });
  add_differences(bytes, tile, [&](const auto& vertex) {
    return static_cast<std::int32_t>((vertex.height - range.lowest) * range.per_step);
  });
}

/// Each index as what it lies below the highest so far; a new vertex is 0.
template <class Index>
void add_triangles(Bytes& bytes, const TerrainTile& tile) {
  bytes.align(sizeof(Index));
  bytes.add(static_cast<std::uint32_t>(tile.triangles.size()));
  std::uint32_t highest = 0;
  for (const auto& corners : tile.triangles) {
    for (const std::uint32_t v : corners) {
      bytes.add(static_cast<Index>(highest - v));
      if (v == highest) ++highest;
    }
  }
}

template <class Index>
void add_indices(Bytes& bytes, const TerrainTile& tile) {
  add_triangles<Index>(bytes, tile);
  const TerrainBorders borders = borders_of(tile);
  for (const auto* border : {&borders.west, &borders.south, &borders.east, &borders.north}) {
    bytes.add(static_cast<std::uint32_t>(border->size()));
    for (const std::uint32_t v : *border) bytes.add(static_cast<Index>(v));
  }
}

/// Two bytes a normal: the octahedron that the sphere is projected onto, unfolded to a square.
/// Source: Meyer et al. 2010, "On Floating-Point Normal Vectors".
std::string octahedral(const std::vector<Eigen::Vector3f>& normals) {
  std::string bytes;
  for (const Eigen::Vector3f& normal : normals) {
    const Eigen::Vector3d n = normal.cast<double>() / normal.cast<double>().lpNorm<1>();
    double x = n.x(), y = n.y();
    if (n.z() < 0) {
      x = (1 - std::abs(n.y())) * (n.x() < 0 ? -1 : 1);
      y = (1 - std::abs(n.x())) * (n.y() < 0 ? -1 : 1);
    }
    for (const double c : {x, y}) {
      bytes += static_cast<char>(std::lround((std::clamp(c, -1.0, 1.0) / 2 + 0.5) * 255));
    }
  }
  return bytes;
}

std::string with_length(const std::string& json) {
  Bytes bytes;
  bytes.add(static_cast<std::uint32_t>(json.size()));
  return bytes.take() + json;
}

}  // namespace

HeightRange height_range(const TerrainTile& tile) {
  const auto [low, high] =
      std::ranges::minmax(tile.vertices, {}, [](const auto& vertex) { return vertex.height; });
  HeightRange range{.lowest = low.height};
  const auto metres = [&](std::int64_t quantized_steps) {
    return static_cast<double>(quantized_steps) * tile.height_step_m /
           static_cast<double>(range.per_step);
  };
  const auto is_float = [](double value) {
    return static_cast<double>(static_cast<float>(value)) == value;
  };
  if (low.height < high.height) {
    // as many as fit, so that the maximum is less than twice as far up as the highest vertex
    while ((high.height - low.height) * range.per_step * 2 <= kTileSteps) range.per_step *= 2;
    while (range.per_step > 1 && !is_float(metres(low.height * range.per_step + kTileSteps))) {
      range.per_step /= 2;
    }
  }
  range.min_m = static_cast<float>(metres(low.height * range.per_step));
  range.max_m = low.height == high.height
                    ? range.min_m
                    : static_cast<float>(metres(low.height * range.per_step + kTileSteps));
  return range;
}

std::string encode_quantized_mesh(const TerrainTile& given) {
  constexpr std::size_t kMostFor16Bits = 65536;
  const TerrainTile tile = in_order_of_use(given);
  Bytes bytes;
  add_header(bytes, tile);
  add_vertices(bytes, tile);
  if (tile.vertices.size() <= kMostFor16Bits) {
    add_indices<std::uint16_t>(bytes, tile);
  } else {
    add_indices<std::uint32_t>(bytes, tile);
  }
  bytes.add_extension(kNormals, octahedral(tile.normals));
  if (!tile.water.empty()) bytes.add_extension(kWaterMask, tile.water);
  if (!tile.metadata.empty()) bytes.add_extension(kMetadata, with_length(tile.metadata));
  return bytes.take();
}

}  // namespace terrane::tiler
