#include <momenta/dae/study/fit/measured_error.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MeasuredError::MeasuredError(const ParametricMechanism& family, const SceneText& scene,
                             RunSettings settings, const MeasuredMotion& measured)
    : family_(family),
      scene_(scene),
      settings_(std::move(settings)),
      measured_(measured),
      weights_(VectorXd::Ones(measured.values.cols())) {
  std::map<std::string, double> ranges;  // by unit
  for (Index k = 0; k < measured.values.cols(); ++k) {
    double least = INFINITY, most = -INFINITY;
    for (const double y : measured.values.col(k))
      if (!std::isnan(y)) least = std::min(least, y), most = std::max(most, y);
    double& range = ranges[measured.quantities[static_cast<std::size_t>(k)].unit];
    if (most > least) range = std::max(range, most - least);
  }
  for (Index k = 0; k < weights_.size(); ++k)
    if (const double range = ranges[measured.quantities[static_cast<std::size_t>(k)].unit];
        range > 0)
      weights_[k] = range;
}

bool MeasuredError::evaluate(const VectorXd& theta, VectorXd& r, MatrixXd* jacobian) {
  if (theta_.size() == 0 || theta != theta_) try {
      theta_.resize(0);
      SceneText scene = scene_;
      for (std::size_t j = 0; j < family_.names().size(); ++j)
        scene.fixed.push_back({family_.names()[j], theta[static_cast<Index>(j)]});
      GradientRequest request;
      request.by = family_.names();
      for (const Column& quantity : measured_.quantities) request.outputs.push_back(quantity.name);
      request.times = measured_.times;
      request.settings = settings_;
      request.progress = limit_.next();
      ++runs_;
      const GradientResult run = gradient(scene, request);
      limit_.arrived();
      for (const std::string& remark : run.remarks)
        if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end())
          remarks_.push_back(remark);
      r_.resize(measured_.count());
      jacobian_.resize(r_.size(), theta.size());
      Index n = 0;
      for (Index i = 0; i < measured_.values.rows(); ++i)
        for (Index k = 0; k < measured_.values.cols(); ++k) {
          if (std::isnan(measured_.values(i, k))) continue;
          r_[n] = (run.outputs(i, k) - measured_.values(i, k)) / weights_[k];
          jacobian_.row(n++) = run.output_slopes[static_cast<std::size_t>(i)].row(k) / weights_[k];
        }
      if (!r_.allFinite() || !jacobian_.allFinite()) {
        why_ = "what was measured has no finite value or derivative in the run";
        return false;
      }
      reached_ = run.outputs;
      settings_ = run.settings;
      theta_ = theta;
    } catch (const SceneError& error) {
      why_ = error.what();
      return false;
    }
  r = r_;
  if (jacobian) *jacobian = jacobian_;
  return true;
}

}  // namespace momenta
