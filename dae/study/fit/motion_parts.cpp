#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/motion_parts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MotionParts::MotionParts(const ParametricMechanism& family, VectorXd sizes)
    : family_(family), sizes_(std::move(sizes)) {
  for (const ParameterSpec& p : family.scene(family.own()).parameters)
    parameter_names_.push_back(p.name);
}

VectorXd MotionParts::parameters_at(const VectorXd& theta) const {
  const Scene scene = family_.scene(theta);
  VectorXd values(static_cast<Index>(scene.parameters.size()));
  for (Index i = 0; i < values.size(); ++i)
    values[i] = scene.parameters[static_cast<std::size_t>(i)].value;
  return values;
}

void MotionParts::take_parameters(const VectorXd& theta, bool derivatives,
                                  MotionValues& values) const {
  values.parameters = parameters_at(theta);
  if (!derivatives) return;
  values.parameters_by.setZero(values.parameters.size(), theta.size());
  for (Index j = 0; j < theta.size(); ++j) {
    const auto at = [&](std::size_t i, double h) {
      VectorXd near = theta;
      near[j] += sixth_order::k_of(i) * h;
      return parameters_at(near);
    };
    values.parameters_by.col(j) =
        sixth_order::slope_of(sixth_order::part * sizes_[j], sixth_order::read, at).by;
  }
  for (std::size_t i = 0; i < parameter_names_.size(); ++i)
    for (std::size_t j = 0; j < family_.names().size(); ++j)
      if (parameter_names_[i] == family_.names()[j])
        values.parameters_by.row(static_cast<Index>(i)) =
            VectorXd::Unit(theta.size(), static_cast<Index>(j)).transpose();
}

MotionFunction::MotionFunction(const MotionFormula& formula, MotionParts& parts)
    : parts_(formula.parts) {
  std::vector<std::string> names = parts.parameter_names();
  try {
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      places_.push_back(parts.add(parts_[k]));
      names.push_back(MotionFormula::name_of(k));
    }
    outer_ = std::make_unique<SmoothFormula>(formula.outer, names);
  } catch (const std::invalid_argument& error) {
    // Messages do not show names of parts.
    if (!parts_.empty() && formula.outer == MotionFormula::name_of(0)) throw;
    const std::string why = error.what();
    if (why.find("motion.part") == std::string::npos) throw;
    throw std::invalid_argument(
        reading::in_quotes(formula.text) +
        ": found a name that is no parameter outside of max(…), min(…), mean(…), integral(…), "
        "first(…) and last(…); expected names of a motion within them alone");
  }
}

std::vector<Index> MotionFunction::rows(const MotionValues& values) const {
  std::vector<Index> rows(parts_.size(), 0);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const VectorXd& g = values.parts[places_[k]];
    if (parts_[k].kind == MotionPart::Kind::most) g.maxCoeff(&rows[k]);
    if (parts_[k].kind == MotionPart::Kind::least) g.minCoeff(&rows[k]);
  }
  return rows;
}

double MotionFunction::at(const MotionValues& values, const std::vector<Index>& rows,
                          const VectorXd& taken, VectorXd* by_theta, VectorXd* by_parts) const {
  const Index parameters = values.parameters.size(), count = static_cast<Index>(parts_.size());
  VectorXd x(parameters + count), by;
  x.head(parameters) = values.parameters;
  const auto given = [&](Index k) { return k < taken.size() && !std::isnan(taken[k]); };
  for (Index k = 0; k < count; ++k) {
    const auto part = static_cast<std::size_t>(k);
    x[parameters + k] = given(k) ? taken[k] : values.parts[places_[part]][rows[part]];
  }
  const double f = (*outer_)(x, by_theta || by_parts ? &by : nullptr);
  if (by_parts) *by_parts = by.tail(count);
  if (by_theta) {
    *by_theta = values.parameters_by.transpose() * by.head(parameters);
    for (Index k = 0; k < count; ++k)
      if (!given(k)) {
        const auto part = static_cast<std::size_t>(k);
        *by_theta +=
            by[parameters + k] * values.parts_by[places_[part]].row(rows[part]).transpose();
      }
  }
  return f;
}

double MotionFunction::value(const MotionValues& values) const {
  return at(values, rows(values), VectorXd(), nullptr, nullptr);
}

std::vector<std::size_t> MotionFunction::bounded(const MotionValues& values) const {
  VectorXd by;
  at(values, rows(values), VectorXd(), nullptr, &by);
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const double slope = by[static_cast<Index>(k)];
    if (parts_[k].is_extreme() && values.parts[places_[k]].size() > 1 &&
        (parts_[k].kind == MotionPart::Kind::most ? slope > 0 : slope < 0))
      all.push_back(k);
  }
  return all;
}

using Eigen::MatrixXd;
using Eigen::VectorXd;

RunParts::RunParts(const ParametricMechanism& family, VectorXd sizes, SceneText scene,
                   RunSettings settings)
    : MotionParts(family, std::move(sizes)),
      scene_(std::move(scene)),
      settings_(std::move(settings)) {}

std::size_t RunParts::add(const MotionPart& part) {
  if (part.is_extreme() || part.kind == MotionPart::Kind::first)
    throw std::invalid_argument(
        reading::in_quotes(part.formula) +
        ": of a run no largest, smallest or first value is taken, as these have no gradient here; "
        "expected integral(…), mean(…) or last(…), a large power in integral(…) in place of "
        "max(…), or a motion by --sweep");
  // A run's derivative takes formulas of varied parameters as constants.
  const std::vector<std::string>& names = parameter_names();
  const VectorXd theta = family_.own();
  MotionValues values;
  take_parameters(theta, true, values);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool varied = std::find(family_.names().begin(), family_.names().end(), names[i]) !=
                        family_.names().end();
    if (varied || values.parameters_by.row(static_cast<Eigen::Index>(i)).isZero()) continue;
    std::size_t at = part.formula.find(names[i]);
    const auto in_name = [&](std::size_t k) {
      return k < part.formula.size() &&
             (std::isalnum(static_cast<unsigned char>(part.formula[k])) || part.formula[k] == '_' ||
              part.formula[k] == '.');
    };
    for (; at != std::string::npos; at = part.formula.find(names[i], at + 1))
      if ((at == 0 || !in_name(at - 1)) && !in_name(at + names[i].size()))
        throw std::invalid_argument(reading::in_quotes(part.formula) + ": parameter " +
                                    reading::in_quotes(names[i]) +
                                    " is a formula of what is varied, whose derivative a run does "
                                    "not take; expected that formula in its place");
  }
  parts_.push_back(part);
  return parts_.size() - 1;
}

bool RunParts::at(const VectorXd& theta, bool derivatives, MotionValues& values) {
  try {
    take_parameters(theta, derivatives, values);
    SceneText scene = scene_;
    for (std::size_t j = 0; j < family_.names().size(); ++j)
      scene.fixed.push_back({family_.names()[j], theta[static_cast<Eigen::Index>(j)]});
    values.parts.clear();
    values.parts_by.clear();
    for (const MotionPart& part : parts_) {
      GradientRequest request;
      request.of = part.formula;
      request.integral = part.kind != MotionPart::Kind::last;
      request.by = family_.names();
      request.settings = settings_;
      request.progress = limit_.next();
      const GradientResult result = gradient(scene, request);
      limit_.arrived();
      const double over = part.kind == MotionPart::Kind::mean ? result.end_time : 1;
      values.parts.push_back(VectorXd::Constant(1, result.value / over));
      values.parts_by.push_back(result.gradient.transpose() / over);
      for (const std::string& remark : result.remarks)
        if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end())
          remarks_.push_back(remark);
    }
    return true;
  } catch (const SceneError& error) {
    why_ = error.what();
    return false;
  }
}

}  // namespace momenta
