#include "formulas_in_packs.h"

#include <momenta/core/expression/run_steps.h>

#include "formulas_by_hand.h"

namespace momenta::by_hand {
namespace {

constexpr int width = 8, own_level = 99;  // a level of its own: no code is shared with the library
using P = Pack<width, own_level>;

template <class Act>
MOMENTA_INLINE P lanes(Act&& act) {
  P y;
  for (int i = 0; i < width; ++i) y.set_lane(i, act(i));
  return y;
}

struct PackFunctions {
  static P sin(const P& x) { return momenta::sin(x); }
  static P cos(const P& x) { return momenta::cos(x); }
  static P sqrt(const P& x) { return momenta::sqrt(x); }
  static P atan(const P& x) {
    return lanes([&](int i) { return std::atan(x.lane(i)); });
  }
  static P exp(const P& x) {
    return lanes([&](int i) { return std::exp(x.lane(i)); });
  }
  static P tanh(const P& x) {
    return lanes([&](int i) { return std::tanh(x.lane(i)); });
  }
  static P power(const P& x, double n) {
    return lanes([&](int i) { return std::pow(x.lane(i), n); });
  }
  template <class Act>
  static P below_zero(const P& x, Act&& act) {
    const P y = act();
    return lanes([&](int i) { return x.lane(i) < 0 ? y.lane(i) : 0.0; });
  }
};

}  // namespace

struct InPacks::Inside {
  Traced<P, PackFunctions>::Function hand;
  const formula::Steps* steps;
  std::size_t variables;
  std::vector<P> x, line, values;
};

InPacks::InPacks(std::size_t k, const Expression& formula, const std::vector<double>& x)
    : inside_(std::make_unique<Inside>()) {
  Inside& in = *inside_;
  in.hand = Traced<P, PackFunctions>::all()[k];
  in.steps = &formula.steps();
  in.variables = all()[k].variables.size();
  in.line.resize(formula.tape().size());
  in.values.resize(1);
  const std::size_t points = x.size() / in.variables;
  for (std::size_t p = 0; p + width <= points; p += width)
    for (std::size_t v = 0; v < in.variables; ++v)
      in.x.push_back(
          lanes([&](int i) { return x[(p + static_cast<std::size_t>(i)) * in.variables + v]; }));
}
InPacks::~InPacks() = default;

double InPacks::points() const {
  return static_cast<double>(width * inside_->x.size() / inside_->variables);
}

void InPacks::tape() const {
  Inside& in = *inside_;
  for (std::size_t p = 0; p < in.x.size(); p += in.variables) {
    formula::run_steps(*in.steps, in.x.data() + p, in.line.data(), in.values.data());
    asm volatile("" : : "r"(in.values.data()) : "memory");
  }
}

void InPacks::hand() const {
  Inside& in = *inside_;
  for (std::size_t p = 0; p < in.x.size(); p += in.variables) {
    in.values[0] = in.hand(in.x.data() + p);
    asm volatile("" : : "r"(in.values.data()) : "memory");
  }
}

}  // namespace momenta::by_hand
