#pragma once
// The loops of a model at one time: points, axes, lengths and offsets where drives prescribe them,
// and their rates relative to the bodies.
//
//   x_B = x_B0 + Σ f_k d_k,  v = Σ ḟ_k d_k,  a = Σ f̈_k d_k
//   b_j = R₁(f₁) R₂(f₂) … b_j0;  with c_k = R₁ … R_{k−1} times the axis of R_k
//   w = Σ ḟ_k c_k,  dw/dt = Σ (f̈_k c_k + w_{<k} × ḟ_k c_k)
//
// Everything that follows, rows, impulses and rates N, is then as for points and axes fixed in the
// bodies, with total velocities in place of the bodies'.

#include <momenta/dae/loop/loop_model.h>

#include <cmath>
#include <cstddef>

namespace momenta {

inline Vec2<double> turned(double axis, double angle, const Vec2<double>& v) {
  const double c = std::cos(angle), s = axis * std::sin(angle);
  return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}
inline double turned(double, double, double w) {
  return w;
}
/// v + sin θ a × v + (1 − cos θ) a × (a × v)
inline Vec3<double> turned(const Vec3<double>& axis, double angle, const Vec3<double>& v) {
  const Vec3<double> across = cross(axis, v);
  return v + std::sin(angle) * across + (1 - std::cos(angle)) * cross(axis, across);
}

template <class Space>
class LoopsInTime {
 public:
  explicit LoopsInTime(const LoopModel<Space>& model) : constant_(&model) {
    if (!model.motions.empty()) moving_ = model;
  }

  /// O(loops with drives); without any the model as it is. Valid until the next call.
  const LoopModel<Space>& at(double t) {
    if (constant_->motions.empty()) return *constant_;
    for (auto& l : moving_.loops)
      if (l.motion >= 0) move(l, moving_.motions[static_cast<std::size_t>(l.motion)], t);
    return moving_;
  }

 private:
  using Model = LoopModel<Space>;
  using Motion = typename Model::Motion;
  using Angular = typename Model::Angular;

  static void move(typename Model::Loop& l, Motion& m, double t) {
    double f, rate, second;
    l.at_b = m.at_b;
    m.v = m.a = {};
    for (const auto& slide : m.slides) {
      slide.law.evaluate(t, f, rate, second);
      l.at_b += f * slide.along;
      m.v += rate * slide.along;
      m.a += second * slide.along;
    }
    turn(m.turns_a, t, m.axis_a, l.axis_a, m.turning_a, m.turning_a_rate);
    turn(m.turns_b, t, m.axis_b, l.axis_b, m.turning_b, m.turning_b_rate);
    l.given = m.given;
    m.given_rate = m.given_second = 0;
    for (const auto& [factor, law] : m.numbers) {
      law.evaluate(t, f, rate, second);
      l.given += factor * f;
      m.given_rate += factor * rate;
      m.given_second += factor * second;
    }
  }

  using Axes = std::array<typename Model::Vector, 3>;
  static void turn(const std::vector<typename Motion::Turn>& turns, double t, const Axes& from,
                   Axes& to, Angular& w, Angular& dw) {
    to = from;
    w = dw = {};
    double angle[3];
    for (std::size_t k = 0; k < turns.size(); ++k) {
      double rate, second;
      turns[k].law.evaluate(t, angle[k], rate, second);
      Angular axis = turns[k].axis;
      for (std::size_t j = k; j-- > 0;) axis = turned(turns[j].axis, angle[j], axis);
      dw += second * axis;
      if constexpr (Space::dimension == 6) dw += rate * cross(w, axis);
      w += rate * axis;
    }
    for (auto& v : to)
      for (std::size_t j = turns.size(); j-- > 0;) v = turned(turns[j].axis, angle[j], v);
  }

  const Model* constant_;
  Model moving_;
};

}  // namespace momenta
