#pragma once
// Sizes of what public calls take. A wrong one is a mistake of the caller's and would corrupt
// memory: it is thrown, in one sentence. The checks are one comparison each.

#include <Eigen/Core>
#include <cmath>
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

/// The sentence for a number that is none.
inline std::string not_finite(const std::string& name, Eigen::Index at, double value) {
  return name + "[" + std::to_string(at) + "] is " +
         (std::isnan(value) ? "not a number"
          : value > 0       ? "infinite"
                            : "minus infinite") +
         ", expected a finite number";
}

}  // namespace momenta
