#include <momenta/dae/kkt/sweeps/slots/open_slots.h>

#include <algorithm>
#include <set>

namespace momenta {
namespace {

SlotGroups groups_of(int slot, int rows) {
  SlotGroups groups = 0;
  for (int i = slot; i < slot + rows; ++i) groups |= SlotGroups{1} << (i / 2);
  return groups;
}

}  // namespace

OpenSlots::OpenSlots(const LoopPlan& plan, const std::vector<int>& parents,
                     const std::vector<int>& rows)
    : fronts(parents.size()), beside(rows.size()) {
  const std::size_t n = parents.size();
  const auto groups = [&](int loop) {
    const auto i = static_cast<std::size_t>(loop);
    return groups_of(plan.slot[i], rows[i]);
  };
  const auto closings = [&](const LoopPlan::Range& range) {
    return std::vector<int>(plan.closings.begin() + range.first,
                            plan.closings.begin() + range.last);
  };
  const auto groups_of_all = [&](const std::set<int>& loops) {
    SlotGroups all = 0;
    for (const int loop : loops) all |= groups(loop);
    return all;
  };
  std::vector<int> closes_at(rows.size(), -1), last_root(rows.size(), -1);
  for (std::size_t k = 0; k < n; ++k)
    for (const int loop : closings(plan.closings_of[k])) {
      closes_at[static_cast<std::size_t>(loop)] = static_cast<int>(k);
      fronts[k].all |= groups(loop);
    }
  for (std::size_t k = 0; k < n; ++k)
    for (const int loop : closings(plan.gathered_closings_of[k]))
      closes_at[static_cast<std::size_t>(loop)] = parents[k];
  std::vector<std::vector<int>> opened(n);  // loops that children but the first hand to the parent
  // Every loop is open from its ends, or the joints it couples, up to where it closes.
  const auto climb = [&](int loop, std::size_t from) {
    const auto at = static_cast<std::size_t>(loop);
    int k = static_cast<int>(from), root = -1;
    for (; k != closes_at[at]; k = parents[static_cast<std::size_t>(k)]) {
      fronts[static_cast<std::size_t>(k)].open |= groups(loop);
      fronts[static_cast<std::size_t>(k)].all |= groups(loop);
      if (parents[static_cast<std::size_t>(k)] != k - 1)
        opened[static_cast<std::size_t>(k)].push_back(loop);
      root = k;
    }
    if (k < 0) last_root[at] = std::max(last_root[at], root);
  };
  for (std::size_t k = 0; k < n; ++k) {
    for (int i = plan.ends_of[k].first; i < plan.ends_of[k].last; ++i)
      climb(plan.ends[static_cast<std::size_t>(i)].loop, k);
    for (int i = plan.couplings_of[k].first; i < plan.couplings_of[k].last; ++i)
      climb(plan.couplings[static_cast<std::size_t>(i)].loop, k);
  }
  // Slots open at the ground: of a loop from its last root to the one that closes it.
  std::vector<SlotGroups> stays(n, 0);
  for (std::size_t k = 0; k < n; ++k)
    if (parents[k] < 0 && plan.folded_onto[k] < 0)
      for (const int loop : closings(plan.gathered_closings_of[k])) {
        fronts[k].gathered |= groups(loop);
        for (int r = last_root[static_cast<std::size_t>(loop)]; r > static_cast<int>(k); --r)
          if (parents[static_cast<std::size_t>(r)] < 0) {
            fronts[static_cast<std::size_t>(r)].gathered |= groups(loop);
            stays[static_cast<std::size_t>(r)] |= groups(loop);
          }
      }
  const auto close = [&](const LoopPlan::Range& range, SlotGroups open) {
    for (int i = range.last; i-- > range.first;) {
      const int loop = plan.closings[static_cast<std::size_t>(i)];
      beside[static_cast<std::size_t>(loop)] = open;
      open |= groups(loop);
    }
  };
  SlotGroups arrived = 0;                  // slots of the ground before a root
  std::vector<std::set<int>> gathered(n);  // by parent: loops open where its children are gathered
  for (std::size_t k = n; k-- > 0;) {
    Front& here = fronts[k];
    const bool continues = k + 1 < n && parents[k + 1] == static_cast<int>(k);
    here.fresh = here.all & ~(continues ? fronts[k + 1].open : 0);
    if (plan.closings_of[k].first == plan.closings_of[k].last)
      here.born = here.open & here.fresh & ~here.slot;
    close(plan.closings_of[k], here.open);
    if (parents[k] < 0) {
      here.gathered_fresh = here.gathered & ~arrived;
      close(plan.gathered_closings_of[k], stays[k]);
      arrived = stays[k];
    } else if (parents[k] != static_cast<int>(k) - 1) {
      std::set<int>& open = gathered[static_cast<std::size_t>(parents[k])];
      const SlotGroups before = groups_of_all(open);
      open.insert(opened[k].begin(), opened[k].end());
      here.gathered = groups_of_all(open);
      here.gathered_fresh = here.gathered & ~before;
      for (const int loop : closings(plan.gathered_closings_of[k])) open.erase(loop);
      Front& parent = fronts[static_cast<std::size_t>(parents[k])];
      parent.slot = groups_of_all(open);
      parent.brought |= here.open != 0;
      close(plan.gathered_closings_of[k], parent.slot);
    }
  }
}

OpenSlots::~OpenSlots() = default;

}  // namespace momenta
