#include "passed_limits.h"
#include <momenta/core/text/near_name.h>
#include <momenta/dae/loop/pair_of_loop.h>
#include <momenta/dae/text/number_text.h>

namespace momenta::program {

PassedLimits::PassedLimits(const Mechanism& mechanism) {
  for (const JointSpec& joint : mechanism.scene().joints) {
    if (!joint.limits) continue;
    const auto& body =
        mechanism.tree().bodies[static_cast<std::size_t>(mechanism.tree().carried_by(joint.name))];
    if (body.nq != 1) continue;  // driven
    joints_.push_back({joint.name, (*joint.limits)[0], (*joint.limits)[1], body.q,
                       joint.kind == JointKind::prismatic});
  }
  const auto& loops = mechanism.scene().loops;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].kind == LoopKind::slot && loops[i].curve.kind == "spline" &&
        !loops[i].curve.closed)
      slots_.push_back({loops[i].name, i, pair_of(loops[i]).of_b.samples().back()});
  if (slots_.empty()) return;
  e_ = mechanism.evaluation<double>();
  places_.resize(loops.size());
}

void PassedLimits::look(double t, const double* q) {
  if (e_) {
    e_->place(t, q);
    e_->slot_places(places_.data());
  }
  for (Slot& slot : slots_) {
    const double place = places_[slot.loop];
    if (slot.passed || !(place < 0 || place > slot.length)) continue;
    slot.passed = true;
    slot.at = t;
    slot.value = place;
  }
  for (Limited& joint : joints_) {
    const double value = q[joint.q];
    if (joint.passed || (joint.least <= value && value <= joint.largest)) continue;
    joint.passed = true;
    joint.at = t;
    joint.value = value;
  }
}

std::vector<std::string> PassedLimits::sentences() const {
  constexpr std::size_t most = 4;
  std::vector<std::string> all;
  std::size_t more = 0, more_slots = 0;
  for (const Slot& slot : slots_) {
    if (!slot.passed || (all.size() == most && ++more_slots > 0)) continue;
    all.push_back("the point in slot " + reading::in_quotes(slot.name) + ", " +
                  compact(slot.length, 4) + " m long, is beyond its end from t = " +
                  compact(slot.at, 4) + " s on: at " + compact(slot.value, 4) + " m");
  }
  for (const Limited& joint : joints_) {
    if (!joint.passed || (all.size() == most && ++more > 0)) continue;
    const std::string unit = joint.slides ? " m" : " rad";
    all.push_back("joint " + reading::in_quotes(joint.name) + " is beyond its limits [" +
                  compact(joint.least, 4) + ", " + compact(joint.largest, 4) + "]" + unit +
                  " from t = " + compact(joint.at, 4) + " s on: " + compact(joint.value, 4) + unit);
  }
  if (more_slots > 0)
    all.push_back("so are those in " + std::to_string(more_slots) + " slots more");
  if (more > 0) all.push_back("so are " + std::to_string(more) + " joints more");
  return all;
}

}  // namespace momenta::program
