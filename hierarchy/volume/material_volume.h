#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hierarchy/volume/field.h"
#include "hierarchy/volume/interface_surface.h"
#include "hierarchy/volume/material.h"
#include "hierarchy/volume/refinement_queues.h"
#include "hierarchy/volume/tetra_geometry.h"
#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::hierarchy::volume {

/// A field with what its user calls it.
struct NamedField {
  std::string name;
  std::string unit;
  std::shared_ptr<const Field> field;
};

/// What is to be approximated.
struct VolumeModel {
  Box box;
  std::vector<std::shared_ptr<const InterfaceSurface>> interfaces;  ///< at most 8
  std::vector<Material> materials;  ///< 1 to 32, the first that fits wins; the last fits everywhere
  std::vector<NamedField> fields;
};

/// Largest errors, one for each interface (units of the model) and each field (its unit), above 0.
/// Infinity: of no concern.
struct VolumeTolerances {
  std::vector<double> interfaces;
  std::vector<double> fields;
};

enum class InterfaceErrorRule {
  /// Every point of an interface, to the approximation in its cell and around; and the corners and
  /// the centre of each piece of the approximation to the interface.
  kStrict,
  /// Vertices of an interface to the plane of the approximation in their cell: as published. No
  /// bound: triangles may pass through a cell and leave no vertex in it.
  kVertices
};

struct VolumeOptions {
  DistanceRule distance = DistanceRule::kExact;
  InterfaceErrorRule interface_error = InterfaceErrorRule::kStrict;
};

/// A tetrahedron of one material inside a cell.
struct Piece {
  SubTetra weights;  ///< of the cell's corners, a column for each corner of the piece
  MaterialId material{};
};

/// Materials between interfaces, approximated over tetrahedra.
///
/// Each vertex of the mesh holds a signed distance to each interface around it; in a cell the
/// interface is the zero set of their linear interpolant. Each vertex holds, for each field and
/// material around it, one value: the material's own, or a *ghost value* where it is another
/// material's place: that of the far side at the interface's nearest point (published: its nearest
/// vertex; with DistanceRule::kNearestVertex). So interfaces and
/// fields are continuous across cells.
///
/// Guarantees after refine(): errors of all leaves are within the tolerances. With
/// InterfaceErrorRule::kStrict every point of an interface where it parts two materials is within
/// its error of the approximation, and every point of the approximation in a cell within the error
/// there of the interface; at every place of a material (the true one) its field's
/// approximation is within the field error of the cell there. The same calls give the same bits.
///
/// \par Source
/// Gregorski et al. 2003, sections 3 and 5 to 7; ROAM's queues.
class MaterialVolume {
 public:
  /// \throws ConfigError if a list is longer than it may be, or no material fits everywhere.
  explicit MaterialVolume(VolumeModel model, const VolumeOptions& options = {});

  /// Splits cells, the worst first (error / tolerance), until all are within the tolerances, or
  /// there are \p most_cells.
  /// \return whether all are within the tolerances.
  /// \throws TopologyError naming an interface and a place, if cells became as small as they can.
  /// \throws ConfigError if the number of tolerances does not fit, or one is not above 0.
  bool refine(const VolumeTolerances& tolerances,
              std::size_t most_cells = std::numeric_limits<std::size_t>::max());

  /// Takes splits back, those that change least first, as long as errors stay within the
  /// tolerances. \throws as refine() does.
  void coarsen(const VolumeTolerances& tolerances);

  const VolumeModel& model() const { return model_; }
  const TetraMesh& mesh() const { return mesh_; }

  /// Signed distance of a vertex. Where no interface is near: interpolated, its sign holds.
  double distance(NodeId node, InterfaceId interface) const {
    return distances_[index(node) * interface_count() + index(interface)];
  }
  /// Value of a material at a vertex, or its ghost value.
  double value(NodeId node, FieldId field, MaterialId material) const {
    return values_[(index(node) * field_count() + index(field)) * model_.materials.size() +
                   index(material)];
  }
  /// The material that a vertex lies in.
  MaterialId material(NodeId node) const;

  /// Error of a cell. A bound up to the tolerance of the last call; beyond it an estimate.
  double interface_error(CellId cell, InterfaceId interface) const {
    return errors_[index(cell) * error_count() + index(interface)];
  }
  double field_error(CellId cell, FieldId field) const {
    return errors_[index(cell) * error_count() + interface_count() + index(field)];
  }
  /// |z(v_c) - z_T(v_c)| of a cell that was split, over the materials in it.
  double field_jump(CellId cell, FieldId field) const {
    return jumps_[index(cell) * field_count() + index(field)];
  }
  /// Materials that a leaf can hold; interfaces that part two of them there.
  Mask materials_in(CellId leaf) const { return possible_[index(leaf)]; }
  Mask interfaces_in(CellId leaf) const { return parting_[index(leaf)]; }

  TetraCorners corners(CellId leaf) const;
  Eigen::Vector4d distances(CellId leaf, InterfaceId interface) const;
  Eigen::Vector4d values(CellId leaf, FieldId field, MaterialId material) const;
  /// The approximation of an interface in a leaf; empty where it parts nothing.
  ZeroSet approximation(CellId leaf, InterfaceId interface) const;
  /// Material of the approximation at a place.
  MaterialId material_at(CellId leaf, const Eigen::Vector4d& weights) const;
  /// Material as the interfaces themselves have it.
  MaterialId true_material(const Eigen::Vector3d& p) const;
  /// Fills a leaf with tetrahedra of one material each.
  std::vector<Piece> pieces(CellId leaf) const;

  std::size_t interface_count() const { return model_.interfaces.size(); }
  std::size_t field_count() const { return model_.fields.size(); }

 private:
  struct GhostPlaces;

  std::size_t error_count() const { return interface_count() + field_count(); }
  void check_model() const;
  void set_tolerances(const VolumeTolerances& tolerances);
  void grow();
  void evaluate_leaves();

  // changes (material_volume.cpp)
  void split_once(CellId cell);
  void take_back(NodeId middle);
  void hand_down(CellId parent, const std::array<CellId, 2>& children,
                 const std::array<NodeId, 2>& ends);
  void note_jumps(CellId parent, const Diamond& diamond);
  void queue(CellId leaf);
  void queue_merges_around(CellId leaf);
  double ratio(CellId cell) const;
  bool recheck();
  [[noreturn]] void refuse_small_cell(CellId cell) const;

  // values of vertices (node_values.cpp)
  void compute_node(NodeId node, Mask interfaces, const std::array<NodeId, 2>* ends);
  GhostPlaces ghost_places(const Eigen::Vector3d& p, Mask interfaces, Mask below) const;
  Mask exact_below(const Eigen::Vector3d& p) const;

  // errors of cells (cell_errors.cpp)
  void evaluate(CellId cell);
  void drop_triangles_outside(CellId cell, const Barycentric& shape);
  double strict_error(CellId cell, InterfaceId interface, const Barycentric& shape);
  double published_error(CellId cell, InterfaceId interface, const Barycentric& shape) const;
  double deviation(CellId cell, FieldId field) const;
  double distance_around(CellId cell, InterfaceId interface, const Eigen::Vector3d& p,
                         std::vector<ZeroSet>& known);
  InterfaceId interface_of(std::uint32_t triangle) const;
  std::array<Eigen::Vector3d, 3> triangle(std::uint32_t id) const;
  Mask vertex_sides(CellId leaf, Mask& open) const;
  Mask interfaces_of_triangles(CellId leaf) const;

  VolumeModel model_;
  VolumeOptions options_;
  VolumeTolerances tolerances_;
  TetraMesh mesh_;
  RefinementQueues queues_;

  std::vector<std::uint32_t> first_triangle_;  ///< triangles of all interfaces are numbered through
  std::vector<double> distances_;              ///< by vertex, interface
  std::vector<double> values_;                 ///< by vertex, field, material
  std::vector<std::vector<std::uint32_t>> triangles_;  ///< by leaf: those that it meets
  std::vector<double> errors_;                         ///< by cell: interfaces, then fields
  std::vector<double> jumps_;                          ///< by cell, field
  std::vector<Mask> possible_, parting_;               ///< by cell
  std::vector<char> leans_on_neighbours_;  ///< by leaf: its error holds as long as they stay
  std::vector<std::uint32_t> seen_;        ///< by cell: the search that met it last
  std::uint32_t search_ = 0;
};

}  // namespace terrane::hierarchy::volume
