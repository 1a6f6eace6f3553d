#include <momenta/core/kernel/user_motion.h>

namespace momenta {

void user_motion(const UserFormula& joint, const double* u, UserMotion<double>& m) {
  joint.move(u, m);
}
void user_motion(const UserFormula& joint, const Dual<double, 1>* u,
                 UserMotion<Dual<double, 1>>& m) {
  joint.move(u, m);
}
void user_motion(const UserFormula& joint, const Dual8* u, UserMotion<Dual8>& m) {
  joint.move(u, m);
}

void user_motion(const UserFormula& joint, double t, const double* q, const double* u,
                 double* numbers) {
  UserMotion<double> m;
  m.t = t;
  for (int i = 0; i < joint.coordinates(); ++i) m.q[i] = q[i];
  joint.move(u, m);
  each_number(m, [&numbers](double x) { *numbers++ = x; });
}

void user_motion(const UserFormula& joint, const double* t, const double* q, const double* u,
                 double* numbers) {
  UserMotion<Dual8> m;
  gather(t, m.t);
  Dual8 rates[6];
  for (int i = 0; i < joint.coordinates(); ++i) {
    gather(q + i * dual8_numbers, m.q[i]);
    if (u) gather(u + i * dual8_numbers, rates[i]);
  }
  joint.move(u ? static_cast<const Dual8*>(rates) : nullptr, m);
  each_number(m, [&numbers](const Dual8& x) {
    spread(x, numbers);
    numbers += dual8_numbers;
  });
}

}  // namespace momenta
