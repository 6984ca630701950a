#include "model/field_over_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/errors.h"

namespace terrane::model {

PostRange posts_around(const std::vector<double>& axis, double low, double high) {
  auto first = std::upper_bound(axis.begin(), axis.end(), low);
  if (first != axis.begin()) --first;
  auto end = std::lower_bound(axis.begin(), axis.end(), high);
  if (end != axis.end()) ++end;
  // a box beyond one end needs the last cell
  if (end - first < 2 && first != axis.begin()) --first;
  if (end - first < 2) ++end;
  return {static_cast<std::size_t>(first - axis.begin()), static_cast<std::size_t>(end - first)};
}

void check_reach(const std::string& name, const std::array<std::vector<double>, 3>& axes,
                 const hierarchy::volume::Box& box, Progress& progress) {
  for (int k = 0; k < 3; ++k) {
    const auto& axis = axes[static_cast<std::size_t>(k)];
    // written so that NaN is refused, too
    const bool rises = std::ranges::adjacent_find(axis, [](double a, double b) {
                         return !(a < b);
                       }) == axis.end();
    if (axis.size() < 2 || !rises || !std::isfinite(axis.front()) || !std::isfinite(axis.back())) {
      throw InputError(
          fmt::format("{}: needs two posts or more along {}, in rising order", name, "xyz"[k]));
    }
    if (axis.back() < box.low[k] || axis.front() > box.high[k]) {
      throw InputError(fmt::format(
          "{}: lies at {} {:.6g} to {:.6g} m, outside the box ({:.6g} to {:.6g} m). Move one of them",
          name, "xyz"[k], axis.front(), axis.back(), box.low[k], box.high[k]));
    }
    const double first_cell = axis[1] - axis[0];
    const double last_cell = axis[axis.size() - 1] - axis[axis.size() - 2];
    if (axis.front() - first_cell > box.low[k] || axis.back() + last_cell < box.high[k]) {
      progress.note(fmt::format(
          "{}: reaches from {} {:.6g} to {:.6g} m of the box's {:.6g} to {:.6g} m; beyond, the "
          "values at its ends go on",
          name, "xyz"[k], axis.front(), axis.back(), box.low[k], box.high[k]));
    }
  }
}

}  // namespace terrane::model
