#include "hierarchy/volume/material_volume.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "core/errors.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kMostInterfaces = 8, kMostMaterials = 32;

}  // namespace

MaterialVolume::MaterialVolume(VolumeModel model, const VolumeOptions& options)
    : model_(std::move(model)), options_(options), mesh_(model_.box) {
  check_model();
  std::uint32_t triangles = 0;
  for (const auto& surface : model_.interfaces) {
    first_triangle_.push_back(triangles);
    triangles += static_cast<std::uint32_t>(surface->mesh().triangles.size());
  }
  grow();
  for (std::uint32_t n = 0; n < mesh_.node_capacity(); ++n) {
    compute_node(NodeId{n}, (Mask{1} << interface_count()) - 1, nullptr);
  }
  mesh_.for_each_leaf([&](CellId root) {
    triangles_[index(root)].resize(triangles);
    std::iota(triangles_[index(root)].begin(), triangles_[index(root)].end(), 0u);
  });
  // before anybody asks for errors, a glance at each cell will do
  tolerances_.interfaces.assign(interface_count(), std::numeric_limits<double>::min());
  tolerances_.fields.assign(field_count(), std::numeric_limits<double>::infinity());
  evaluate_leaves();
}

void MaterialVolume::check_model() const {
  if (interface_count() > kMostInterfaces) {
    throw ConfigError(fmt::format("{} interfaces are more than {}. Leave some out",
                                  interface_count(), kMostInterfaces));
  }
  if (model_.materials.empty() || model_.materials.size() > kMostMaterials) {
    throw ConfigError(
        fmt::format("{} materials: give 1 to {}", model_.materials.size(), kMostMaterials));
  }
  if (!model_.materials.back().where.empty()) {
    throw ConfigError(
        fmt::format("material {}: the last one takes what no other does. Leave its "
                    "'where' out",
                    model_.materials.back().name));
  }
}

void MaterialVolume::set_tolerances(const VolumeTolerances& tolerances) {
  const auto is_good = [](const std::vector<double>& list, std::size_t count) {
    return list.size() == count && std::ranges::all_of(list, [](double t) { return t > 0; });
  };
  if (!is_good(tolerances.interfaces, interface_count()) ||
      !is_good(tolerances.fields, field_count())) {
    throw ConfigError(
        fmt::format("tolerances: give one above 0 for each of {} interfaces and {} "
                    "fields",
                    interface_count(), field_count()));
  }
  tolerances_ = tolerances;
}

void MaterialVolume::grow() {
  const std::size_t nodes = mesh_.node_capacity(), cells = mesh_.cell_capacity();
  distances_.resize(nodes * interface_count());
  values_.resize(nodes * field_count() * model_.materials.size());
  triangles_.resize(cells);
  errors_.resize(cells * error_count());
  jumps_.resize(cells * field_count());
  possible_.resize(cells);
  parting_.resize(cells);
  leans_on_neighbours_.resize(cells);
  seen_.resize(cells);
}

void MaterialVolume::evaluate_leaves() {
  queues_ = {};
  // what parts a cell has to be known all around before errors are
  for (const CellId leaf : mesh_.leaves_in_tree_order()) {
    evaluate(leaf);
    queue(leaf);
  }
}

double MaterialVolume::ratio(CellId cell) const {
  double largest = 0;
  const double* errors = &errors_[index(cell) * error_count()];
  for (std::size_t i = 0; i < interface_count(); ++i) {
    if (std::isinf(tolerances_.interfaces[i])) continue;
    largest = std::max(largest, errors[i] / tolerances_.interfaces[i]);
  }
  for (std::size_t f = 0; f < field_count(); ++f) {
    largest = std::max(largest, errors[interface_count() + f] / tolerances_.fields[f]);
  }
  return largest;
}

void MaterialVolume::queue(CellId leaf) {
  const double wanted = ratio(leaf);
  if (wanted > 1) {
    queues_.want_split(leaf, wanted);
  } else {
    queues_.forget(leaf);
  }
}

bool MaterialVolume::refine(const VolumeTolerances& tolerances, std::size_t most_cells) {
  set_tolerances(tolerances);
  evaluate_leaves();
  while (mesh_.leaf_count() < most_cells) {
    const auto worst = queues_.worst();
    if (worst) {
      split_once(worst->cell);
    } else if (recheck()) {
      return true;
    }
  }
  return !queues_.worst() && recheck();
}

// Errors that lean on neighbours may have grown as those were split. True: none is too large.
bool MaterialVolume::recheck() {
  for (const CellId leaf : mesh_.leaves_in_tree_order()) {
    if (leans_on_neighbours_[index(leaf)] == 0) continue;
    evaluate(leaf);
    queue(leaf);
  }
  return !queues_.worst().has_value();
}

void MaterialVolume::refuse_small_cell(CellId cell) const {
  const Vector3d at = mesh_.position(mesh_.corners(cell)[0]);
  throw TopologyError(fmt::format(
      "cells at ({:.9g}, {:.9g}, {:.9g}) became as small as they can, and the error is still "
      "{:.3g} "
      "times the tolerance. Look for a surface that touches itself there, or allow a larger error",
      at.x(), at.y(), at.z(), ratio(cell)));
}

void MaterialVolume::split_once(CellId cell) {
  if (mesh_.level(cell) >= TetraMesh::kMostLevels) refuse_small_cell(cell);
  const Diamond diamond = mesh_.split_towards(cell);
  grow();
  Mask interfaces = 0;
  for (const CellId parent : diamond.parents) interfaces |= interfaces_of_triangles(parent);
  compute_node(diamond.middle, interfaces, &diamond.ends);
  for (std::size_t p = 0; p < diamond.parents.size(); ++p) {
    const CellId parent = diamond.parents[p];
    queues_.forget(parent);
    note_jumps(parent, diamond);
    hand_down(parent, diamond.children[p], diamond.ends);
  }
  for (const auto& pair : diamond.children) {
    for (const CellId child : pair) {
      evaluate(child);
      queue(child);
    }
  }
}

// Equation (2): what the parent said at the new vertex was the mean of the edge's ends.
void MaterialVolume::note_jumps(CellId parent, const Diamond& diamond) {
  for (std::size_t f = 0; f < field_count(); ++f) {
    const FieldId field{static_cast<std::uint8_t>(f)};
    double& jump = jumps_[index(parent) * field_count() + f];
    jump = 0;
    for (std::size_t m = 0; m < model_.materials.size(); ++m) {
      const MaterialId material{static_cast<std::uint8_t>(m)};
      if ((possible_[index(parent)] >> m & 1) == 0 || model_.materials[m].is_empty) continue;
      const double mean =
          (value(diamond.ends[0], field, material) + value(diamond.ends[1], field, material)) / 2;
      jump = std::max(jump, std::abs(value(diamond.middle, field, material) - mean));
    }
  }
}

// Interface triangles go to the children that they reach: these lie on either side of the face that
// they share. evaluate() drops the triangles that miss them.
void MaterialVolume::hand_down(CellId parent, const std::array<CellId, 2>& children,
                               const std::array<NodeId, 2>& ends) {
  std::array<Vector3d, 3> shared;
  Vector3d tip = Vector3d::Zero();  // the corner of the first child that the second has not
  int count = 0;
  for (const NodeId node : mesh_.corners(children[0])) {
    if (node == ends[0] || node == ends[1]) {
      tip = mesh_.position(node);
    } else {
      shared[count++] = mesh_.position(node);
    }
  }
  const Vector3d& origin = shared[0];
  Vector3d normal = (shared[1] - origin).cross(shared[2] - origin).normalized();
  if (normal.dot(tip - origin) < 0) normal = -normal;
  const double slack = 1e-9 * (tip - origin).norm();
  const std::vector<std::uint32_t> list = std::move(triangles_[index(parent)]);
  triangles_[index(parent)] = {};
  for (const CellId child : children) triangles_[index(child)].clear();
  for (const std::uint32_t t : list) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (const Vector3d& corner : triangle(t)) {
      const double height = normal.dot(corner - origin);
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    }
    if (highest >= -slack) triangles_[index(children[0])].push_back(t);
    if (lowest <= slack) triangles_[index(children[1])].push_back(t);
  }
}

void MaterialVolume::coarsen(const VolumeTolerances& tolerances) {
  set_tolerances(tolerances);
  evaluate_leaves();
  for (const CellId leaf : mesh_.leaves_in_tree_order()) queue_merges_around(leaf);
  while (const auto least = queues_.least()) {
    queues_.forget(least->middle);
    if (mesh_.can_merge(least->middle)) take_back(least->middle);
  }
  refine(tolerances);
}

// A diamond is worth what its parents' errors were when they were leaves.
void MaterialVolume::queue_merges_around(CellId leaf) {
  if (mesh_.is_root(leaf)) return;
  const CellId parent = mesh_.parent(leaf);
  const NodeId middle = mesh_.middle(parent);
  const double worth = ratio(parent);
  if (mesh_.can_merge(middle) && worth <= 1) queues_.allow_merge(middle, worth);
}

void MaterialVolume::take_back(NodeId middle) {
  const Diamond diamond = mesh_.merge(middle);
  bool stands = true;
  for (std::size_t p = 0; p < diamond.parents.size(); ++p) {
    auto& list = triangles_[index(diamond.parents[p])];
    list.clear();
    for (const CellId child : diamond.children[p]) {
      auto& from = triangles_[index(child)];
      list.insert(list.end(), from.begin(), from.end());
      from = {};
      queues_.forget(child);
    }
    std::ranges::sort(list);
    list.erase(std::ranges::unique(list).begin(), list.end());
  }
  const std::vector<CellId> parents(diamond.parents.begin(), diamond.parents.end());
  for (const CellId parent : parents) {
    evaluate(parent);
    queue(parent);
    stands = stands && ratio(parent) <= 1;
  }
  if (!stands) {
    split_once(parents.front());
    return;  // its parents' errors are known now: it is not tried again
  }
  for (const CellId parent : parents) queue_merges_around(parent);
}

MaterialId MaterialVolume::material(NodeId node) const {
  Mask below = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    if (distance(node, InterfaceId{static_cast<std::uint8_t>(i)}) < 0) below |= Mask{1} << i;
  }
  return volume::material_at(model_.materials, below);
}

MaterialId MaterialVolume::material_at(CellId leaf, const Eigen::Vector4d& weights) const {
  Mask below = 0;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    if (distances(leaf, InterfaceId{static_cast<std::uint8_t>(i)}).dot(weights) < 0) {
      below |= Mask{1} << i;
    }
  }
  return volume::material_at(model_.materials, below);
}

std::vector<Piece> MaterialVolume::pieces(CellId leaf) const {
  struct Part {
    SubTetra tetra;
    Mask below;
  };
  Mask open = 0;
  const Mask below = vertex_sides(leaf, open);
  std::vector<Part> parts = {{SubTetra::Identity(), below}};
  std::vector<SubTetra> lower, upper;
  for (std::size_t i = 0; i < interface_count(); ++i) {
    const Mask bit = Mask{1} << i;
    if ((open & parting_[index(leaf)] & bit) == 0) continue;
    const Eigen::Vector4d d = distances(leaf, InterfaceId{static_cast<std::uint8_t>(i)});
    std::vector<Part> next;
    for (const Part& part : parts) {
      lower.clear();
      upper.clear();
      cut(part.tetra, d, lower, upper);
      for (const SubTetra& tetra : lower) next.push_back({tetra, part.below | bit});
      for (const SubTetra& tetra : upper) next.push_back({tetra, part.below});
    }
    parts = std::move(next);
  }
  std::vector<Piece> pieces;
  for (const Part& part : parts) {
    pieces.push_back({part.tetra, volume::material_at(model_.materials, part.below)});
  }
  return pieces;
}

}  // namespace terrane::hierarchy::volume
