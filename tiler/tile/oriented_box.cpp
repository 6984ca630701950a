#include "tiler/tile/oriented_box.h"

namespace terrane::tiler {

void OrientedBox::add(const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = axes.transpose() * point;
  low = low.cwiseMin(along);
  high = high.cwiseMax(along);
}

void OrientedBox::add(const OrientedBox& box) {
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d along((corner & 1) ? box.low.x() : box.high.x(),
                                (corner & 2) ? box.low.y() : box.high.y(),
                                (corner & 4) ? box.low.z() : box.high.z());
    add(box.axes * along);
  }
}

std::array<double, 12> OrientedBox::numbers() const {
  std::array<double, 12> numbers;
  Eigen::Map<Eigen::Vector3d>(numbers.data()) = centre();
  Eigen::Map<Eigen::Matrix3d>(numbers.data() + 3) = axes * ((high - low) / 2).asDiagonal();
  return numbers;
}

}  // namespace terrane::tiler
