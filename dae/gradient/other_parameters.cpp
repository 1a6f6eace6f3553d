#include <momenta/dae/gradient/linear_formulas.h>
#include <momenta/dae/gradient/other_parameters.h>
#include <momenta/dae/gradient/scene_difference.h>

#include <algorithm>
#include <optional>
#include <set>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Slopes of the numbers of scenes near θ; empty where the formulas of sixth_order.h differ:
/// numbers jump at θ, as where a frame is chosen anew.
VectorXd numbers_by(const NumberSlopes& slopes, const Scene& own, Neighbours& near) {
  double of = 0;
  std::vector<VectorXd> made;
  const sixth_order::Slope slope =
      sixth_order::slope_of(near.h(), sixth_order::read, [&](std::size_t i, double h) {
        if (i == sixth_order::middle) return slopes.numbers(own);
        if (h != of) {
          made.clear();
          for (const Scene& scene : near.scenes(h)) made.push_back(slopes.numbers(scene));
          if (std::any_of(made.begin(), made.end(),
                          [&](const VectorXd& all) { return all.size() != slopes.size(); }))
            made.assign(made.size(), VectorXd());
          of = h;
        }
        return made[i];
      });
  if (slope.by.size() == 0) return {};
  const bool known = slope.agrees || slope.apart <= 1e-4 * slope.by.cwiseAbs().maxCoeff();
  return known ? slope.by : VectorXd();
}

/// Derivatives by numbers of bodies, joints, loops and springs: six readings of the scene with all
/// moved that share nothing. Formulas know parameters alone: such a number is in no other body. A
/// number that a reading refuses, or that changes more than its share, is taken alone.
class OwnNumbers {
 public:
  OwnNumbers(const SceneText& scene, const NumberSlopes& slopes, const SceneDifference& same,
             const Scene& own)
      : scene_(scene), slopes_(slopes), same_(same), own_(slopes.numbers(own)) {}

  void take(const std::vector<RunVariable>& variables, std::vector<OtherParameter>& all) {
    std::vector<NumberSlopes::Share> shares(variables.size());
    for (std::size_t j = 0; j < variables.size(); ++j)
      if (variables[j].kind == RunVariable::Kind::parameter)
        shares[j] = slopes_.of(variables[j].name);
    while (true) {
      std::vector<std::size_t> together;
      std::set<Index> parts;
      for (std::size_t j = 0; j < variables.size(); ++j)
        if (is_apart(shares[j], parts)) together.push_back(j);
      if (together.size() < 2 || !read(variables, together, shares, all)) return;
      for (const std::size_t j : together) {
        all[j].of_places = shares[j].of_places;
        shares[j] = {};
      }
    }
  }

 private:
  /// Whether a share has no part in common with `parts`; then adds it to them.
  static bool is_apart(const NumberSlopes::Share& share, std::set<Index>& parts) {
    if (share.ranges.empty()) return false;
    for (const auto& range : share.ranges)
      if (parts.contains(range.first)) return false;
    for (const auto& range : share.ranges) parts.insert(range.first);
    return true;
  }

  bool read(const std::vector<RunVariable>& variables, const std::vector<std::size_t>& together,
            const std::vector<NumberSlopes::Share>& shares, std::vector<OtherParameter>& all) {
    std::vector<bool> moves(static_cast<std::size_t>(own_.size()), false);
    bool of_places = false;
    for (const std::size_t j : together) {
      of_places = of_places || shares[j].of_places;
      for (const auto& range : shares[j].ranges)
        std::fill_n(moves.begin() + range.first, range.count, true);
    }
    std::vector<VectorXd> numbers;
    try {
      for (const auto& [k, weight] : sixth_order::points) {
        std::vector<Setting> moved;
        for (const std::size_t j : together)
          moved.push_back({variables[j].name, variables[j].value + k * all[j].h});
        const Scene made = scene_.scene(moved);
        if (same_.of(made) > (of_places ? Change::places : Change::inertias_and_forces))
          return false;
        const VectorXd& n = numbers.emplace_back(slopes_.numbers(made));
        if (n.size() != own_.size()) return false;
        for (Index i = 0; i < n.size(); ++i)
          if (!moves[static_cast<std::size_t>(i)] && n[i] != own_[i]) return false;
      }
    } catch (const std::exception&) {  // each number's own reading tells which
      return false;
    }
    const VectorXd none = VectorXd::Zero(own_.size());
    std::vector<VectorXd> taken(together.size(), none);
    for (std::size_t a = 0; a < together.size(); ++a) {
      const std::size_t j = together[a];
      VectorXd fourth = none;
      for (std::size_t i = 0; i < numbers.size(); ++i)
        for (const auto& range : shares[j].ranges) {
          const auto its = numbers[i].segment(range.first, range.count);
          taken[a].segment(range.first, range.count) +=
              sixth_order::points[i].weight / all[j].h * its;
          if (i < sixth_order::fourth.size())
            fourth.segment(range.first, range.count) += sixth_order::fourth[i] / all[j].h * its;
        }
      // A number that jumps is taken alone, and the rest with it.
      if (!((taken[a] - fourth).cwiseAbs().maxCoeff() <= 1e-6 * taken[a].cwiseAbs().maxCoeff()))
        return false;
    }
    for (std::size_t a = 0; a < together.size(); ++a)
      all[together[a]].numbers = std::move(taken[a]);
    return true;
  }

  const SceneText& scene_;
  const NumberSlopes& slopes_;
  const SceneDifference& same_;
  VectorXd own_;
};

}  // namespace

std::vector<OtherParameter> other_parameters(const SceneText& scene, const Mechanism& mechanism,
                                             const std::vector<RunVariable>& variables,
                                             const TakenAtOnce& at_once) {
  std::vector<OtherParameter> all(variables.size());
  const NumberSlopes* const slopes = at_once.slopes;
  std::optional<SceneDifference> same, plain;
  for (std::size_t j = 0; j < variables.size(); ++j)
    all[j].h = sixth_order::part * variables[j].size;
  if (slopes) {
    same.emplace(mechanism.scene(),
                 slopes->of_drives()   ? Change::drives
                 : slopes->of_places() ? Change::places
                                       : Change::inertias_and_forces,
                 Forces::all);
    if (at_once.plain_forces)
      plain.emplace(mechanism.scene(),
                    slopes->of_plain_places() ? Change::places : Change::inertias_and_forces,
                    Forces::plain);
    if (!at_once.makes_all)
      OwnNumbers(scene, *slopes, plain ? *plain : *same, mechanism.scene()).take(variables, all);
  }
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const RunVariable& v = variables[j];
    OtherParameter& other = all[j];
    if (v.kind != RunVariable::Kind::parameter) {
      other.starts_at_once = at_once.starts;
      continue;
    }
    const auto scenes = [scene, v, &own = mechanism.scene()](double h) {
      std::vector<Scene> near;
      for (const auto& [k, weight] : sixth_order::points)
        near.push_back(scene.scene({{v.name, v.value + k * h}}));
      make_formulas_linear(own, h, near);
      return near;
    };
    auto near = std::make_unique<Neighbours>(v, other.h, scenes, mechanism, scene.options);
    if (slopes && other.numbers.size() == 0) {
      const auto change = [&](const SceneDifference& alone) {
        Change largest = Change::inertias_and_forces;
        for (const Scene& made : near->scenes()) largest = std::max(largest, alone.of(made));
        return largest;
      };
      const Change whole = change(*same);
      VectorXd numbers;
      if (whole != Change::more) numbers = numbers_by(*slopes, mechanism.scene(), *near);
      const bool known = numbers.size() > 0, of_places = known && whole >= Change::places;
      if (of_places && whole == Change::drives) other.drives = mechanism.tree().drives.size();
      if (known && plain && change(*plain) == Change::more) {
        other.at_start = std::move(numbers);
        other.starts_at_once = at_once.slopes_of_start && (!of_places || at_once.starts);
      } else {
        other.numbers = std::move(numbers);
        other.of_places = of_places;
      }
    }
    bool makes = true;
    if (other.numbers.size() > 0) {
      other.starts_at_once = at_once.slopes_of_start && (!other.of_places || at_once.starts);
      makes =
          at_once.makes_all || !other.starts_at_once || (other.of_places && at_once.makes_places);
    }
    other.by_mechanisms = makes;
    if (makes) near->make();
    if (makes || other.drives > 0) other.near = std::move(near);
  }
  return all;
}

}  // namespace momenta
