#include "model/formula_field.h"

#include <fmt/format.h>
#include <muParser.h>

#include "core/errors.h"

namespace terrane::model {

std::shared_ptr<const hierarchy::volume::Field> formula_field(
    const std::string& name, const std::string& formula, const hierarchy::volume::Box& box, const std::array<int, 3>& samples) {
  std::array<std::vector<double>, 3> axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (samples[axis] < 2 || samples[axis] > 1000) {
      throw ConfigError(
          fmt::format("field {}: {} samples along an axis. Give 2 to 1000", name, samples[axis]));
    }
    for (int i = 0; i < samples[axis]; ++i) {
      axes[axis].push_back(box.low[axis] + box.size()[axis] * i / (samples[axis] - 1));
    }
  }
  std::vector<double> values;
  double x = 0, y = 0, z = 0;
  mu::Parser parser;
  parser.DefineVar("x", &x);
  parser.DefineVar("y", &y);
  parser.DefineVar("z", &z);
  try {
    parser.SetExpr(formula.empty() ? "0" : formula);
    for (const double c : axes[2]) {
      for (const double b : axes[1]) {
        for (const double a : axes[0]) {
          x = a;
          y = b;
          z = c;
          values.push_back(parser.Eval());
        }
      }
    }
  } catch (const mu::Parser::exception_type& error) {
    throw ConfigError(fmt::format("field {}: '{}' is no formula of x, y and z ({})", name, formula,
                                  error.GetMsg()));
  }
  try {
    return std::make_shared<hierarchy::volume::GridField>(
        std::move(axes), std::vector<std::vector<double>>{std::move(values)});
  } catch (const InputError& error) {
    throw InputError(fmt::format("field {}: {}", name, error.what()));
  }
}

}  // namespace terrane::model
