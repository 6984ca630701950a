#include "hierarchy/merge/normal_code.h"

#include <cmath>

namespace terrane::hierarchy {
namespace {

constexpr double kOctahedralSteps = 32767;

}  // namespace

std::uint32_t encoded_normal(const Eigen::Vector3d& unit) {
  const Eigen::Vector3d n = unit / unit.cwiseAbs().sum();
  double x = n.x(), y = n.y();
  if (n.z() < 0) {
    x = (1 - std::abs(n.y())) * (n.x() < 0 ? -1 : 1);
    y = (1 - std::abs(n.x())) * (n.y() < 0 ? -1 : 1);
  }
  const auto code = [](double value) {
    return static_cast<std::uint32_t>(std::lround((value + 1) * kOctahedralSteps));
  };
  return code(x) << 16 | code(y);
}

Eigen::Vector3f decoded_normal(std::uint32_t code) {
  double x = (code >> 16) / kOctahedralSteps - 1, y = (code & 0xffff) / kOctahedralSteps - 1;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) {
    const double old = x;
    x = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    y = (1 - std::abs(old)) * (y < 0 ? -1 : 1);
  }
  return Eigen::Vector3d(x, y, z).normalized().cast<float>();
}

}  // namespace terrane::hierarchy
