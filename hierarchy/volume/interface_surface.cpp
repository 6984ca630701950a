#include "hierarchy/volume/interface_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "hierarchy/volume/triangle_intersection.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
constexpr std::uint32_t kNobody = ~std::uint32_t{0};
constexpr std::uint32_t kTrianglesOfALeaf = 4;

struct Edge {
  std::uint32_t from, to, triangle, side;  ///< from < to
  bool is_reversed;
  auto key() const { return std::pair(from, to); }
};

std::vector<Edge> sorted_edges(const SurfaceMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, k, a > b});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tuple(a.from, a.to, a.triangle) < std::tuple(b.from, b.to, b.triangle);
  });
  return edges;
}

double squared_distance_to_box(const Vector3d& p, const Vector3d& low, const Vector3d& high) {
  return (low - p).cwiseMax(p - high).cwiseMax(0).squaredNorm();
}

/// Whether a segment comes into the inside of a box.
bool enters(const Vector3d& a, const Vector3d& b, const Box& box) {
  double first = 0, last = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = a[axis], step = b[axis] - a[axis];
    if (step == 0) {
      if (from <= box.low[axis] || from >= box.high[axis]) return false;
      continue;
    }
    double in = (box.low[axis] - from) / step, out = (box.high[axis] - from) / step;
    if (in > out) std::swap(in, out);
    first = std::max(first, in);
    last = std::min(last, out);
  }
  return first < last;
}

double plan_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x())) / 2;
}

}  // namespace

InterfaceSurface::InterfaceSurface(std::string name, SurfaceMesh mesh, SideRule side,
                                   const Box& box)
    : name_(std::move(name)), mesh_(std::move(mesh)), side_(side) {
  check_numbers();
  find_neighbours();
  order_.resize(mesh_.triangles.size());
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vector3d> centres;
  for (std::uint32_t t = 0; t < order_.size(); ++t) {
    const auto c = corners(t);
    centres.push_back((c[0] + c[1] + c[2]) / 3);
  }
  build_tree(0, static_cast<std::uint32_t>(order_.size()), centres);
  const TreeNode& all = tree_.front();
  if ((all.low.array() >= box.high.array()).any() || (all.high.array() <= box.low.array()).any()) {
    throw InputError(
        fmt::format("{}: lies from {} to {}, outside the box from {} to {}. Move the "
                    "box, or leave the surface out",
                    name_, place(all.low), place(all.high), place(box.low), place(box.high)));
  }
  check_ends(box);
  if (side_ == SideRule::kVertical) {
    check_plan();
  } else {
    check_self_intersections();
  }
  compute_normals();
}

std::string InterfaceSurface::place(const Vector3d& p) const {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

std::array<Vector3d, 3> InterfaceSurface::corners(std::uint32_t triangle) const {
  const auto& t = mesh_.triangles[triangle];
  return {mesh_.points[t[0]], mesh_.points[t[1]], mesh_.points[t[2]]};
}

void InterfaceSurface::check_numbers() const {
  if (mesh_.triangles.empty()) {
    throw InputError(fmt::format("{}: has no triangles. Give a triangle mesh", name_));
  }
  for (std::size_t i = 0; i < mesh_.points.size(); ++i) {
    if (!mesh_.points[i].allFinite()) {
      throw InputError(
          fmt::format("{}: vertex {} has a coordinate that is no number. Mend it, or "
                      "leave its triangles out",
                      name_, i));
    }
  }
}

void InterfaceSurface::find_neighbours() {
  across_.assign(mesh_.triangles.size(), {kNobody, kNobody, kNobody});
  const std::vector<Edge> edges = sorted_edges(mesh_);
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end].key() == edges[i].key()) ++end;
    const Vector3d at = (mesh_.points[edges[i].from] + mesh_.points[edges[i].to]) / 2;
    if (end - i > 2) {
      throw InputError(
          fmt::format("{}: {} triangles meet at the edge at {}. Split it into surfaces "
                      "whose edges have at most two",
                      name_, end - i, place(at)));
    }
    if (end - i == 2) {
      if (edges[i].is_reversed == edges[i + 1].is_reversed) {
        throw InputError(
            fmt::format("{}: the two triangles at {} have normals to different sides. "
                        "Orient the mesh",
                        name_, place(at)));
      }
      across_[edges[i].triangle][edges[i].side] = edges[i + 1].triangle;
      across_[edges[i + 1].triangle][edges[i + 1].side] = edges[i].triangle;
    }
    i = end;
  }
}

void InterfaceSurface::check_ends(const Box& box) const {
  for (std::uint32_t t = 0; t < across_.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (across_[t][k] != kNobody) continue;
      const auto c = corners(t);
      if (enters(c[k], c[(k + 1) % 3], box)) {
        throw InputError(
            fmt::format("{}: is open: it ends inside the box, near {}. Close the "
                        "mesh, or make the box smaller",
                        name_, place((c[k] + c[(k + 1) % 3]) / 2)));
      }
    }
  }
}

void InterfaceSurface::check_plan() const {
  for (std::uint32_t t = 0; t < across_.size(); ++t) {
    const auto c = corners(t);
    if (!(plan_area(c[0], c[1], c[2]) > 0)) {
      throw InputError(
          fmt::format("{}: the triangle at {} is upright or overhangs. Give heights "
                      "that are a function of the place in plan",
                      name_, place(c[0])));
    }
  }
}

void InterfaceSurface::check_self_intersections() const {
  for (std::uint32_t t = 0; t < across_.size(); ++t) {
    const auto mine = corners(t);
    const Vector3d low = mine[0].cwiseMin(mine[1]).cwiseMin(mine[2]);
    const Vector3d high = mine[0].cwiseMax(mine[1]).cwiseMax(mine[2]);
    const auto overlaps = [&](const TreeNode& node) {
      return (node.low.array() <= high.array()).all() && (node.high.array() >= low.array()).all();
    };
    visit_all(overlaps, [&](std::uint32_t other) {
      if (other <= t) return;
      for (const std::uint32_t a : mesh_.triangles[t]) {
        for (const std::uint32_t b : mesh_.triangles[other]) {
          // neighbours touch; that they do not cross is not looked at
          if (mesh_.points[a] == mesh_.points[b]) return;
        }
      }
      if (const auto at = crossing(mine, corners(other))) {
        throw InputError(
            fmt::format("{}: intersects itself at {}. Mend the mesh", name_, place(*at)));
      }
    });
  }
}

void InterfaceSurface::compute_normals() {
  vertex_normals_.assign(mesh_.points.size(), Vector3d::Zero());
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    const auto c = corners(t);
    const Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    for (int k = 0; k < 3; ++k) {
      const Vector3d a = c[(k + 1) % 3] - c[k], b = c[(k + 2) % 3] - c[k];
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      vertex_normals_[mesh_.triangles[t][k]] += angle * normal;
    }
  }
}

// A tree of boxes: halves by the middle triangle along the longest side of the centres' box.
std::uint32_t InterfaceSurface::build_tree(std::uint32_t begin, std::uint32_t end,
                                           const std::vector<Vector3d>& centres) {
  const auto id = static_cast<std::uint32_t>(tree_.size());
  TreeNode node;
  node.begin = begin;
  node.end = end;
  node.low.setConstant(std::numeric_limits<double>::infinity());
  node.high = -node.low;
  Vector3d low = node.low, high = node.high;
  for (std::uint32_t i = begin; i < end; ++i) {
    for (const Vector3d& corner : corners(order_[i])) {
      node.low = node.low.cwiseMin(corner);
      node.high = node.high.cwiseMax(corner);
    }
    low = low.cwiseMin(centres[order_[i]]);
    high = high.cwiseMax(centres[order_[i]]);
  }
  tree_.push_back(node);
  if (end - begin <= kTrianglesOfALeaf) return id;
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double u = centres[a][axis], v = centres[b][axis];
                     return u != v ? u < v : a < b;
                   });
  build_tree(begin, middle, centres);
  const std::uint32_t right = build_tree(middle, end, centres);
  tree_[id].right = right;
  return id;
}

// `squared_distance` says how near a node can be, `visit` returns the best distance so far.
template <class Distance, class Visit>
void InterfaceSurface::visit_nearest_first(const Distance& squared_distance,
                                           const Visit& visit) const {
  struct Open {
    std::uint32_t node;
    double distance;
  };
  std::array<Open, 128> stack;  // a balanced tree of 2^32 triangles is 32 deep
  int size = 0;
  double best = std::numeric_limits<double>::infinity();
  stack[size++] = {0, squared_distance(tree_[0])};
  while (size > 0) {
    const Open open = stack[--size];
    if (open.distance > best) continue;
    const TreeNode& node = tree_[open.node];
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) best = visit(order_[i]);
      continue;
    }
    Open left{open.node + 1, squared_distance(tree_[open.node + 1])};
    Open right{node.right, squared_distance(tree_[node.right])};
    if (left.distance < right.distance) std::swap(left, right);
    stack[size++] = left;
    stack[size++] = right;
  }
}

template <class Overlaps, class Visit>
void InterfaceSurface::visit_all(const Overlaps& overlaps, const Visit& visit) const {
  std::array<std::uint32_t, 128> stack;
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t id = stack[--size];
    const TreeNode& node = tree_[id];
    if (!overlaps(node)) continue;
    if (node.right == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) visit(order_[i]);
      continue;
    }
    stack[size++] = id + 1;
    stack[size++] = node.right;
  }
}

NearestTriangle InterfaceSurface::nearest_triangle(const Vector3d& p) const {
  NearestTriangle best;
  best.at.squared_distance = std::numeric_limits<double>::infinity();
  visit_nearest_first(
      [&](const TreeNode& node) { return squared_distance_to_box(p, node.low, node.high); },
      [&](std::uint32_t t) {
        const ClosestPoint at = closest_point(p, corners(t));
        const bool is_nearer =
            at.squared_distance < best.at.squared_distance ||
            (at.squared_distance == best.at.squared_distance && t < best.triangle);
        if (is_nearer) best = {at, t};
        return best.at.squared_distance;
      });
  return best;
}

ClosestPoint InterfaceSurface::nearest(const Vector3d& p) const { return nearest_triangle(p).at; }

std::uint32_t InterfaceSurface::nearest_vertex(const Vector3d& p) const {
  std::uint32_t best = kNobody;
  double distance = std::numeric_limits<double>::infinity();
  visit_nearest_first(
      [&](const TreeNode& node) { return squared_distance_to_box(p, node.low, node.high); },
      [&](std::uint32_t t) {
        for (const std::uint32_t v : mesh_.triangles[t]) {
          const double d = (mesh_.points[v] - p).squaredNorm();
          if (d < distance || (d == distance && v < best)) {
            distance = d;
            best = v;
          }
        }
        return distance;
      });
  return best;
}

// Baerentzen and Aanaes 2005: the sign is right everywhere if corners weigh the normals around them
// by angle and edges take both.
Vector3d InterfaceSurface::normal_at(const NearestTriangle& nearest) const {
  if (nearest.at.feature < 3) {
    return vertex_normals_[mesh_.triangles[nearest.triangle][nearest.at.feature]];
  }
  const auto unit_normal = [&](std::uint32_t t) -> Vector3d {
    const auto c = corners(t);
    return (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  };
  Vector3d normal = unit_normal(nearest.triangle);
  if (nearest.at.feature < 6) {
    const std::uint32_t other = across_[nearest.triangle][nearest.at.feature - 3];
    if (other != kNobody) normal += unit_normal(other);
  }
  return normal;
}

std::optional<double> InterfaceSurface::height(double x, double y) const {
  std::optional<double> height;
  double best = -1e-9;  // a place on an edge must not fall between two triangles by rounding
  const auto overlaps = [&](const TreeNode& node) {
    return node.low.x() <= x && x <= node.high.x() && node.low.y() <= y && y <= node.high.y();
  };
  visit_all(overlaps, [&](std::uint32_t t) {
    const auto c = corners(t);
    const Vector3d p(x, y, 0);
    const double area = plan_area(c[0], c[1], c[2]);
    const double u = plan_area(p, c[1], c[2]) / area, v = plan_area(c[0], p, c[2]) / area;
    const double inside = std::min({u, v, 1 - u - v});
    if (inside < best) return;
    best = inside;
    height = u * c[0].z() + v * c[1].z() + (1 - u - v) * c[2].z();
  });
  return height;
}

bool InterfaceSurface::is_under(const Vector3d& p, const NearestTriangle& nearest) const {
  const auto surface = height(p.x(), p.y());
  // beyond its rim, which lies outside the box, the surface goes on level
  return p.z() < surface.value_or(nearest.at.point.z());
}

bool InterfaceSurface::is_below(const Vector3d& p, const NearestTriangle& nearest) const {
  if (side_ == SideRule::kVertical) return is_under(p, nearest);
  return (p - nearest.at.point).dot(normal_at(nearest)) < 0;
}

double InterfaceSurface::signed_distance(const Vector3d& p, DistanceRule rule) const {
  if (rule == DistanceRule::kNearestVertex) {
    const std::uint32_t v = nearest_vertex(p);
    const Vector3d away = p - mesh_.points[v];
    return away.dot(vertex_normals_[v]) < 0 ? -away.norm() : away.norm();
  }
  const NearestTriangle found = nearest_triangle(p);
  const double distance = std::sqrt(found.at.squared_distance);
  return is_below(p, found) ? -distance : distance;
}

}  // namespace terrane::hierarchy::volume
