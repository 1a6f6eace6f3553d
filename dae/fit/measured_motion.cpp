#include <momenta/core/text/near_name.h>
#include <momenta/dae/fit/measured_motion.h>
#include <momenta/dae/fit/named_table.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {

MeasuredMotion read_measured(const std::filesystem::path& file, const Mechanism& mechanism) {
  NamedTableForm form{"file of a measured motion",
                      "times",
                      "is no time, coordinate, rate or marker",
                      "the times are the only column; expected what was measured then",
                      {{"t", "s"}},
                      0};
  for (const std::vector<Column>& columns :
       {mechanism.coordinate_columns(), mechanism.rate_columns(), mechanism.marker_columns()})
    form.known.insert(form.known.end(), columns.begin(), columns.end());
  const NamedTable table = read_named_table(file, form);
  MeasuredMotion measured;
  measured.file = file.string();
  std::vector<Eigen::Index> columns;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    if (table.columns[k] == form.whole) {
      measured.times.assign(table.values.col(column).begin(), table.values.col(column).end());
    } else {
      measured.quantities.push_back(form.known[table.columns[k]]);
      columns.push_back(column);
    }
  }
  if (measured.times.empty())
    throw SceneError(measured.file +
                     ":1: there is no column 't [s]'; expected the times of a measured motion, or, "
                     "for wanted poses, --sweep NAME");
  for (std::size_t i = 0; i < measured.times.size(); ++i) {
    const double t = measured.times[i];
    if (t < 0 || (i > 0 && !(t > measured.times[i - 1])))
      throw SceneError(measured.file + ":" + std::to_string(table.lines[i]) + ": found the time " +
                       reading::digits(t) +
                       "; expected times from 0 on, each after the one before");
  }
  if (measured.times.back() == 0)
    throw SceneError(measured.file + ":" + std::to_string(table.lines.back()) +
                     ": the last time is 0; expected one after the start of the motion");
  measured.values = table.values(Eigen::all, columns);
  return measured;
}

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
      ++runs_;
      const GradientResult run = gradient(scene, request);
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
