#include <momenta/core/user_joint.h>

namespace momenta {

UserJoint::Law::~Law() = default;

void UserJoint::pose(double t, const double* q, double* rotation, double* position) const {
  UserMotion<double> m;
  m.t = t;
  for (int i = 0; i < coordinates_; ++i) m.q[i] = q[i];
  law_->move(static_cast<const double*>(nullptr), m);
  for (int i = 0; i < 3; ++i) {
    position[i] = m.position[i];
    for (int j = 0; j < 3; ++j) rotation[3 * j + i] = m.rotation(i, j);
  }
}

int coordinates_of(const UserJoint& joint) {
  return joint.coordinates();
}

void user_motion(const UserJoint& joint, const double* u, UserMotion<double>& m) {
  joint.law().move(u, m);
}
void user_motion(const UserJoint& joint, const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) {
  joint.law().move(u, m);
}
void user_motion(const UserJoint& joint, const Dual8* u, UserMotion<Dual8>& m) {
  joint.law().move(u, m);
}

void user_motion(const UserJoint& joint, double t, const double* q, const double* u,
                 double* numbers) {
  UserMotion<double> m;
  m.t = t;
  for (int i = 0; i < joint.coordinates(); ++i) m.q[i] = q[i];
  joint.law().move(u, m);
  each_number(m, [&numbers](double x) { *numbers++ = x; });
}

void user_motion(const UserJoint& joint, const double* t, const double* q, const double* u,
                 double* numbers) {
  UserMotion<Dual8> m;
  gather(t, m.t);
  Dual8 rates[6];
  for (int i = 0; i < joint.coordinates(); ++i) {
    gather(q + i * dual8_numbers, m.q[i]);
    if (u) gather(u + i * dual8_numbers, rates[i]);
  }
  joint.law().move(u ? static_cast<const Dual8*>(rates) : nullptr, m);
  each_number(m, [&numbers](const Dual8& x) {
    spread(x, numbers);
    numbers += dual8_numbers;
  });
}

}  // namespace momenta
