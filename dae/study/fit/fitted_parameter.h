#pragma once
// Numbers of a scene that a search varies: their names, ranges, sizes, and starts drawn from them.

#include <momenta/dae/study/fit/parametric_mechanism.h>

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace momenta {

/// A varied parameter and its range.
struct FittedParameter {
  std::string name;                            ///< name in [parameters], or a place
  std::optional<std::array<double, 2>> range;  ///< least and largest; none: any number
  /// "NAME" or "NAME=FROM:TO". @throws std::invalid_argument, one sentence
  static FittedParameter from_text(const std::string& text);
};

/// Reads "FROM:TO"; messages name `option` and expect `like`. @throws std::invalid_argument, one
/// sentence
std::array<double, 2> range_from_text(const std::string& option, const std::string& text,
                                      const std::string& like);

/// Sizes that scale steps of differences: |θ|; next to 0 the width of the range, else step_size().
Eigen::VectorXd sizes_of(const ParametricMechanism& family,
                         const std::vector<FittedParameter>& parameters);

/// Ends of ranges, infinite without one and for `more` unknowns behind the parameters.
void bounds_of(const std::vector<FittedParameter>& parameters, Eigen::Index more,
               Eigen::VectorXd& least, Eigen::VectorXd& most);

/// Checks that so many starts can be made. @throws std::invalid_argument, one sentence
void expect_starts(const ParametricMechanism& family,
                   const std::vector<FittedParameter>& parameters, int starts);

/// θ where searches begin: the scene's own, then drawn evenly from the ranges; the same for a seed
/// on every machine.
class DrawnStarts {
 public:
  /// Family and parameters must outlive it.
  DrawnStarts(const ParametricMechanism& family, const std::vector<FittedParameter>& parameters,
              std::uint64_t seed)
      : family_(family), parameters_(parameters), random_(seed) {}
  Eigen::VectorXd next();  ///< θ of the next start

 private:
  const ParametricMechanism& family_;
  const std::vector<FittedParameter>& parameters_;
  std::mt19937_64 random_;
  bool begun_ = false;
};

}  // namespace momenta
