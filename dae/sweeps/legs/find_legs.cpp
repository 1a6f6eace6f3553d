#include <momenta/dae/sweeps/legs/legs.h>

#include <algorithm>
#include <map>

namespace momenta {
namespace {

/// Joints and loops of a leg as numbers: equal of legs of one shape.
using LegShape = std::vector<int>;

struct Leg {
  int root = 0, end = 0;   ///< its bodies: [root, end)
  std::vector<int> loops;  ///< of the model
  bool fits = true;        ///< may be taken beside others
};

bool is_slide(const Model<Spatial>::Body& b) {
  return b.kind == JointKind::prismatic && b.drive < 0 && b.nv == 1;
}

LegShape shape_of(const LinkTree& tree, const LoopModel<Spatial>& loops, const Leg& leg, int onto) {
  LegShape shape{onto, leg.end - leg.root};
  for (int k = leg.root; k < leg.end; ++k)
    shape.push_back(tree.links[static_cast<std::size_t>(k)].kind == LinkKind::pin);
  for (const int i : leg.loops) {
    const auto& l = loops.loops[static_cast<std::size_t>(i)];
    const bool on_a = l.b == onto;
    shape.insert(shape.end(),
                 {(on_a ? l.a : l.b) - leg.root, on_a, l.is_distance(), l.n_points, l.n_axes});
    shape.insert(shape.end(), l.points.begin(), l.points.end());
    for (const auto& [x, y] : l.axes) shape.insert(shape.end(), {x, y});
  }
  return shape;
}

LoopPlan plan_of(const LoopModel<Spatial>& loops, const Leg& leg, int onto) {
  std::vector<int> parents{-1, -1};
  for (int k = leg.root + 1; k < leg.end; ++k) parents.push_back(k - leg.root);
  const auto here = [&](int body) { return body == onto ? 0 : body - leg.root + 1; };
  std::vector<LoopShape> shapes;
  for (const int i : leg.loops) {
    const auto& l = loops.loops[static_cast<std::size_t>(i)];
    shapes.push_back({here(l.a), here(l.b), l.rows});
  }
  return plan_folded(parents, shapes);
}

/// By root: the legs that are folded.
std::map<int, Leg> folded_legs(const LinkTree& tree, const LoopModel<Spatial>& loops,
                               const LoopPlan& plan) {
  std::map<int, Leg> legs;
  std::vector<int> leg_of(tree.links.size(), -1);
  for (std::size_t k = 0; k < tree.links.size(); ++k) {
    const Link& l = tree.links[k];
    const int here = static_cast<int>(k);
    leg_of[k] = l.parent >= 0              ? leg_of[static_cast<std::size_t>(l.parent)]
                : plan.folded_onto[k] >= 0 ? here
                                           : -1;
    if (leg_of[k] < 0) continue;
    Leg& leg = legs[leg_of[k]];
    leg.root = leg_of[k];
    leg.end = here + 1;
    leg.fits = leg.fits && (here == leg.root || l.first) &&
               (l.kind == LinkKind::pin || is_slide(tree.model->bodies[k]));
  }
  for (std::size_t i = 0; i < loops.loops.size(); ++i) {
    const auto& l = loops.loops[i];
    for (const int end : {l.a, l.b}) {
      if (end < 0 || leg_of[static_cast<std::size_t>(end)] < 0) continue;
      Leg& leg = legs[leg_of[static_cast<std::size_t>(end)]];
      const int onto = plan.folded_onto[static_cast<std::size_t>(leg.root)];
      leg.fits = leg.fits && (end == l.a ? l.b : l.a) == onto && l.motion < 0 && !l.is_coupler();
      leg.loops.push_back(static_cast<int>(i));
    }
  }
  return legs;
}

}  // namespace

LegGroups::LegGroups() = default;
LegGroups::~LegGroups() = default;
LegGroups::LegGroups(LegGroups&&) noexcept = default;

LegGroups find_legs(const LinkTree& tree, const LoopModel<Spatial>& loops, const LoopPlan& plan,
                    int lanes) {
  // A pack of any number of legs costs as much as two and a half legs one by one.
  constexpr int least = 3;
  LegGroups all;
  std::map<LegShape, std::vector<const Leg*>> shapes;
  const auto legs = folded_legs(tree, loops, plan);
  for (const auto& [root, leg] : legs) {
    int rows = 0;
    for (const int i : leg.loops) rows += loops.loops[static_cast<std::size_t>(i)].rows;
    if (leg.fits && rows <= most_leg_rows)
      shapes[shape_of(tree, loops, leg, plan.folded_onto[static_cast<std::size_t>(root)])]
          .push_back(&leg);
  }
  all.bodies.assign(tree.links.size(), 0);
  all.loops.assign(loops.loops.size(), 0);
  for (const auto& [shape, alike] : shapes) {
    const int total = static_cast<int>(alike.size());
    for (int first = 0; first < total; first += lanes) {
      const int count = std::min(lanes, total - first);
      if (count < std::min(least, lanes)) break;
      const auto leg = [&, &legs_of_shape = alike](int lane) {
        return *legs_of_shape[static_cast<std::size_t>(first + std::min(lane, count - 1))];
      };
      LegGroup g;
      g.onto = shape.front();
      g.lanes = lanes;
      g.count = count;
      g.bodies = leg(0).end - leg(0).root;
      g.loops = static_cast<int>(leg(0).loops.size());
      for (int lane = 0; lane < lanes; ++lane) {
        g.roots.push_back(leg(lane).root);
        for (int k = leg(lane).root; k < leg(lane).end; ++k)
          all.bodies[static_cast<std::size_t>(k)] = 1;
      }
      for (int i = 0; i < g.loops; ++i) {
        for (int lane = 0; lane < lanes; ++lane) {
          g.loop.push_back(leg(lane).loops[static_cast<std::size_t>(i)]);
          all.loops[static_cast<std::size_t>(g.loop.back())] = 1;
        }
      }
      g.plan = plan_of(loops, leg(0), g.onto);
      all.groups.push_back(std::move(g));
    }
  }
  return all;
}

std::string legs_in_words(const LegGroups& legs) {
  std::string words;
  for (const LegGroup& g : legs.groups)
    words += (words.empty() ? "" : ", ") + std::to_string(g.count) + " legs of " +
             std::to_string(g.bodies) + (g.bodies == 1 ? " body" : " bodies") +
             " side by side in " + std::to_string(g.lanes) + " lanes";
  return words;
}

}  // namespace momenta
