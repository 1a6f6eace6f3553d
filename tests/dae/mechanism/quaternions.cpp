// Unit quaternions stay unit quaternions, by every integrator and form and however long the run:
// |q| is 1 to rounding at every sample, interpolated ones too.
//
// Free steps let |q| drift: a method of order r leaves |q|² off by O(h^(r+1)) a step. Over 200 000
// steps of RK4 that is 5e-7 where states are not normalised after each.

#include "equations/ensemble.h"
#include "equations/linkages.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <limits>

namespace momenta::dae_quaternions {
namespace {

using namespace equations;

/// A body that tumbles.
Scene tumbling() {
  Scene s;
  s.name = "tumbling body";
  BodySpec b = rod("body", 0.5);
  b.com = {0, 0, 0};
  b.inertia = Eigen::Vector3d(1, 2, 3).asDiagonal();
  s.bodies = {b};
  JointSpec j = hinge("F", "ground", "body", {0, 0, 0}, 0);
  j.kind = JointKind::free;
  j.position = {0, 0, 0, 1, 0, 0, 0};
  j.velocity = {0, 0, 0, 0.1, 2, 0.1};
  s.joints = {j};
  return s;
}

/// Largest | |q| − 1 | over samples and quaternions, all of them there; ∞ where one is no number.
double worst(const Scene& scene, const std::string& form, const std::string& integrator,
             double step, double end) {
  const Mechanism mechanism(scene);
  RunRequest request;
  RunSettings& s = request.settings;
  s.form = form;
  s.integrator = integrator;
  s.gauge = is_dae_form(form) ? "leak:1" : "none";
  s.rtol = s.atol = 1e-6;
  s.step = step;
  s.end_time = end;
  s.samples = 77;  // between steps
  request.keep_trajectory = true;
  const RunResult r = run_form(mechanism, start_of(mechanism), request);
  EXPECT_EQ(r.status, "done") << form << ", " << integrator << ": " << r.reason;
  EXPECT_EQ(r.trajectory.rows.size(), 78u) << form << ", " << integrator;
  double off = 0;
  long seen = 0;
  for (const auto& row : r.trajectory.rows)
    for (const auto& b : mechanism.tree().bodies)
      if (b.nq >= 4) {
        const double* q = row.data() + 1 + b.q + b.nq - 4;
        const double norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
        off = std::isfinite(norm) ? std::max(off, std::abs(norm - 1))
                                  : std::numeric_limits<double>::infinity();
        ++seen;
      }
  EXPECT_GE(seen, 78) << form << ", " << integrator;
  return off;
}

constexpr double rounding = 1e-14;

/// | |q| − 1 | of the state itself after n steps of a method, as its next step would find it.
double of_the_state(const std::string& integrator, int steps) {
  const Mechanism mechanism(tumbling());
  const Start start = start_of(mechanism);
  const auto form = make_form("momentum", mechanism, {}, start);
  IntegrationOptions options;
  options.rtol = options.atol = 1e-4;
  options.step = 0.02;
  double off = 0;
  Observer last;
  last.sample = [&](double t, const double* y, const double*) {
    Eigen::VectorXd q(mechanism.nq());
    form->read_coordinates(t, y, q);
    off = std::abs(q.tail<4>().norm() - 1);
    return true;
  };
  const auto run = integrate(integrator, *form->ode(), 0, form->initial(start),
                             {options.step * steps}, options, last);
  EXPECT_TRUE(run.done) << integrator << ": " << run.reason;
  return off;
}

TEST(Quaternions, OfTheStateStayUnitOverLongRuns) {
  EXPECT_LT(of_the_state("rk4", 200000), rounding);
  for (const char* integrator : {"dp5", "dop853", "vern9"})
    EXPECT_LT(of_the_state(integrator, 20000), rounding) << integrator;
  for (const char* integrator : {"bdf", "gauss4", "gauss6"})  // adams takes no correction
    EXPECT_LT(of_the_state(integrator, 2000), rounding) << integrator;
}

TEST(Quaternions, StayUnitByEveryMethodOfOpenChains) {
  for (const char* form : {"momentum", "acceleration"})
    for (const char* integrator :
         {"rk4", "dp5", "dop853", "vern9", "adams", "bdf", "gauss4", "gauss6"})
      EXPECT_LT(worst(tumbling(), form, integrator, 0.02, 20), rounding)
          << form << ", " << integrator;
}

TEST(Quaternions, StayUnitInLoops) {
  const Scene scene = platform(6);
  for (const std::string& form : form_names())
    EXPECT_LT(worst(scene, form, default_integrator(form, 1e-6), 0.01, 0.5), rounding) << form;
  for (const char* integrator : {"rk4", "dp5", "vern9", "adams", "bdf", "gauss4"})
    EXPECT_LT(worst(scene, "momentum", integrator, 0.005, 0.5), rounding) << integrator;
  for (const char* integrator : {"radau5", "hem5", "hem8"})
    EXPECT_LT(worst(scene, "momentum-index2", integrator, 0.005, 0.5), rounding) << integrator;
  for (const char* integrator : {"generalised-alpha", "bayo-ledesma"})
    EXPECT_LT(worst(scene, "acceleration-index3", integrator, 0.001, 0.5), rounding) << integrator;
}

}  // namespace
}  // namespace momenta::dae_quaternions
