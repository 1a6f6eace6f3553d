#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/run_steps.h>

namespace momenta::formula {

template <Operation o>
MOMENTA_INLINE double lane_by_lane(const Step& s, const double* line) {
  const Instruction in{o, s.a, s.b, s.c, static_cast<double>(s.n), s.spline};
  double y;
  execute(in, static_cast<const double*>(nullptr), line, y);
  return y;
}

double one_by_one(const Step& s, Operation o, double a, double b, double c) {
  const Instruction in{o, 0, 1, 2, static_cast<double>(s.n), s.spline};
  const double line[]{a, b, c};
  double y;
  execute(in, static_cast<const double*>(nullptr), line, y);
  return y;
}

void run(const Steps& steps, const double* x, double* line, double* values) {
  run_steps(steps, x, line, values);
}

}  // namespace momenta::formula
