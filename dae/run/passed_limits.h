#pragma once
// Joints and lengths along forces beyond their `limits`, and points beyond the ends of open slots:
// since when, and how far. Of a spherical joint the angle of its turn counts, 2 atan2(|e|, |w|) of
// its quaternion (w, e). Between the samples the dense output is read: the middle and the end of
// each step, and the vertex of the parabola through the three where that lies further out; the time
// at which a limit is passed is bisected.

#include <momenta/dae/integrator/memory.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_result.h>

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

class PassedLimits {
 public:
  /// Driven joints are not watched.
  explicit PassedLimits(const Mechanism& mechanism);
  bool any() const { return !limited_.empty(); }

  /// Takes q (nq) at the start t [s]. O(joints with limits); with open slots an evaluation of the
  /// loops.
  void look(double t, const double* q, std::vector<PassedLimit>& passed);

  /// Takes the step from the last time to t1; `q_at(t)`: q within it, null: not readable. Two calls
  /// of it, and about 50 where a limit is first passed.
  void step(double t1, const std::function<const double*(double)>& q_at,
            std::vector<PassedLimit>& passed);
  void carry(Memory& memory) { memory(last_time_), memory(last_.data(), last_.size()); }

 private:
  /// Kinds of watched values: a joint's coordinate, the angle of a spherical joint, the place of a
  /// point along the chords of an open slot, a sum of coordinates, the length of a spring-damper.
  enum class Of { coordinate, angle, slot, sum, length };
  static constexpr auto nowhere = static_cast<std::size_t>(-1);
  struct Limited {
    std::string name;
    std::array<double, 2> limits;
    Of of;
    int place;  ///< in q; slot: its loop's in the scene; length: among lengths
    bool slides, stops;
    std::vector<std::pair<int, double>> terms{};  ///< sum: places in q, ratios
    std::size_t noted = 0;                        ///< place among the passed, or `nowhere`
    bool of_force() const { return of == Of::sum || of == Of::length; }
  };
  void add_force(const Mechanism& mechanism, const ForceSpec& force);
  /// x of all of limited_ at (t, q).
  void values(double t, const double* q, std::vector<double>& x);
  static double beyond(const Limited& l, double x);
  static bool is_of(const PassedLimit& p, const Limited& l);
  /// Entry of `l`; null: none.
  static PassedLimit* known(Limited& l, std::vector<PassedLimit>& passed);
  static PassedLimit& entry(Limited& l, double t, double x, std::vector<PassedLimit>& passed);

  std::vector<Limited> limited_;
  std::unique_ptr<Evaluation<double>> e_;  ///< for open slots and lengths
  std::vector<double> places_;             ///< by loop
  std::vector<double> lengths_;
  double last_time_ = 0;
  std::vector<double> last_, middle_, end_, between_;  ///< values of limited_
};

/// "joint 'k' is beyond its limits [-1, 2] rad from t = 0.3 s on, farthest at t = 0.4 s: 2.1 rad",
/// "the point in slot 's' is beyond its ends [0, 2] m …", "the length of force 'f' …", the first
/// four; and how many more.
std::vector<std::string> in_words(const std::vector<PassedLimit>& passed);

}  // namespace momenta
