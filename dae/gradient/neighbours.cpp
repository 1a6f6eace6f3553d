#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/neighbours.h>

#include <algorithm>
#include <cmath>

namespace momenta {

Neighbours::Neighbours(RunVariable variable, double h, Scenes scenes, const Mechanism& own,
                       MechanismOptions options)
    : variable_(std::move(variable)),
      h_(h),
      scenes_(std::move(scenes)),
      own_(own),
      options_(options) {}

Neighbours::Width& Neighbours::width(double h) {
  std::size_t i = 0;
  for (double at = h_; at != h && i + 1 < widths_.size(); at *= sixth_order::narrower) ++i;
  Width& width = widths_[i];
  if (width.scenes.empty() && width.mechanisms.empty()) width.scenes = scenes_(h);
  return width;
}

const std::vector<Scene>& Neighbours::scenes() {
  for (int i = 1;; ++i) try {
      return width(h_).scenes;
    } catch (const SceneError&) {
      if (i == sixth_order::widths) throw;
      h_ *= sixth_order::narrower;
    }
}

Neighbours::Width& Neighbours::at(double h) {
  Width& width = this->width(h);
  if (!width.evaluations.empty()) return width;
  std::vector<std::unique_ptr<Mechanism>> all;
  std::vector<Scene> scenes = std::move(width.scenes);
  width.scenes.clear();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const Mechanism& made =
        *all.emplace_back(std::make_unique<Mechanism>(std::move(scenes[i]), options_));
    if (made.nq() != own_.nq() || made.nv() != own_.nv() || made.m() != own_.m())
      throw SceneError("with " + variable_.name + " = " +
                       reading::digits(variable_.value + sixth_order::points[i].k * h) +
                       " the mechanism has other coordinates or equations; expected a parameter "
                       "that changes numbers alone");
  }
  for (const auto& made : all) width.evaluations.push_back(made->evaluation<double>());
  width.mechanisms = std::move(all);
  return width;
}

void Neighbours::make() {
  for (int i = 1;; ++i) try {
      at(h_);
      return;
    } catch (const SceneError&) {
      if (i == sixth_order::widths) throw;
      h_ *= sixth_order::narrower;
      widths_ = {};
    }
}

const Eigen::VectorXd& Neighbours::law_slope(std::size_t drive, double t) {
  take(sixth_order::slope_of(h_, sixth_order::exact, [&](std::size_t i, double h) {
    const std::vector<MotionLaw>* laws = &own_.tree().drives;
    if (i != sixth_order::middle) {
      Width& width = this->width(h);
      if (width.laws.empty()) {
        for (const auto& made : width.mechanisms) width.laws.push_back(made->tree().drives);
        for (const Scene& made : width.scenes) width.laws.push_back(build_valid_tree(made).drives);
      }
      laws = &width.laws[i];
    }
    double f, rate, second;
    (*laws)[drive].evaluate(t, f, rate, second);
    return Eigen::Vector2d(f, rate);
  }));
  return slope_;
}

void Neighbours::take(sixth_order::Slope slope) {
  if (slope.by.size() > 0) size_ += slope.by.cwiseAbs().maxCoeff();
  apart_ += slope.apart;
  slope_ = std::move(slope.by);
}

double Neighbours::digits() const {
  if (!(apart_ > 0) || !(size_ > 0)) return 16;
  return std::clamp(-std::log10(apart_ / size_), 0.0, 16.0);
}

}  // namespace momenta
