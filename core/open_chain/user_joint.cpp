#include <momenta/core/open_chain/user_joint.h>

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

void UserJoint::move(const double* u, UserMotion<double>& m) const {
  law_->move(u, m);
}
void UserJoint::move(const Dual<double, 1>* u, UserMotion<Dual<double, 1>>& m) const {
  law_->move(u, m);
}
void UserJoint::move(const Dual8* u, UserMotion<Dual8>& m) const {
  law_->move(u, m);
}
void UserJoint::move(const Jet* u, UserMotion<Jet>& m) const {
  law_->move(u, m);
}

}  // namespace momenta
