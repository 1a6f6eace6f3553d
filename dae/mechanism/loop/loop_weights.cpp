#include <momenta/dae/mechanism/loop/higher_pair.h>
#include <momenta/dae/mechanism/loop/loop_weights.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace momenta {
namespace {

constexpr double least_lever = 1e-4;

/// One loop: Σ 1/M_jj in the unit of 1/kg, and the lightest and the heaviest joint.
struct Weighed {
  double mobility = 0;
  int lightest = -1, heaviest = -1;  ///< bodies
  double of_lightest = 0, of_heaviest = 0;
};

class Scales {
 public:
  Scales(const Tree& tree, const std::vector<double>& inertia, double length)
      : tree_(tree), inertia_(inertia), poses_(tree.zero_poses()), length_(length) {}

  template <class Loop>
  Weighed of(const Loop& l, const HigherPair* pair) const {
    Weighed w;
    if (l.is_coupler()) {
      for (const auto& c : l.joints) pass(c.body, length_, w);
      return w;
    }
    double way_a = std::sqrt(dot(l.at_a, l.at_a)), way_b = std::sqrt(dot(l.at_b, l.at_b));
    if (pair) way_a += pair->reach_a(), way_b += pair->reach_b();
    for (int a = l.a, b = l.b; a != b;) {
      int& later = a > b ? a : b;
      double& way = a > b ? way_a : way_b;
      pass(later, way, w);
      const Eigen::Vector3d from = poses_[static_cast<std::size_t>(later)].translation();
      later = tree_.bodies[static_cast<std::size_t>(later)].parent;
      if (later >= 0) way += (from - poses_[static_cast<std::size_t>(later)].translation()).norm();
    }
    return w;
  }

 private:
  void pass(int k, double lever, Weighed& w) const {
    const Tree::Body& b = tree_.bodies[static_cast<std::size_t>(k)];
    for (int i = 0; i < b.nv; ++i) {
      const double along = inertia_[static_cast<std::size_t>(b.u + i)];
      if (!(along > 0)) continue;
      w.mobility += b.is_length(i) ? 1 / along : length_ * length_ / along;
      if (!b.is_length(i) && !(lever > least_lever * length_)) continue;
      const double mass = b.is_length(i) ? along : along / (lever * lever);
      if (w.lightest < 0 || mass < w.of_lightest) w.lightest = k, w.of_lightest = mass;
      if (w.heaviest < 0 || mass > w.of_heaviest) w.heaviest = k, w.of_heaviest = mass;
    }
  }

  const Tree& tree_;
  const std::vector<double>& inertia_;
  std::vector<Eigen::Isometry3d> poses_;
  double length_;
};

}  // namespace

template <class Space>
LoopWeights weigh_loops(const LoopModel<Space>& loops, const Tree& tree,
                        const std::vector<double>& inertia, double length) {
  const Scales scales(tree, inertia, length);
  LoopWeights weights;
  double lightest = HUGE_VAL, heaviest = 0;
  for (const auto& l : loops.loops) {
    const Weighed w =
        scales.of(l, l.is_pair() ? loops.pairs[static_cast<std::size_t>(l.pair)].get() : nullptr);
    weights.least_scales.push_back(l.is_coupler() ? 0 : least_lever * least_lever * w.mobility);
    if (w.lightest < 0) continue;
    lightest = std::min(lightest, w.of_lightest);
    heaviest = std::max(heaviest, w.of_heaviest);
    if (!(w.of_heaviest > weights.apart * w.of_lightest)) continue;
    weights.apart = w.of_heaviest / w.of_lightest;
    char times[32];
    std::snprintf(times, sizeof times, "%.0e", weights.apart);
    weights.light = "what turns about " + tree.joint_in_words(w.lightest) + " is " + times +
                    " times lighter than what turns about " + tree.joint_in_words(w.heaviest) +
                    " in its loop";
  }
  if (heaviest > 0) weights.spread = heaviest / lightest;
  return weights;
}

template LoopWeights weigh_loops(const LoopModel<Planar>&, const Tree&, const std::vector<double>&,
                                 double);
template LoopWeights weigh_loops(const LoopModel<Spatial>&, const Tree&, const std::vector<double>&,
                                 double);

}  // namespace momenta
