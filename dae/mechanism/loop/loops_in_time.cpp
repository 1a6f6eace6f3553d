#include <momenta/dae/mechanism/loop/driven_loop.h>
#include <momenta/dae/mechanism/loop/loops_in_time.h>

#include <cstddef>

namespace momenta {

template <class Space>
LoopsInTime<Space>::LoopsInTime(const LoopModel<Space>& model)
    : constant_(&model), moving_(model.motions.empty() ? nullptr : new LoopModel<Space>(model)) {}

template <class Space>
LoopsInTime<Space>::~LoopsInTime() {
  delete moving_;
}

template <class Space>
const LoopModel<Space>& LoopsInTime<Space>::moved(double t) {
  DrivenLoop<Space, double> now;
  for (auto& l : moving_->loops) {
    if (l.motion < 0) continue;
    auto& m = moving_->motions[static_cast<std::size_t>(l.motion)];
    now.move(m, t);
    l.at_b = now.at_b;
    l.axis_a = now.axis_a;
    l.axis_b = now.axis_b;
    l.given = now.given;
    m.v = now.v;
    m.a = now.a;
    m.turning_a = now.turning_a;
    m.turning_a_rate = now.turning_a_rate;
    m.turning_b = now.turning_b;
    m.turning_b_rate = now.turning_b_rate;
    m.given_rate = now.given_rate;
    m.given_second = now.given_second;
  }
  return *moving_;
}

template class LoopsInTime<Planar>;
template class LoopsInTime<Spatial>;

}  // namespace momenta
