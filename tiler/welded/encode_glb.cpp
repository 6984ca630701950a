#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "tiler/welded/encode_surface.h"

namespace terrane::welded {
namespace {

using nlohmann::ordered_json;
using Float3 = std::array<float, 3>;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr double kShownError_px = 2;
constexpr double kScreen_px = 1080;

/// glTF is y up.
Float3 y_up(const Position& p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[2]), static_cast<float>(-p[1])};
}

struct Extent {
  Position least;
  Position most;

  /// A whole number of metres, so that places on the lattice stay exact.
  Position middle() const {
    Position middle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      middle[axis] = std::round((least[axis] + most[axis]) / 2);
    }
    return middle;
  }
  double diagonal_m() const {
    return std::hypot(most[0] - least[0], most[1] - least[1], most[2] - least[2]);
  }
};

Extent extent_of(const SurfaceMesh& surface) {
  Extent extent{surface.positions.front(), surface.positions.front()};
  for (const Position& position : surface.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      extent.least[axis] = std::min(extent.least[axis], position[axis]);
      extent.most[axis] = std::max(extent.most[axis], position[axis]);
    }
  }
  return extent;
}

/// Of each vertex: the sum of its triangles' normals, weighted by their areas.
std::vector<Float3> normals_of(const SurfaceMesh& surface) {
  std::vector<Position> sums(surface.positions.size(), Position{});
  for (const auto& [a, b, c] : surface.triangles) {
    Position u, v;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      u[axis] = surface.positions[b][axis] - surface.positions[a][axis];
      v[axis] = surface.positions[c][axis] - surface.positions[a][axis];
    }
    for (const std::uint32_t corner : {a, b, c}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t next = (axis + 1) % 3;
        const std::size_t last = (axis + 2) % 3;
        sums[corner][axis] += u[next] * v[last] - u[last] * v[next];
      }
    }
  }
  std::vector<Float3> normals;
  normals.reserve(sums.size());
  for (const Position& sum : sums) {
    const double length = std::hypot(sum[0], sum[1], sum[2]);
    normals.push_back(length > 0 ? y_up({sum[0] / length, sum[1] / length, sum[2] / length})
                                 : Float3{0, 1, 0});
  }
  return normals;
}

class GlbWriter {
 public:
  void add_level(const LevelMesh& level) {
    const SurfaceMesh& surface = level.surface;
    const Extent extent = extent_of(surface);
    const Position middle = extent.middle();
    std::vector<Float3> positions;
    positions.reserve(surface.positions.size());
    for (const Position& p : surface.positions) {
      positions.push_back(y_up({p[0] - middle[0], p[1] - middle[1], p[2] - middle[2]}));
    }
    const std::size_t position = add_accessor(positions, "VEC3", kFloat, 1, kArrayBuffer);
    add_bounds(positions);
    const std::size_t normal = add_accessor(normals_of(surface), "VEC3", kFloat, 1, kArrayBuffer);
    const std::size_t indices =
        add_accessor(surface.triangles, "SCALAR", kUnsignedInt, 3, kElementArrayBuffer);
    meshes_.push_back({{"primitives",
                        {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                          {"indices", indices},
                          {"material", 0}}}}});
    nodes_.push_back({{"name", fmt::format("level {}", level.level)},
                      {"mesh", meshes_.size() - 1},
                      {"translation", {middle[0], middle[2], -middle[1]}},
                      {"extras", {{"terrane", describe(level)}}}});
    diagonals_m_.push_back(extent.diagonal_m());
  }

  std::string write(const std::vector<LevelMesh>& levels) {
    ordered_json document{{"asset", {{"version", "2.0"}, {"generator", TERRANE_GENERATOR}}},
                          {"scene", 0},
                          {"scenes", {{{"nodes", {0}}}}}};
    if (levels.size() > 1) {
      add_lod(levels);
      document["extensionsUsed"] = {"MSFT_lod"};
    }
    document["nodes"] = std::move(nodes_);
    document["meshes"] = std::move(meshes_);
    // a terrain is dull, and glTF's default is a metal
    document["materials"] = {{{"pbrMetallicRoughness",
                               {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}},
                                {"metallicFactor", 0.0},
                                {"roughnessFactor", 1.0}}}}};
    document["accessors"] = std::move(accessors_);
    document["bufferViews"] = std::move(views_);
    document["buffers"] = {{{"byteLength", binary_.size()}}};
    return join(document.dump());
  }

 private:
  static ordered_json describe(const LevelMesh& level) {
    const Origin& origin = level.origin;
    ordered_json place;
    if (origin.is_local) {
      place = {{"x", origin.x_m}, {"y", origin.y_m}};
    } else {
      place = {{"longitude_deg", origin.longitude_deg}, {"latitude_deg", origin.latitude_deg}};
    }
    return {{"level", level.level},
            {"tolerance_m", level.tolerance_m},
            {"max_error_m", level.max_error_m},
            {"origin", std::move(place)}};
  }

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, const char* type, int component,
                           std::size_t per_value, int target) {
    const std::size_t bytes = values.size() * sizeof(T);
    views_.push_back(
        {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}, {"target", target}});
    binary_.append(reinterpret_cast<const char*>(values.data()), bytes);
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", values.size() * per_value},
                          {"type", type}});
    return accessors_.size() - 1;
  }

  void add_bounds(const std::vector<Float3>& positions) {
    Float3 least = positions.front();
    Float3 most = positions.front();
    for (const Float3& position : positions) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        least[axis] = std::min(least[axis], position[axis]);
        most[axis] = std::max(most[axis], position[axis]);
      }
    }
    accessors_.back()["min"] = least;
    accessors_.back()["max"] = most;
  }

  /// A level may be shown as long as its error is small on the screen; the finest one from there
  /// on.
  void add_lod(const std::vector<LevelMesh>& levels) {
    ordered_json ids = ordered_json::array();
    ordered_json coverage = ordered_json::array();
    for (std::size_t n = 1; n < levels.size(); ++n) {
      ids.push_back(n);
      const double most_coverage =
          kShownError_px * diagonals_m_[n] / (kScreen_px * levels[n].tolerance_m);
      coverage.push_back(std::min(1.0, most_coverage));
    }
    coverage.push_back(0.0);
    nodes_[0]["extensions"] = {{"MSFT_lod", {{"ids", ids}}}};
    nodes_[0]["extras"]["MSFT_screencoverage"] = coverage;
  }

  std::string join(std::string json) const {
    json.append((4 - json.size() % 4) % 4, ' ');
    const std::uint64_t bytes = 12 + 8 + json.size() + 8 + binary_.size();
    if (bytes > std::numeric_limits<std::uint32_t>::max()) {
      throw OutputError(fmt::format(
          "a glb of {} bytes: 4 GiB are the most. Export as .ply, a coarser --level or an --area",
          bytes));
    }
    std::string glb = "glTF";
    append(glb, 2);
    append(glb, bytes);
    append(glb, json.size());
    glb += "JSON" + json;
    append(glb, binary_.size());
    glb.append("BIN\0", 4);
    return glb + binary_;
  }

  static void append(std::string& bytes, std::uint64_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
  }

  std::string binary_;
  ordered_json nodes_ = ordered_json::array();
  ordered_json meshes_ = ordered_json::array();
  ordered_json accessors_ = ordered_json::array();
  ordered_json views_ = ordered_json::array();
  std::vector<double> diagonals_m_;
};

}  // namespace

std::string encode_glb(const std::vector<LevelMesh>& levels) {
  GlbWriter writer;
  for (const LevelMesh& level : levels) writer.add_level(level);
  return writer.write(levels);
}

}  // namespace terrane::welded
