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

void user_motion(const UserFormula& joint, const Jet* u, UserMotion<Jet>& m) {
  joint.move(u, m);
}

void user_motion(const UserFormula& joint, const LocalDual* u, UserMotion<LocalDual>& m) {
  const int n = joint.coordinates();
  Dual8 rates[6];
  // Directions first q_0 … q_5 and u_0, u_1; then, for more rates, u_2 … u_5.
  const auto evaluate = [&](bool by_q, int first_rate, UserMotion<Dual8>& at) {
    at.t = Dual8(m.t.a);
    for (int i = 0; i < n; ++i) {
      at.q[i] = by_q ? Dual8::variable(m.q[i].a, i) : Dual8(m.q[i].a);
      if (!u) continue;
      const int direction = (by_q ? 6 : 0) + i - first_rate;
      const bool varies = i >= first_rate && direction < 8;
      rates[i] = varies ? Dual8::variable(u[i].a, direction) : Dual8(u[i].a);
    }
    joint.move(u ? static_cast<const Dual8*>(rates) : nullptr, at);
  };
  UserMotion<Dual8> first, rest;
  evaluate(true, 0, first);
  const bool more = u && n > 2;
  if (more) evaluate(false, 2, rest);
  Dual8 of_first[user_numbers], of_rest[user_numbers];
  Dual8* to = of_first;
  each_number(first, [&to](const Dual8& x) { *to++ = x; });
  to = of_rest;
  if (more) each_number(rest, [&to](const Dual8& x) { *to++ = x; });
  int k = 0;
  each_number(m, [&](LocalDual& x) {
    x = LocalDual(of_first[k].a);
    // Zeros too: the pattern must not depend on values.
    const auto add = [&x](const LocalDual& by, double slope) {
      x = LocalDual::sum(x.a, x, 1, by, slope);
    };
    for (int i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      add(m.q[i], of_first[k].b[at]);
      if (u && k >= user_numbers_without_rates)
        add(u[i], i < 2 ? of_first[k].b[6 + at] : of_rest[k].b[at - 2]);
    }
    ++k;
  });
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
