#include "model/section_svg.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace terrane::model {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace hierarchy::volume;

// rock, water, air and more: told apart in grey, too
constexpr std::array<const char*, 8> kMaterialColours = {
    "#8a6d4b", "#3d7fc1", "#e8f0f5", "#c9a227", "#6b8e4e", "#a34a3f", "#7d5fa6", "#4f5b66"};

/// Blue over white to red.
std::string field_colour(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const double red = t < 0.5 ? 0.2 + 1.6 * t : 1.0;
  const double blue = t < 0.5 ? 1.0 : 1.0 - 1.6 * (t - 0.5);
  const double green = 1.0 - 1.5 * std::abs(t - 0.5);
  const auto byte = [](double v) { return static_cast<int>(std::lround(255 * v)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(red), byte(green), byte(blue));
}

/// From the plane to the picture.
class Projection {
 public:
  Projection(const Box& box, const SectionPicture& picture)
      : right_(Vector3d::UnitZ().cross(picture.plane.normal).normalized()),
        stretch_(picture.upward_stretch) {
    if (right_.x() < -1e-12 || (std::abs(right_.x()) <= 1e-12 && right_.y() < 0)) right_ = -right_;
    Vector2d low(1e300, 1e300), high = -low;
    for (int k = 0; k < 8; ++k) {
      const Vector3d corner((k & 1) != 0 ? box.high.x() : box.low.x(),
                            (k & 2) != 0 ? box.high.y() : box.low.y(),
                            (k & 4) != 0 ? box.high.z() : box.low.z());
      low = low.cwiseMin(raw(corner));
      high = high.cwiseMax(raw(corner));
    }
    origin_ = low;
    scale_ = picture.width_px / (high - low).x();
    size = scale_ * (high - low);
  }

  Vector2d operator()(const Vector3d& p) const {
    const Vector2d at = scale_ * (raw(p) - origin_);
    return {at.x(), size.y() - at.y()};
  }

  Vector2d size;  ///< of the picture, in pixels

 private:
  Vector2d raw(const Vector3d& p) const { return {right_.dot(p), stretch_ * p.z()}; }

  Vector3d right_;
  double stretch_, scale_ = 1;
  Vector2d origin_;
};

std::string path_of(const std::array<Vector3d, 3>& triangle, const Projection& project) {
  const Vector2d a = project(triangle[0]), b = project(triangle[1]), c = project(triangle[2]);
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z", a.x(), a.y(), b.x(), b.y(),
                     c.x(), c.y());
}

// thirds of triangles: a colour per triangle would hide how the field runs in it
void draw_field(const SectionTriangle& triangle, const SectionPicture& picture,
                const Projection& project, std::string& svg, int depth) {
  const auto& v = triangle.values[static_cast<std::size_t>(picture.field)];
  const double span = picture.highest - picture.lowest;
  const auto [low, high] = std::ranges::minmax(v);
  if (depth == 0 || high - low < span / 32) {
    const std::string colour = field_colour(((v[0] + v[1] + v[2]) / 3 - picture.lowest) / span);
    svg += fmt::format("<path d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\".4\"/>\n",
                       path_of(triangle.points, project), colour, colour);
    return;
  }
  SectionTriangle part = triangle;
  auto& values = part.values[static_cast<std::size_t>(picture.field)];
  const auto middle = [&](int a, int b) -> Vector3d {
    return (triangle.points[a] + triangle.points[b]) / 2;
  };
  const std::array<Vector3d, 3> m = {middle(0, 1), middle(1, 2), middle(2, 0)};
  const std::array<double, 3> u = {(v[0] + v[1]) / 2, (v[1] + v[2]) / 2, (v[2] + v[0]) / 2};
  for (int k = 0; k < 3; ++k) {
    part.points = {triangle.points[k], m[k], m[(k + 2) % 3]};
    values = {v[k], u[k], u[(k + 2) % 3]};
    draw_field(part, picture, project, svg, depth - 1);
  }
  part.points = m;
  values = u;
  draw_field(part, picture, project, svg, depth - 1);
}

}  // namespace

const char* material_colour(MaterialId material) {
  return kMaterialColours[index(material) % kMaterialColours.size()];
}

std::string section_svg(const MaterialVolume& volume, const SectionPicture& picture) {
  const Projection project(volume.mesh().box(), picture);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      project.size.x(), project.size.y());
  constexpr int kHalvings = 5;
  for (const SectionTriangle& triangle : cut_section(volume, picture.plane)) {
    if (picture.field >= 0) {
      draw_field(triangle, picture, project, svg, kHalvings);
      continue;
    }
    const char* colour = material_colour(triangle.material);
    svg += fmt::format("<path d=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\".4\"/>\n",
                       path_of(triangle.points, project), colour, colour);
  }
  if (picture.shows_mesh) {
    svg += "<path fill=\"none\" stroke=\"#000\" stroke-width=\".5\" stroke-opacity=\".6\" d=\"";
    for (const auto& [from, to] : cut_mesh(volume, picture.plane)) {
      const Vector2d a = project(from), b = project(to);
      svg += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x(), a.y(), b.x(), b.y());
    }
    svg += "\"/>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace terrane::model
