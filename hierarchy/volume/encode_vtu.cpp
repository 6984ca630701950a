#include "hierarchy/volume/encode_vtu.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <bit>
#include <cstring>

#include "hierarchy/volume/leaf_numbering.h"

namespace terrane::hierarchy::volume {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
constexpr const char* kVtkName = nullptr;
template <>
constexpr const char* kVtkName<double> = "Float64";
template <>
constexpr const char* kVtkName<std::int64_t> = "Int64";
template <>
constexpr const char* kVtkName<std::int8_t> = "Int8";
template <>
constexpr const char* kVtkName<std::uint8_t> = "UInt8";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// An XML head that says where in the tail each array lies.
class VtuText {
 public:
  VtuText(std::size_t points, std::size_t cells) {
    head_ = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        points, cells);
  }

  void open(const char* section) { head_ += fmt::format("<{}>\n", section); }
  void close(const char* section) { head_ += fmt::format("</{}>\n", section); }

  template <class T>
  void add(const std::string& name, const std::vector<T>& values, int components = 1) {
    head_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
        "offset=\"{}\"/>\n",
        kVtkName<T>, escaped(name), components, tail_.size());
    const std::uint64_t bytes = values.size() * sizeof(T);
    tail_.append(reinterpret_cast<const char*>(&bytes), sizeof(bytes));
    tail_.append(reinterpret_cast<const char*>(values.data()), bytes);
  }

  std::string finish() {
    return head_ + "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" + tail_ +
           "\n</AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string head_, tail_;
};

void add_tetrahedra(VtuText& text, const std::vector<std::int64_t>& corners) {
  constexpr std::uint8_t kVtkTetra = 10;
  std::vector<std::int64_t> ends;
  for (std::size_t end = 4; end <= corners.size(); end += 4) {
    ends.push_back(static_cast<std::int64_t>(end));
  }
  text.open("Cells");
  text.add("connectivity", corners);
  text.add("offsets", ends);
  text.add("types", std::vector<std::uint8_t>(ends.size(), kVtkTetra));
  text.close("Cells");
}

void add_points(VtuText& text, const std::vector<double>& coordinates) {
  text.open("Points");
  text.add("Points", coordinates, 3);
  text.close("Points");
}

void append(std::vector<double>& list, const Eigen::Vector3d& p) {
  list.insert(list.end(), {p.x(), p.y(), p.z()});
}

/// VTK wants the fourth corner on the side that the first three turn to.
template <class Corner>
void turn(std::array<Corner, 4>& corner, const std::array<Eigen::Vector3d, 4>& at) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = at[k + 1] - at[0];
  if (edges.determinant() < 0) std::swap(corner[2], corner[3]);
}

std::int8_t only_material(Mask materials) {
  return std::has_single_bit(materials) ? static_cast<std::int8_t>(std::countr_zero(materials))
                                        : std::int8_t{-1};
}

template <class T, class Id, class F>
std::vector<T> each(const std::vector<Id>& ids, F&& f) {
  std::vector<T> values;
  values.reserve(ids.size());
  for (const Id id : ids) values.push_back(f(id));
  return values;
}

void add_point_data(VtuText& text, const MaterialVolume& volume, const std::vector<NodeId>& nodes) {
  const VolumeModel& model = volume.model();
  text.open("PointData");
  for (std::uint8_t i = 0; i < volume.interface_count(); ++i) {
    text.add("distance to " + model.interfaces[i]->name(),
             each<double>(nodes, [&](NodeId n) { return volume.distance(n, InterfaceId{i}); }));
  }
  for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
    for (std::uint8_t m = 0; m < model.materials.size(); ++m) {
      text.add(model.fields[f].name + " of " + model.materials[m].name,
               each<double>(nodes,
                            [&](NodeId n) { return volume.value(n, FieldId{f}, MaterialId{m}); }));
    }
  }
  text.close("PointData");
}

void add_cell_data(VtuText& text, const MaterialVolume& volume, const std::vector<CellId>& leaves) {
  const VolumeModel& model = volume.model();
  text.open("CellData");
  text.add("material", each<std::int8_t>(leaves, [&](CellId leaf) {
             return only_material(volume.materials_in(leaf));
           }));
  text.add("level", each<std::int8_t>(leaves, [&](CellId leaf) {
             return static_cast<std::int8_t>(volume.mesh().level(leaf));
           }));
  for (std::uint8_t i = 0; i < volume.interface_count(); ++i) {
    text.add("error of " + model.interfaces[i]->name(), each<double>(leaves, [&](CellId leaf) {
               return volume.interface_error(leaf, InterfaceId{i});
             }));
  }
  for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
    text.add("error of " + model.fields[f].name, each<double>(leaves, [&](CellId leaf) {
               return volume.field_error(leaf, FieldId{f});
             }));
  }
  text.close("CellData");
}

}  // namespace

std::string encode_cells_vtu(const MaterialVolume& volume) {
  const std::vector<CellId> leaves = volume.mesh().leaves_in_tree_order();
  const LeafNumbering numbering = number_nodes(volume.mesh(), leaves);
  std::vector<double> points;
  for (const NodeId node : numbering.nodes) append(points, volume.mesh().position(node));
  std::vector<std::int64_t> corners;
  for (const CellId leaf : leaves) {
    std::array<NodeId, 4> cell = volume.mesh().corners(leaf);
    turn(cell, volume.corners(leaf));
    for (const NodeId node : cell) corners.push_back(numbering.number[index(node)]);
  }
  VtuText text(numbering.nodes.size(), leaves.size());
  add_point_data(text, volume, numbering.nodes);
  add_cell_data(text, volume, leaves);
  add_points(text, points);
  add_tetrahedra(text, corners);
  return text.finish();
}

std::string encode_materials_vtu(const MaterialVolume& volume) {
  std::vector<double> points;
  std::vector<std::int64_t> corners;
  std::vector<std::int8_t> materials;
  std::vector<std::vector<double>> fields(volume.field_count());
  for (const CellId leaf : volume.mesh().leaves_in_tree_order()) {
    const TetraCorners cell = volume.corners(leaf);
    for (const Piece& piece : volume.pieces(leaf)) {
      TetraCorners at;
      for (int k = 0; k < 4; ++k) {
        at[k].setZero();
        for (int c = 0; c < 4; ++c) at[k] += piece.weights(c, k) * cell[c];
      }
      const auto first = static_cast<std::int64_t>(points.size() / 3);
      std::array<std::int64_t, 4> own = {first, first + 1, first + 2, first + 3};
      turn(own, at);
      for (const Eigen::Vector3d& p : at) append(points, p);
      corners.insert(corners.end(), own.begin(), own.end());
      materials.push_back(static_cast<std::int8_t>(piece.material));
      for (std::uint8_t f = 0; f < volume.field_count(); ++f) {
        const Eigen::Vector4d values =
            piece.weights.transpose() * volume.values(leaf, FieldId{f}, piece.material);
        fields[f].insert(fields[f].end(), values.begin(), values.end());
      }
    }
  }
  VtuText text(points.size() / 3, materials.size());
  text.open("PointData");
  for (std::size_t f = 0; f < fields.size(); ++f)
    text.add(volume.model().fields[f].name, fields[f]);
  text.close("PointData");
  text.open("CellData");
  text.add("material", materials);
  text.close("CellData");
  add_points(text, points);
  add_tetrahedra(text, corners);
  return text.finish();
}

}  // namespace terrane::hierarchy::volume
