#pragma once
// Checks of arguments and results of public calls. A list of wrong size would corrupt memory: it is
// thrown, in one sentence. Where a number is not finite, `failure` says which: calls that return
// bool return false, others throw. All numbers of a call cost one comparison (scalar/all_finite.h).

#include <momenta/core/scalar/all_finite.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace momenta {

[[noreturn]] inline void throw_wrong_size(const char* call, const char* name, Eigen::Index found,
                                          Eigen::Index expected) {
  throw std::invalid_argument(std::string(call) + ": " + name + " has " + std::to_string(found) +
                              (found == 1 ? " number" : " numbers") + ", expected " +
                              std::to_string(expected));
}

/// @throws std::invalid_argument "rates: q has 3 numbers, expected 4"
inline void expect_size(const char* call, const char* name, Eigen::Index found,
                        Eigen::Index expected) {
  if (found != expected) [[unlikely]]
    throw_wrong_size(call, name, found, expected);
}

/// The sentence for a number that is not finite.
inline std::string not_finite(const std::string& name, Eigen::Index at, double value) {
  return name + "[" + std::to_string(at) + "] is " +
         (std::isnan(value) ? "not a number"
          : value > 0       ? "infinite"
                            : "minus infinite") +
         ", expected a finite number";
}

inline constexpr const char* too_large =
    "the result is not finite, expected smaller numbers to find it from";

/// A list of numbers with its name; made without one: no numbers.
struct Numbers {
  Numbers() = default;
  template <class List>
  Numbers(const char* called, const List& list)
      : name(called), x(list.data()), n(static_cast<std::size_t>(list.size())) {}

  const char* name = "";
  const double* x = nullptr;
  std::size_t n = 0;
};

/// The sentence for the first number that is not finite. Lists by value: those of callers stay in
/// registers.
[[gnu::cold, gnu::noinline]] inline std::string first_not_finite(double t, Numbers a, Numbers b,
                                                                 Numbers c, Numbers d) {
  if (!std::isfinite(t)) return "t is not finite, expected a time in seconds";
  for (const Numbers* list : {&a, &b, &c, &d})
    for (std::size_t i = 0; i < list->n; ++i)
      if (!std::isfinite(list->x[i]))
        return not_finite(list->name, static_cast<Eigen::Index>(i), list->x[i]);
  return "";
}

/// Whether t [s] and all given numbers are finite; else `failure` names the first that is not.
/// Inlined, so that absent lists cost nothing.
[[gnu::always_inline]] inline bool given_finite(std::string& failure, double t, const Numbers& a,
                                                const Numbers& b = {}, const Numbers& c = {},
                                                const Numbers& d = {}) {
  FiniteSum sum;
  sum.take(t);
  sum.take(a.x, a.n), sum.take(b.x, b.n), sum.take(c.x, c.n), sum.take(d.x, d.n);
  if (!failure.empty()) failure.clear();
  if (sum.finite()) [[likely]]
    return true;
  failure = first_not_finite(t, a, b, c, d);
  return false;
}
/// The same for calls that return their result: throws.
inline void expect_given_finite(const char* call, std::string& failure, double t, const Numbers& a,
                                const Numbers& b = {}, const Numbers& c = {},
                                const Numbers& d = {}) {
  if (!given_finite(failure, t, a, b, c, d))
    throw std::invalid_argument(std::string(call) + ": " + failure);
}

/// Whether all results are finite; else `failure` says so. Lists have data() and size().
template <class... Lists>
[[gnu::always_inline]] inline bool found_finite(std::string& failure, const Lists&... lists) {
  FiniteSum sum;
  (sum.take(lists.data(), static_cast<std::size_t>(lists.size())), ...);
  if (sum.finite()) [[likely]]
    return true;
  failure = too_large;
  return false;
}
template <class... Lists>
void expect_found_finite(const char* call, std::string& failure, const Lists&... lists) {
  if (!found_finite(failure, lists...))
    throw std::invalid_argument(std::string(call) + ": " + failure);
}

/// @throws std::invalid_argument "rates: leak is -1, expected a rate in 1/s, not negative"
inline void expect_leak(const char* call, double leak) {
  if (leak >= 0 && std::isfinite(leak)) [[likely]]
    return;
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.6g", leak);
  throw std::invalid_argument(std::string(call) + ": leak is " + digits +
                              ", expected a rate in 1/s, not negative");
}

}  // namespace momenta
