#pragma once
// Arguments as a caller may get them wrong: sizes, numbers that are none or far too large, and
// sound ones between. For tests of what public calls do with them.

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace momenta::equations {

class Wild {
 public:
  explicit Wild(unsigned seed) : random_(seed) {}

  int below(int count) { return static_cast<int>(random_() % static_cast<unsigned>(count)); }
  bool chance(double p) { return std::uniform_real_distribution<double>(0, 1)(random_) < p; }
  double sound() { return std::uniform_real_distribution<double>(-2, 2)(random_); }
  double wild() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
    constexpr double all[] = {nan,   inf,    -inf, 1e300, -1e300, 1e155, -1e155, 1e80,
                              1e16,  1e-300, 0,    -0.0,  5e-324, 1e308, -1e308, 1e30,
                              -1e12, 1e-12,  1,    -1,    1e100,  1e5};
    return all[below(static_cast<int>(std::size(all)))];
  }
  double number() { return chance(0.8) ? sound() : wild(); }
  int size(int right) { return chance(0.93) ? right : below(2 * right + 3); }
  /// Sound, or with one wild number, or wild throughout.
  Eigen::VectorXd numbers(int n) {
    Eigen::VectorXd x(n);
    for (double& v : x) v = sound();
    const int how = below(10);
    if (how == 0)
      for (double& v : x) v = wild();
    else if (how <= 3 && n > 0)
      x[below(n)] = wild();
    return x;
  }
  Eigen::VectorXd vector(int right) { return numbers(size(right)); }

 private:
  std::mt19937_64 random_;
};

/// Whether a text is one sentence of this project: not empty, one line, no number that is none in
/// it but by name.
inline bool is_sentence(const std::string& text) {
  return text.size() > 10 && text.find('\n') == std::string::npos;
}

}  // namespace momenta::equations
