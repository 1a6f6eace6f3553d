#include <momenta/dae/loop/loops_in_time.h>

#include <cmath>
#include <cstddef>

namespace momenta {
namespace {

Vec2<double> turned(double axis, double angle, const Vec2<double>& v) {
  const double c = std::cos(angle), s = axis * std::sin(angle);
  return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}
double turned(double, double, double w) {
  return w;
}
/// v + sin θ a × v + (1 − cos θ) a × (a × v)
Vec3<double> turned(const Vec3<double>& axis, double angle, const Vec3<double>& v) {
  const Vec3<double> across = cross(axis, v);
  return v + std::sin(angle) * across + (1 - std::cos(angle)) * cross(axis, across);
}

template <class Space>
class Moving {
 public:
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

 private:
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
};

}  // namespace

template <class Space>
LoopsInTime<Space>::LoopsInTime(const LoopModel<Space>& model)
    : constant_(&model), moving_(model.motions.empty() ? nullptr : new LoopModel<Space>(model)) {}

template <class Space>
LoopsInTime<Space>::~LoopsInTime() {
  delete moving_;
}

template <class Space>
const LoopModel<Space>& LoopsInTime<Space>::moved(double t) {
  for (auto& l : moving_->loops)
    if (l.motion >= 0)
      Moving<Space>::move(l, moving_->motions[static_cast<std::size_t>(l.motion)], t);
  return *moving_;
}

template class LoopsInTime<Planar>;
template class LoopsInTime<Spatial>;

}  // namespace momenta
