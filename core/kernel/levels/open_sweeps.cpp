#include <momenta/core/kernel/jacobian_pass.h>
#include <momenta/core/kernel/levels/at_level.h>
#include <momenta/core/kernel/levels/batch_sweeps.h>
#include <momenta/core/kernel/levels/open_sweeps.h>

#include <algorithm>
#include <vector>

namespace momenta {

template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const LinkTree& tree, const Branches* branches);
template <int Level>
std::unique_ptr<OpenSweeps> sweeps_at(const PlanarTree& tree);
template <int Level>
std::unique_ptr<BatchSweeps> batch_sweeps_at(const LinkTree& tree);
template <int Level>
std::unique_ptr<BatchSweeps> batch_sweeps_at(const PlanarTree& tree);

std::unique_ptr<OpenSweeps> make_sweeps(const LinkTree& tree, int level, const Branches* branches) {
  return at_level(level, [&]<int Level>() { return sweeps_at<Level>(tree, branches); });
}
std::unique_ptr<OpenSweeps> make_sweeps(const PlanarTree& tree, int level) {
  return at_level(level, [&]<int Level>() { return sweeps_at<Level>(tree); });
}
std::unique_ptr<BatchSweeps> make_batch_sweeps(const LinkTree& tree, int level) {
  return at_level(level, [&]<int Level>() { return batch_sweeps_at<Level>(tree); });
}
std::unique_ptr<BatchSweeps> make_batch_sweeps(const PlanarTree& tree, int level) {
  return at_level(level, [&]<int Level>() { return batch_sweeps_at<Level>(tree); });
}

bool is_hamiltonian_on_revolutes(const LinkTree& tree) {
  return is_hamiltonian(*tree.model) &&
         std::all_of(tree.links.begin(), tree.links.end(),
                     [](const Link& l) { return l.kind == LinkKind::revolute; });
}
bool is_hamiltonian_on_revolutes(const PlanarTree& tree) {
  return is_hamiltonian(*tree.model) && std::all_of(tree.links.begin(), tree.links.end(),
                                                    [](const PlanarLink& l) { return l.revolute; });
}

void prescribed_motion(const MotionLaw& law, double t, double& f, double& fdot, double& fddot) {
  law.evaluate(t, f, fdot, fddot);
}
void prescribed_motion(const MotionLaw& law, const double* t, double* f) {
  Dual8 time, motion[3];
  gather(t, time);
  law.evaluate(time, motion[0], motion[1], motion[2]);
  for (int i = 0; i < 3; ++i) spread(motion[i], f + i * dual8_numbers);
}

double* formula_room(std::size_t size) {
  thread_local std::vector<double> room;
  if (room.size() < size) room.resize(size);
  return room.data();
}
void formula_in_doubles(const Expression& formula, const double* x, double* values) {
  thread_local std::vector<double> line;
  if (line.size() < formula.tape().size()) line.resize(formula.tape().size());
  evaluate(formula, x, line.data(), values);
}
void formula_in_dual8(const Expression& formula, const double* x, int count, double* values) {
  thread_local std::vector<Dual8> room;
  const auto n = static_cast<std::size_t>(count);
  const std::size_t outputs = formula.outputs().size();
  if (const std::size_t size = n + outputs + formula.tape().size(); room.size() < size)
    room.resize(size);
  for (std::size_t i = 0; i < n; ++i) gather(x + i * dual8_numbers, room[i]);
  evaluate(formula, room.data(), room.data() + n + outputs, room.data() + n);
  for (std::size_t i = 0; i < outputs; ++i) spread(room[n + i], values + i * dual8_numbers);
}

}  // namespace momenta
