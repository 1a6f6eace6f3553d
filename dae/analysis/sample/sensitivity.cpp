#include <momenta/dae/analysis/sample/sample.h>
#include <momenta/dae/analysis/sample/sensitivity.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace momenta {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// Stream of the bootstrap's draws, apart from those of a sample's columns.
constexpr std::uint64_t bootstrap_stream = 1ull << 40;

/// Terms of the estimates, one row each: f(A) + f(B), f(A)² + f(B)², and for each quantity
/// f(B) (f(A_B) - f(A)) and (f(A) - f(A_B))².
class Terms {
 public:
  Terms(const std::vector<double>& f, std::size_t d) : d_(d) {
    const std::size_t block = d + 2;
    double sum = 0;
    std::vector<std::size_t> whole;
    for (std::size_t at = 0; at < f.size(); at += block) {
      bool numbers = true;
      for (std::size_t k = 0; k < block; ++k) numbers = numbers && std::isfinite(f[at + k]);
      if (!numbers) continue;
      whole.push_back(at);
      sum += f[at] + f[at + 1];
    }
    rows_ = whole.size();
    const double mean = rows_ == 0 ? 0 : sum / (2 * static_cast<double>(rows_));
    for (const std::size_t at : whole) {
      const double a = f[at] - mean, b = f[at + 1] - mean;
      terms_.push_back(a + b);
      terms_.push_back(a * a + b * b);
      for (std::size_t i = 0; i < d; ++i) {
        const double ab = f[at + 2 + i] - mean;
        terms_.push_back(b * (ab - a));
        terms_.push_back((a - ab) * (a - ab));
      }
    }
  }
  std::size_t rows() const { return rows_; }
  std::size_t width() const { return 2 + 2 * d_; }
  void add(std::size_t row, std::vector<double>& sums) const {
    for (std::size_t k = 0; k < width(); ++k) sums[k] += terms_[row * width() + k];
  }
  double variance(const std::vector<double>& sums) const {
    const double n = 2 * static_cast<double>(rows_), mean = sums[0] / n;
    return sums[1] / n - mean * mean;
  }
  double first(const std::vector<double>& sums, std::size_t i) const {
    return sums[2 + 2 * i] / static_cast<double>(rows_) / variance(sums);
  }
  double total(const std::vector<double>& sums, std::size_t i) const {
    return sums[3 + 2 * i] / (2 * static_cast<double>(rows_)) / variance(sums);
  }

 private:
  std::size_t d_, rows_ = 0;
  std::vector<double> terms_;
};

/// Running mean and deviation.
struct Spread {
  double count = 0, mean = 0, squares = 0;
  void take(double x) {
    count += 1;
    const double away = x - mean;
    mean += away / count;
    squares += away * (x - mean);
  }
  double deviation() const { return count > 1 ? std::sqrt(squares / (count - 1)) : none; }
};

}  // namespace

SobolIndices sobol_indices(const std::vector<double>& f, std::size_t d, std::uint64_t seed,
                           int resamples) {
  if (d == 0 || f.size() % (d + 2) != 0)
    throw std::invalid_argument("indices of " + std::to_string(d) + " quantities from " +
                                std::to_string(f.size()) +
                                " values, expected a multiple of the quantities and 2");
  const Terms terms(f, d);
  SobolIndices found;
  found.rows = terms.rows();
  found.variance = none;
  found.of.assign(d, {none, none, none, none});
  if (terms.rows() < 2) return found;
  std::vector<double> sums(terms.width(), 0.0);
  for (std::size_t j = 0; j < terms.rows(); ++j) terms.add(j, sums);
  found.variance = terms.variance(sums);
  if (!(found.variance > 0)) return found;
  std::vector<Spread> first(d), total(d);
  const auto n = static_cast<double>(terms.rows());
  for (int again = 0; again < resamples; ++again) {
    std::vector<double> drawn(terms.width(), 0.0);
    const std::uint64_t stream = bootstrap_stream + static_cast<std::uint64_t>(again);
    for (std::size_t j = 0; j < terms.rows(); ++j)
      terms.add(static_cast<std::size_t>(in_unit_interval(noise(seed, stream, j)) * n), drawn);
    if (!(terms.variance(drawn) > 0)) continue;  // one row, again and again
    for (std::size_t i = 0; i < d; ++i) {
      first[i].take(terms.first(drawn, i));
      total[i].take(terms.total(drawn, i));
    }
  }
  for (std::size_t i = 0; i < d; ++i)
    found.of[i] = {terms.first(sums, i), first[i].deviation(), terms.total(sums, i),
                   total[i].deviation()};
  return found;
}

}  // namespace momenta
