#include "hierarchy/mesh/boundary_vertices.h"

namespace terrane::hierarchy {
namespace {

/// A different number for each vertex, of no pattern (the finalizer of MurmurHash3).
std::uint64_t scattered(std::uint64_t vertex) {
  vertex = (vertex + 1) * 0x9e3779b97f4a7c15U;
  vertex = (vertex ^ (vertex >> 33)) * 0xff51afd7ed558ccdU;
  vertex = (vertex ^ (vertex >> 33)) * 0xc4ceb9fe1a85ec53U;
  return vertex ^ (vertex >> 33);
}

}  // namespace

std::vector<bool> boundary_vertices(std::size_t vertex_count, std::span<const Corners> triangles) {
  // around an inner vertex each neighbour is once the next corner of a triangle and once the one
  // before: what is added is taken away again
  std::vector<std::uint64_t> balance(vertex_count, 0);
  for (const auto& [a, b, c] : triangles) {
    const std::uint64_t at_a = scattered(a), at_b = scattered(b), at_c = scattered(c);
    balance[a] += at_b - at_c;
    balance[b] += at_c - at_a;
    balance[c] += at_a - at_b;
  }
  std::vector<bool> is_boundary(vertex_count);
  for (std::size_t v = 0; v < vertex_count; ++v) is_boundary[v] = balance[v] != 0;
  return is_boundary;
}

}  // namespace terrane::hierarchy
