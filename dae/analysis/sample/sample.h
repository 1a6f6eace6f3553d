#pragma once
// The points at which a study samples the unit cube (0, 1)^d, d quantities.
//
//     random   every coordinate is drawn by itself
//     latin    Latin hypercube: each quantity has one of its N values in each of the N intervals
//              (i/N, (i+1)/N), in a random order of its own (McKay, Beckman, Conover, Technometrics
//              21 (1979), 239-245)
//     sobol    the Sobol' sequence with a digital shift: a random number of 32 bits for each
//              quantity, ⊕ to its coordinates, which leaves every net a net
//
// For the indices of sensitivity.h N points are two matrices A and B, N × d, columns 1 … d and
// d + 1 … 2d of one sample of 2d quantities, and A_B^(i), which is A with column i of B. Their rows
// are the cases, N (d + 2) of them: case j (d + 2) is row j of A, the next that of B, the next d
// those of A_B^(1) … A_B^(d) (A. Saltelli et al., Comput. Phys. Commun. 181 (2010), 259-270).
//
// A coordinate is a function of seed, quantity and number alone.

#include <momenta/dae/analysis/sample/sobol_sequence.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

struct SampleSettings {
  enum class Kind { random, latin, sobol };

  Kind kind = Kind::sobol;
  std::size_t points = 256;  ///< N
  std::uint64_t seed = 1;
  bool indices = false;  ///< A, B and A_B^(i) in place of one matrix
};

/// `kind`: "random", "latin" or "sobol"; empty: no sample. Missing settings keep their defaults.
/// @throws std::invalid_argument for another kind, or for settings without a kind
std::optional<SampleSettings> sample_settings(const std::string& kind,
                                              const std::optional<std::size_t>& points,
                                              const std::optional<std::uint64_t>& seed,
                                              bool indices);

class Sample {
 public:
  static constexpr std::size_t most_cases = 10'000'000;

  /// @throws std::invalid_argument for no points, more than most_cases, or more quantities than
  /// Sobol' dimensions (half of them with indices).
  Sample(const SampleSettings& settings, std::size_t quantities);

  const SampleSettings& settings() const { return settings_; }
  std::size_t quantities() const { return quantities_; }
  /// N, or N (d + 2).
  std::size_t cases() const { return settings_.points * cases_of_a_point(); }
  std::size_t cases_of_a_point() const { return settings_.indices ? quantities_ + 2 : 1; }
  /// Coordinate in (0, 1).
  double at(std::size_t number, std::size_t quantity) const;

 private:
  double coordinate(std::size_t point, std::size_t column) const;

  SampleSettings settings_;
  std::size_t quantities_;
  std::optional<SobolSequence> sobol_;
  std::vector<std::uint32_t> shifts_;               ///< sobol: one per column
  std::vector<std::vector<std::uint32_t>> strata_;  ///< latin: intervals in turn, by column
};

/// 64 pseudorandom bits, a function of the arguments alone (the output function of SplitMix64: G.
/// Steele, D. Lea, C. Flood, OOPSLA 2014, applied to each in turn).
std::uint64_t noise(std::uint64_t seed, std::uint64_t stream, std::uint64_t number);

/// Number in (0, 1) from 64 random bits: the middle of one of 2⁵² intervals.
double in_unit_interval(std::uint64_t bits);

}  // namespace momenta
