#include <momenta/core/text/near_name.h>
#include <momenta/dae/fit/run_parts.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {

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
      const GradientResult result = gradient(scene, request);
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
