// Rows of each front, order of fronts, and places of their numbers.

#include <momenta/dae/kkt/factor/body_fronts.h>

#include <algorithm>
#include <map>
#include <utility>

namespace momenta {
struct BodyFronts::Structure {
  Structure(BodyFronts& into, const Bodies& of, const std::vector<KktPattern::Entry>& matrix, int m)
      : fronts(into),
        bodies(of),
        entries(matrix),
        d(of.d),
        count(static_cast<int>(of.parent.size())),
        rows(m) {}

  BodyFronts& fronts;
  const Bodies& bodies;
  const std::vector<KktPattern::Entry>& entries;
  int d, count, rows;
  std::vector<int> of_body, of_ground;  ///< fronts; the ground's once a root has come, by root
  std::vector<int> root;                ///< per body
  std::vector<std::vector<int>> ends;   ///< per row: bodies at whose fronts it enters
  std::vector<std::vector<int>> ties;   ///< per row: bodies whose joints it ties
  std::vector<int> closing;             ///< per row: front
  std::map<std::pair<int, int>, std::size_t> end_value, tie_value;  ///< by row and body, or rate

  int body_of(int unknown) const { return unknown / d % count; }
  bool is_velocity(int i) const { return i < d * count; }
  bool is_momentum(int i) const { return i >= d * count && i < 2 * d * count; }
  int rate_of(int i) const { return i - 2 * d * count; }
  bool is_rate(int i) const { return rate_of(i) >= 0 && rate_of(i) < bodies.nv; }
  int row_of(int i) const { return rate_of(i) - bodies.nv; }

  /// Finds the bodies and joints of each row from its entries.
  void read() {
    ends.resize(at(rows));
    ties.resize(at(rows));
    std::vector<int> of_rate(at(bodies.nv), -1);
    for (int k = 0; k < count; ++k)
      for (int j = 0; j < bodies.rates[at(k)]; ++j) of_rate[at(bodies.rate[at(k)] + j)] = k;
    const auto once = [](std::vector<int>& in, int k) {
      if (std::find(in.begin(), in.end(), k) == in.end()) in.push_back(k);
    };
    for (const auto& e : entries) {
      if (row_of(e.row) < 0) continue;
      if (is_rate(e.column))
        once(ties[at(row_of(e.row))], of_rate[at(rate_of(e.column))]);
      else
        once(ends[at(row_of(e.row))], body_of(e.column));
    }
  }

  /// Bodies from the last to the first, the ground after each root.
  void order() {
    of_body.resize(at(count));
    of_ground.assign(at(count), -1);
    root.resize(at(count));
    for (int k = 0; k < count; ++k)
      root[at(k)] = bodies.parent[at(k)] < 0 ? k : root[at(bodies.parent[at(k)])];
    for (int k = count; k-- > 0;) {
      Front f;
      f.d = d;
      f.body = k;
      f.above = bodies.parent[at(k)] < 0 ? 0 : d;
      f.rate = bodies.rate[at(k)];
      f.rates = bodies.rates[at(k)];
      of_body[at(k)] = static_cast<int>(fronts.fronts_.size());
      fronts.fronts_.push_back(f);
      if (bodies.parent[at(k)] < 0) {
        of_ground[at(k)] = static_cast<int>(fronts.fronts_.size());
        fronts.fronts_.push_back({});
      }
    }
    int ground = -1;
    for (int k = count; k-- > 0;) {
      const int parent = bodies.parent[at(k)];
      fronts.fronts_[at(of_body[at(k)])].parent = parent < 0 ? of_ground[at(k)] : -2;
      if (parent >= 0) continue;
      if (ground >= 0) fronts.fronts_[at(ground)].parent = of_ground[at(k)];
      ground = of_ground[at(k)];
    }
    for (int k = 0; k < count; ++k)
      if (bodies.parent[at(k)] >= 0)
        fronts.fronts_[at(of_body[at(k)])].parent = of_body[at(bodies.parent[at(k)])];
  }

  /// A row closes where all it hangs on has come together: at the lowest common ancestor of its
  /// ends and of the parents of the joints it ties.
  void close() {
    closing.resize(at(rows));
    for (int i = 0; i < rows; ++i) {
      int first_root = count, meet = -2;
      const auto take = [&](int k) {
        if (meet == -2) meet = k;
        int other = k;
        while (meet != other) {  // the later of the two is no ancestor of the other
          int& later = meet > other ? meet : other;
          later = bodies.parent[at(later)];
        }
      };
      for (const int k : ends[at(i)]) {
        first_root = std::min(first_root, root[at(k)]);
        take(k);
      }
      for (const int k : ties[at(i)]) {
        first_root = std::min(first_root, root[at(k)]);
        take(bodies.parent[at(k)]);
      }
      // A loop with one end has the ground for the other.
      if (ties[at(i)].empty() && ends[at(i)].size() == 1) meet = -1;
      closing[at(i)] = meet >= 0 ? of_body[at(meet)] : of_ground[at(first_root)];
    }
  }

  /// The rows of each front: those that its children bring, its ends and ties.
  void gather() {
    std::vector<std::vector<int>> present(fronts.fronts_.size()), below(fronts.fronts_.size());
    for (int i = 0; i < rows; ++i) {
      for (const int k : ends[at(i)]) present[at(of_body[at(k)])].push_back(i);
      for (const int k : ties[at(i)]) present[at(of_body[at(k)])].push_back(i);
    }
    for (int k = 0; k < static_cast<int>(fronts.fronts_.size()); ++k) {
      Front& f = fronts.fronts_[at(k)];
      std::vector<int>& here = present[at(k)];
      std::sort(here.begin(), here.end());
      here.erase(std::unique(here.begin(), here.end()), here.end());
      const auto middle = std::stable_partition(here.begin(), here.end(),
                                                [&](int i) { return closing[at(i)] != k; });
      f.row = fronts.row_.size();
      f.go_on = static_cast<int>(middle - here.begin());
      f.close = static_cast<int>(here.end() - middle);
      fronts.row_.insert(fronts.row_.end(), here.begin(), here.end());
      f.below = fronts.below_.size();
      fronts.below_.insert(fronts.below_.end(), below[at(k)].rbegin(), below[at(k)].rend());
      f.last = fronts.below_.size();
      if (f.parent >= 0) {
        below[at(f.parent)].push_back(k);
        auto& above = present[at(f.parent)];
        above.insert(above.end(), here.begin(), middle);
      }
    }
    for (Front& f : fronts.fronts_) {
      f.up = fronts.up_.size();
      for (int i = 0; i < f.go_on && f.parent >= 0; ++i) {
        const Front& to = fronts.fronts_[at(f.parent)];
        fronts.up_.push_back(place_in(to, fronts.row_[f.row + at(i)]));
      }
    }
  }
  /// Place of a row among those of a front.
  int place_in(const Front& f, int row) const {
    const auto first = fronts.row_.begin() + static_cast<std::ptrdiff_t>(f.row);
    const auto middle = first + f.go_on, last = middle + f.close;
    if (const auto found = std::lower_bound(first, middle, row); found != middle && *found == row)
      return static_cast<int>(found - first);
    return static_cast<int>(std::lower_bound(middle, last, row) - first);
  }

  void lay_out() {
    std::size_t value = 0, column = 0, pivot = 0, most = 0, top = 0, highest = 0;
    const auto take = [](std::size_t& total, int n) {
      const std::size_t first = total;
      total += at(n);
      return first;
    };
    std::vector<std::vector<int>> ends_at(at(count)), ties_at(at(count));
    for (int i = 0; i < rows; ++i) {
      for (const int k : ends[at(i)]) ends_at[at(k)].push_back(i);
      for (const int k : ties[at(i)]) ties_at[at(k)].push_back(i);
    }
    for (Front& f : fronts.fronts_) {
      const int n = f.rates;
      f.mass = take(value, f.d * f.d);
      f.transfer = take(value, f.d * f.above);
      f.axes = take(value, f.d * n);
      f.rotors = take(value, n);
      f.end = fronts.ends_.size();
      f.tie = fronts.ties_.size();
      if (f.body >= 0) {
        for (const int i : ends_at[at(f.body)]) {
          end_value[{i, f.body}] = value;
          fronts.ends_.push_back({place_in(f, i), take(value, d)});
        }
        for (const int i : ties_at[at(f.body)])
          for (int j = 0; j < n; ++j) {
            tie_value[{i, f.rate + j}] = value;
            fronts.ties_.push_back({place_in(f, i), j, take(value, 1)});
          }
      }
      f.ends = fronts.ends_.size();
      f.ties = fronts.ties_.size();
      f.column = take(column, f.close * f.size() + n * f.left());
      f.coupled = take(column, n * n);
      f.pivot = take(pivot, f.close + n);
      most = std::max(most, at(f.size()) * at(f.size()));
      for (std::size_t i = f.below; i < f.last; ++i) {
        const auto passed = at(fronts.fronts_[at(fronts.below_[i])].passed());
        top -= passed * passed;
      }
      top += at(f.passed()) * at(f.passed());
      highest = std::max(highest, top);
    }
    fronts.value_.resize(value);
    fronts.column_.resize(column);
    fronts.inverse_.resize(pivot);
    fronts.turn_.resize(pivot);
    fronts.a_.resize(most);
    fronts.work_.resize(std::max(most, std::size_t{36}));
    fronts.stack_.resize(highest);
    fronts.motion_.resize(fronts.fronts_.size() * at(d));
    fronts.pivot_.resize(at(rows));
    fronts.given_.resize(entries.size());
  }

  /// Finds the targets of entries.
  void place() {
    for (const auto& e : entries) {
      const auto [i, j] = std::pair{e.row, e.column};
      if (row_of(i) >= 0) {
        const std::size_t to = is_rate(j) ? tie_value.at({row_of(i), rate_of(j)})
                                          : end_value.at({row_of(i), body_of(j)}) + at(j % d);
        fronts.target_.push_back({to, to});
        continue;
      }
      if (is_rate(i)) {  // I_r
        const Front& f = front_of_rate(rate_of(i));
        const std::size_t to = f.rotors + at(rate_of(i) - f.rate);
        fronts.target_.push_back({to, to});
        continue;
      }
      const Front& f = fronts.fronts_[at(of_body[at(body_of(i))])];
      const int c = i % d, e_column = j % d;
      if (is_velocity(i)) {
        fronts.target_.push_back({f.mass + at(d * e_column + c), f.mass + at(d * c + e_column)});
      } else if (is_rate(j)) {
        const std::size_t to = f.axes + at(d * (rate_of(j) - f.rate) + c);
        fronts.target_.push_back({to, to});
      } else if (body_of(j) == f.body) {
        fronts.target_.push_back({none, none});  // −1 of (23)
      } else {
        const std::size_t to = f.transfer + at(d * e_column + c);
        fronts.target_.push_back({to, to});
      }
    }
  }
  const Front& front_of_rate(int rate) const {
    const auto after = std::upper_bound(bodies.rate.begin(), bodies.rate.end(), rate);
    auto k = static_cast<int>(after - bodies.rate.begin()) - 1;
    while (bodies.rates[at(k)] == 0) --k;
    return fronts.fronts_[at(of_body[at(k)])];
  }
};

BodyFronts::BodyFronts(const Bodies& bodies, const std::vector<KktPattern::Entry>& entries,
                       const std::vector<int>& groups)
    : nv_(bodies.nv), d_(bodies.d) {
  for (const int group : groups) group_.push_back(group / 2);
  Structure s(*this, bodies, entries, static_cast<int>(groups.size()));
  s.read();
  s.order();
  s.close();
  s.gather();
  s.lay_out();
  s.place();
}

}  // namespace momenta
