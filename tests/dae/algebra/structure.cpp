// Structural analysis against what is obviously right: all permutations, all offsets in turn.

#include <gtest/gtest.h>
#include <momenta/dae/algebra/structure/assignment.h>
#include <momenta/dae/algebra/structure/sigma_method.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace momenta::dae_structure {
namespace {

using structure::at;
using structure::Signature;

Signature random_signature(int n, double density, int highest, std::mt19937& random) {
  std::bernoulli_distribution there(density);
  std::uniform_int_distribution<int> order(0, highest);
  Signature s(n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (there(random)) s(i, j) = order(random);
  return s;
}

/// The best sum over all permutations; absent: none takes every equation to a variable it has.
int best_of_all(const Signature& s) {
  std::vector<int> p(at(s.size()));
  std::iota(p.begin(), p.end(), 0);
  int best = Signature::absent;
  do {
    int sum = 0;
    bool all = true;
    for (int i = 0; i < s.size() && all; ++i) {
      all = s.has(i, p[at(i)]);
      if (all) sum += s(i, p[at(i)]);
    }
    if (all) best = std::max(best, sum);
  } while (std::next_permutation(p.begin(), p.end()));
  return best;
}

TEST(Structure, TheAssignmentIsTheBestOfAllPermutations) {
  std::mt19937 random(1);
  int none = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 1 + trial % 6;
    const Signature s = random_signature(n, 0.4, 3, random);
    const int best = best_of_all(s);
    const auto found = structure::highest_assignment(s);
    ASSERT_EQ(found.has_value(), best != Signature::absent) << trial;
    if (!found) {
      ++none;
      continue;
    }
    int sum = 0;
    std::vector<char> taken(at(n));
    for (int i = 0; i < n; ++i) {
      sum += s(i, (*found)[at(i)]);
      EXPECT_FALSE(taken[at((*found)[at(i)])]++);
    }
    EXPECT_EQ(sum, best) << trial;
  }
  EXPECT_GT(none, 50);
}

TEST(Structure, OffsetsAreValidAndTheLeast) {
  std::mt19937 random(2);
  int looked_at = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 1 + trial % 4;
    const Signature s = random_signature(n, 0.6, 2, random);
    const auto o = structure::sigma_method(s);
    if (!o) continue;
    ++looked_at;
    // Of all c up to 4 each that are valid for this transversal, the sum of the least.
    int least = 1 << 20;
    std::vector<int> c(at(n), 0);
    for (bool more = true; more;) {
      bool valid = true;
      std::vector<int> d(at(n));
      for (int i = 0; i < n; ++i) {
        const int j = o->transversal[at(i)];
        d[at(j)] = c[at(i)] + s(i, j);
      }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) valid &= !s.has(i, j) || d[at(j)] - c[at(i)] >= s(i, j);
      if (valid) least = std::min(least, std::accumulate(c.begin(), c.end(), 0));
      int k = 0;
      while (k < n && ++c[at(k)] > 4) c[at(k++)] = 0;
      more = k < n;
    }
    EXPECT_EQ(std::accumulate(o->equation.begin(), o->equation.end(), 0), least) << trial;
    EXPECT_EQ(o->freedom, best_of_all(s)) << trial;
  }
  EXPECT_GT(looked_at, 100);
}

TEST(Structure, PantelidesDifferentiatesWhatTheOffsetsSay) {
  std::mt19937 random(3);
  int looked_at = 0, differentiated = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 1 + trial % 8;
    const Signature s = random_signature(n, 0.35, 1, random);
    const auto o = structure::sigma_method(s);
    if (!o) continue;
    ++looked_at;
    differentiated += *std::max_element(o->equation.begin(), o->equation.end()) > 1;
    EXPECT_EQ(structure::pantelides(s), o->equation) << trial;
  }
  EXPECT_GT(looked_at, 400);
  EXPECT_GT(differentiated, 20);
}

TEST(Structure, PermutationsPermuteTheOffsets) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 2 + trial % 6;
    const Signature s = random_signature(n, 0.5, 1, random);
    const auto o = structure::sigma_method(s);
    std::vector<int> p(at(n)), q(at(n));
    std::iota(p.begin(), p.end(), 0);
    std::iota(q.begin(), q.end(), 0);
    std::shuffle(p.begin(), p.end(), random);
    std::shuffle(q.begin(), q.end(), random);
    Signature other(n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) other(i, j) = s(p[at(i)], q[at(j)]);
    const auto permuted = structure::sigma_method(other);
    ASSERT_EQ(o.has_value(), permuted.has_value());
    if (!o) continue;
    EXPECT_EQ(o->index, permuted->index);
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(permuted->equation[at(i)], o->equation[at(p[at(i)])]);
      EXPECT_EQ(permuted->variable[at(i)], o->variable[at(q[at(i)])]);
    }
  }
}

TEST(Structure, DeficientBlocksHoldFewerVariablesThanEquations) {
  std::mt19937 random(5);
  int deficient = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 2 + trial % 5;
    const Signature s = random_signature(n, 0.3, 1, random);
    const structure::Deficiency d = structure::deficiency(s);
    ASSERT_EQ(d.equations.empty(), best_of_all(s) != Signature::absent) << trial;
    ASSERT_EQ(d.equations.empty(), d.variables.empty());
    if (d.equations.empty()) continue;
    ++deficient;
    // Hall: the equations have no other variables than theirs, which are too few; variables alike.
    EXPECT_LT(d.their_variables.size(), d.equations.size());
    EXPECT_LT(d.their_equations.size(), d.variables.size());
    const auto in = [](const std::vector<int>& list, int x) {
      return std::find(list.begin(), list.end(), x) != list.end();
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        if (!s.has(i, j)) continue;
        EXPECT_TRUE(!in(d.equations, i) || in(d.their_variables, j)) << trial;
        EXPECT_TRUE(!in(d.variables, j) || in(d.their_equations, i)) << trial;
      }
  }
  EXPECT_GT(deficient, 100);
}

}  // namespace
}  // namespace momenta::dae_structure
