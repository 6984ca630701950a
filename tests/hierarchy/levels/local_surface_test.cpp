#include "hierarchy/levels/local_surface.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

namespace terrane::hierarchy {
namespace {

/// The points of a height function over a square of (2 n + 1)^2 places about the origin.
template <class Height>
std::optional<LocalSurface> fit(int n, double spacing, Height height) {
  SurfaceFitter fitter;
  for (int i = -n; i <= n; ++i) {
    for (int j = -n; j <= n; ++j) {
      const double u = i * spacing, v = j * spacing;
      fitter.add({u, v, height(u, v)});
    }
  }
  return fitter.fit();
}

TEST(LocalSurface, CurvatureOfASphereIsTwiceItsInverseRadius) {
  const auto surface =
      fit(2, 0.5, [](double u, double v) { return std::sqrt(1e4 - u * u - v * v) - 100; });
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->absolute_curvature(), 2.0 / 100, 1e-5);
}

TEST(LocalSurface, CurvatureOfASaddleAddsBothBends) {
  // z = u^2 / 2 a - v^2 / 2 b bends by 1/a and -1/b
  const auto surface =
      fit(2, 1, [](double u, double v) { return u * u / (2 * 50) - v * v / (2 * 20); });
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->absolute_curvature(), 1.0 / 50 + 1.0 / 20, 1e-12);
}

TEST(LocalSurface, CurvatureOfATiltedPlaneIsZero) {
  const auto surface = fit(2, 3, [](double u, double v) { return 0.7 * u - 2 * v + 5; });
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->absolute_curvature(), 0, 1e-12);
}

TEST(LocalSurface, CurvatureOfACylinderOnItsSideIsTheSameWhateverItsTilt) {
  // the curvature belongs to the surface, not to the plane that it is seen from
  const double radius = 40, tilt = 0.4;
  const auto cylinder = [&](double u, double) {
    const double from_axis = u + radius * std::sin(tilt);
    return std::sqrt(radius * radius - from_axis * from_axis) - radius * std::cos(tilt);
  };
  const auto surface = fit(2, 0.05, cylinder);
  ASSERT_TRUE(surface);
  EXPECT_NEAR(surface->absolute_curvature(), 1 / radius, 1e-5);
}

TEST(LocalSurface, RefusesSixPointsOnACircleAndFewerThanSix) {
  SurfaceFitter fitter;
  for (int i = 0; i < 6; ++i) fitter.add({std::cos(i), std::sin(i), i % 2 == 0 ? 1.0 : 0.0});
  EXPECT_FALSE(fitter.fit());
  fitter.clear();
  for (int i = 0; i < 5; ++i) fitter.add({i * 1.0, i * i * 0.3, 1});
  EXPECT_FALSE(fitter.fit());
}

TEST(LocalSurface, RefusesPointsThatAreNearlyOnAConic) {
  // posts on two lines of a grid, turned a little out of them: like those that made a vertex of St.
  // Helens fall 266 m under its neighbours
  SurfaceFitter fitter;
  for (int i = 0; i < 13; ++i) {
    const double u = 20.0 * i - 120, tremble = 1e-3 * (i % 3);
    fitter.add({u, (i % 2 == 0 ? 10 : -10) + tremble, i % 4 == 0 ? 1.0 : 0.0});
  }
  EXPECT_FALSE(fitter.fit());
  fitter.add({15, 60, 0});
  fitter.add({-15, -60, 0});
  EXPECT_TRUE(fitter.fit());
}

TEST(LocalSurface, AgreesWithEigensPivotedQrOnRandomStencils) {
  std::mt19937 random(1);
  const auto number = [&] { return static_cast<double>(random() % 20001) / 10000 - 1; };
  for (int run = 0; run < 200; ++run) {
    const int count = 8 + static_cast<int>(random() % 60);
    const double scale = std::pow(10, static_cast<int>(random() % 7) - 3);
    Eigen::MatrixXd A(count, 6);
    Eigen::VectorXd d(count);
    SurfaceFitter fitter;
    for (int i = 0; i < count; ++i) {
      const double u = scale * number(), v = scale * number();
      d[i] = number();
      A.row(i) << u * u, u * v, v * v, u, v, 1;
      fitter.add({u, v, d[i]});
    }
    const Eigen::VectorXd x = A.colPivHouseholderQr().solve(d);
    const auto surface = fitter.fit();
    ASSERT_TRUE(surface);
    for (int i = 0; i < 10; ++i) {
      const double u = scale * number(), v = scale * number();
      const double expected =
          x[0] * u * u + x[1] * u * v + x[2] * v * v + x[3] * u + x[4] * v + x[5];
      EXPECT_NEAR(surface->at(u, v), expected, 1e-9 * (1 + std::abs(expected)));
    }
  }
}

TEST(LocalSurface, EdgeErrorIsTheLargestDistanceAlongTheEdge) {
  const LocalSurface surface(0.3, -0.2, 0.5, 0.1, -0.4, 0.2);
  std::mt19937 random(2);
  const auto number = [&] { return static_cast<double>(random() % 4001) / 1000 - 2; };
  for (int run = 0; run < 100; ++run) {
    const Eigen::Vector3d a(number(), number(), number()), b(number(), number(), number());
    double sampled = 0;
    for (int i = 0; i <= 10000; ++i) {
      const Eigen::Vector3d p = a + (b - a) * (i / 10000.0);
      sampled = std::max(sampled, std::abs(surface.at(p.x(), p.y()) - p.z()));
    }
    EXPECT_NEAR(surface.edge_error(a, b), sampled, 1e-6);
    EXPECT_GE(surface.edge_error(a, b), sampled - 1e-12);
  }
}

TEST(LocalSurface, DistanceAlongALineEndsOnTheGraph) {
  const LocalSurface surface(0.03, -0.02, 0.05, 0.1, -0.4, 0.2);
  const Eigen::Vector3d from(1, -2, 0), direction(0.3, -0.1, 0.9);
  const Eigen::Vector3d hit = from + surface.distance_along(from, direction) * direction;
  EXPECT_NEAR(surface.at(hit.x(), hit.y()), hit.z(), 1e-12);
}

TEST(TriangleFrame, HasItsOriginInTheCentroidAndTheTriangleInItsPlane) {
  const Eigen::Vector3d a(1, 2, 3), b(4, 0, 5), c(2, 2, 9);
  const auto frame = TriangleFrame::of(a, b, c);
  ASSERT_TRUE(frame);
  EXPECT_NEAR((frame->to_local((a + b + c) / 3)).norm(), 0, 1e-12);
  for (const Eigen::Vector3d& p : {a, b, c}) {
    EXPECT_NEAR(frame->to_local(p).z(), 0, 1e-12);
    EXPECT_NEAR((frame->to_world(frame->to_local(p)) - p).norm(), 0, 1e-12);
  }
  EXPECT_GT((b - a).cross(c - a).dot(frame->normal()), 0);
  EXPECT_FALSE(TriangleFrame::of(a, a + (b - a), a + 2 * (b - a)));
}

}  // namespace
}  // namespace terrane::hierarchy
