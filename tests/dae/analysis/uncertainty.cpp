// Samples and what is told of them: points, distributions, statistics, Sobol' indices, against
// known values, direct formulas and functions whose indices are known.

#include <gtest/gtest.h>
#include <momenta/dae/analysis/sample/distribution.h>
#include <momenta/dae/analysis/sample/sample.h>
#include <momenta/dae/analysis/sample/sensitivity.h>
#include <momenta/dae/analysis/sample/sobol_sequence.h>
#include <momenta/dae/analysis/sample/statistics.h>
#include <momenta/dae/study/sweep_statistics.h>

#include <cmath>
#include <numbers>
#include <set>

namespace momenta::laws::dae_uncertainty {
namespace {

using Kind = SampleSettings::Kind;
constexpr double pi = std::numbers::pi;

// Points

TEST(SobolPoints, AreTheKnownOnes) {
  const SobolSequence sequence(3);
  const double known[10][3] = {{0, 0, 0},
                               {0.5, 0.5, 0.5},
                               {0.75, 0.25, 0.25},
                               {0.25, 0.75, 0.75},
                               {0.375, 0.375, 0.625},
                               {0.875, 0.875, 0.125},
                               {0.625, 0.125, 0.875},
                               {0.125, 0.625, 0.375},
                               {0.1875, 0.3125, 0.9375},
                               {0.6875, 0.8125, 0.4375}};
  for (std::uint32_t n = 0; n < 10; ++n)
    for (int j = 0; j < 3; ++j) EXPECT_EQ(sequence.bits(n, j) * 0x1p-32, known[n][j]) << n << j;
}

/// Rank over the field of two elements; columns are bits.
int binary_rank(std::vector<std::uint64_t> rows) {
  int rank = 0;
  while (!rows.empty()) {
    const std::uint64_t pivot = rows.back();
    rows.pop_back();
    if (pivot == 0) continue;
    ++rank;
    for (std::uint64_t& row : rows)
      if (row & pivot & (~pivot + 1)) row ^= pivot;
  }
  return rank;
}

/// Sobol's property A: of every 2^d points in turn one lies in each of the 2^d boxes with sides
/// 1/2. It holds where the first bits of v_1 … v_d of the d dimensions have full rank, and the
/// numbers were chosen so that they have.
TEST(SobolPoints, HavePropertyAInEveryDimension) {
  const SobolSequence sequence(32);
  for (int d = 1; d <= 32; ++d) {
    std::vector<std::uint64_t> rows;
    for (int j = 0; j < d; ++j) {
      std::uint64_t row = 0;
      for (int k = 1; k <= d; ++k)
        row |= static_cast<std::uint64_t>(sequence.direction(j, k) >> 31) << k;
      rows.push_back(row);
    }
    EXPECT_EQ(binary_rank(rows), d);
  }
}

/// All direction numbers, by the FNV-1a digest of those that the published table gives (computed by
/// the recurrence in integers of any length).
TEST(SobolPoints, AreThoseOfTheTableInEveryDimension) {
  const SobolSequence sequence(SobolSequence::most_dimensions);
  std::uint64_t digest = 14695981039346656037ull;
  for (int j = 0; j < SobolSequence::most_dimensions; ++j)
    for (int k = 1; k <= 32; ++k) digest = (digest ^ sequence.direction(j, k)) * 1099511628211ull;
  EXPECT_EQ(digest, 0x96e7b29433e2f043ull);
}

/// Each of the boxes of volume 2^(t-m), whatever its shape, holds 2^t of 2^m points, t the sum of
/// degrees of the polynomials less 1: 0 of the first two dimensions, 1 of three, 3 of four.
TEST(SobolPoints, AreNets) {
  const int m = 10;
  for (const bool shifted : {false, true})
    for (const auto& degrees : {std::pair(2, 0), std::pair(3, 1), std::pair(4, 3)}) {
      const int d = degrees.first, t = degrees.second;
      const SobolSequence sequence(d);
      const Sample sample({Kind::sobol, 1u << m, 7, false}, static_cast<std::size_t>(d));
      std::vector<int> cut(static_cast<std::size_t>(d));
      int shapes = 0;
      const std::function<void(int, int)> every = [&](int j, int left) {
        if (j + 1 < d) {
          for (int c = 0; c <= left; ++c) {
            cut[static_cast<std::size_t>(j)] = c;
            every(j + 1, left - c);
          }
          return;
        }
        cut[static_cast<std::size_t>(j)] = left;
        ++shapes;
        std::map<std::vector<int>, int> boxes;
        for (std::uint32_t n = 0; n < 1u << m; ++n) {
          std::vector<int> box;
          for (int i = 0; i < d; ++i) {
            const double x =
                shifted ? sample.at(n, static_cast<std::size_t>(i)) : sequence.bits(n, i) * 0x1p-32;
            box.push_back(static_cast<int>(std::ldexp(x, cut[static_cast<std::size_t>(i)])));
          }
          ++boxes[box];
        }
        EXPECT_EQ(boxes.size(), 1u << (m - t));
        for (const auto& [box, count] : boxes) EXPECT_EQ(count, 1 << t);
      };
      every(0, m - t);
      EXPECT_GT(shapes, 7);
    }
}

TEST(LatinPoints, AreOneInEachInterval) {
  for (const bool indices : {false, true}) {
    const Sample sample({Kind::latin, 1000, 3, indices}, 4);
    const std::size_t block = sample.cases_of_a_point();
    for (std::size_t of_it = 0; of_it < block; ++of_it)
      for (std::size_t i = 0; i < 4; ++i) {
        std::set<int> strata;
        for (std::size_t n = 0; n < 1000; ++n)
          strata.insert(static_cast<int>(1000 * sample.at(n * block + of_it, i)));
        EXPECT_EQ(strata.size(), 1000u);
      }
  }
}

TEST(RandomPoints, AreEvenAndIndependent) {
  constexpr std::size_t n = 100'000;
  const Sample sample({Kind::random, n, 5, false}, 3);
  const double bound = 4 / std::sqrt(static_cast<double>(n));  // four deviations of these means
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> sorted;
    double next = 0, other = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double x = sample.at(k, i);
      sorted.push_back(x);
      next += 12 * (x - 0.5) * (sample.at((k + 1) % n, i) - 0.5);
      other += 12 * (x - 0.5) * (sample.at(k, (i + 1) % 3) - 0.5);
    }
    EXPECT_LT(std::abs(next) / n, bound);
    EXPECT_LT(std::abs(other) / n, bound);
    std::sort(sorted.begin(), sorted.end());
    double away = 0;  // of Kolmogorov and Smirnov: below 1.95 / √n with probability 0.999
    for (std::size_t k = 0; k < n; ++k)
      away = std::max(away, std::abs(sorted[k] - (static_cast<double>(k) + 0.5) / n));
    EXPECT_LT(away, 1.95 / std::sqrt(static_cast<double>(n)));
  }
}

TEST(Samples, AreFunctionsOfSeedQuantityAndNumber) {
  for (const Kind kind : {Kind::random, Kind::latin, Kind::sobol}) {
    const Sample one({kind, 64, 11, false}, 5), same({kind, 64, 11, false}, 5),
        other({kind, 64, 12, false}, 5);
    int equal = 0;
    for (std::size_t n = 64; n-- > 0;)
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(one.at(n, i), same.at(n, i));
        EXPECT_GT(one.at(n, i), 0);
        EXPECT_LT(one.at(n, i), 1);
        equal += one.at(n, i) == other.at(n, i);
      }
    EXPECT_LT(equal, 10);
  }
  EXPECT_THROW(Sample({Kind::sobol, 8, 1, false}, 65), std::invalid_argument);
  EXPECT_THROW(Sample({Kind::sobol, 8, 1, true}, 33), std::invalid_argument);
  EXPECT_NO_THROW(Sample({Kind::latin, 8, 1, true}, 65));
  EXPECT_THROW(Sample({Kind::random, 0, 1, false}, 1), std::invalid_argument);
  EXPECT_THROW(Sample({Kind::random, 5'000'000, 1, true}, 1), std::invalid_argument);
}

/// A, B and A with one column of B.
TEST(Samples, OfIndicesExchangeOneColumn) {
  for (const Kind kind : {Kind::random, Kind::latin, Kind::sobol}) {
    const std::size_t d = 3;
    const Sample sample({kind, 16, 2, true}, d);
    ASSERT_EQ(sample.cases(), 16 * (d + 2));
    for (std::size_t j = 0; j < 16; ++j) {
      const std::size_t a = j * (d + 2), b = a + 1;
      for (std::size_t k = 0; k < d; ++k)
        for (std::size_t i = 0; i < d; ++i)
          EXPECT_EQ(sample.at(a + 2 + k, i), sample.at(i == k ? b : a, i));
      for (std::size_t i = 0; i < d; ++i) EXPECT_NE(sample.at(a, i), sample.at(b, i));
    }
  }
}

// Distributions

TEST(NormalQuantile, IsTheInverse) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-15);
  EXPECT_NEAR(normal_quantile(0.75), 0.6744897501960817, 1e-15);
  EXPECT_NEAR(normal_quantile(0.1), -1.2815515655446004, 1e-15);
  EXPECT_NEAR(normal_quantile(1e-10), -6.361340902404056, 1e-14);
  EXPECT_EQ(normal_quantile(0.5), 0);
  for (int e = 1; e < 300; ++e) {
    const double u = std::pow(10.0, -e), x = normal_quantile(u);
    // An error of x of one rounding is one of u of x²: d ln Φ = x dx out there.
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / u, 1, 4 * 2.2e-16 * (1 + x * x)) << u;
  }
  for (int i = 1; i < 1000; ++i) {
    const double u = i / 1000.0;
    EXPECT_NEAR(0.5 * std::erfc(-normal_quantile(u) / std::sqrt(2.0)), u, 1e-15);
    EXPECT_NEAR(normal_quantile(u), -normal_quantile(1 - u), 1e-13);
  }
  EXPECT_LT(normal_quantile(1 - 0x1p-53), 8.3);
}

TEST(Distributions, HaveTheirMeansAndDeviations) {
  const Sample sample({Kind::sobol, 1 << 14, 1, false}, 1);
  const auto summary = [&](const char* text) {
    const Distribution d = Varied(text).distribution;
    std::vector<double> x;
    for (std::size_t n = 0; n < sample.cases(); ++n) x.push_back(d.quantile(sample.at(n, 0)));
    return summary_of(x);
  };
  const Summary uniform = summary("a=2:5");
  EXPECT_NEAR(uniform.mean, 3.5, 1e-3);
  EXPECT_NEAR(uniform.deviation, 3 / std::sqrt(12.0), 1e-3);
  const Summary normal = summary("a=normal:-1:0.25");
  EXPECT_NEAR(normal.mean, -1, 1e-3);
  EXPECT_NEAR(normal.deviation, 0.25, 1e-3);
  EXPECT_NEAR(normal.quantiles[4], -1 + 0.25 * 1.6448536269514722, 1e-3);
  const Summary log = summary("a=1:100:log");
  EXPECT_NEAR(log.quantiles[2], 10, 1e-2);
  EXPECT_NEAR(log.mean, 99 / std::log(100.0), 1e-2);
  const Summary choice = summary("a=1,2,6");
  EXPECT_NEAR(choice.mean, 3, 1e-3);
  EXPECT_EQ(choice.least, 1);
  EXPECT_EQ(choice.greatest, 6);
}

// Statistics

TEST(Statistics, AreThoseOfTheDefinition) {
  const Summary s = summary_of({4, 1, 3, 2, std::nan(""), INFINITY});
  EXPECT_EQ(s.count, 4u);
  EXPECT_EQ(s.mean, 2.5);
  EXPECT_NEAR(s.deviation, std::sqrt(5.0 / 3), 1e-15);
  EXPECT_EQ(s.least, 1);
  EXPECT_EQ(s.greatest, 4);
  EXPECT_EQ(s.quantiles[1], 1.75);
  EXPECT_EQ(s.quantiles[2], 2.5);
  EXPECT_NEAR(s.quantiles[0], 1.15, 1e-15);
  const Summary far = summary_of({1e9, 1e9 + 1e-3, 1e9 + 2e-3});
  EXPECT_NEAR(far.deviation, 1e-3, 1e-7);
  EXPECT_TRUE(std::isnan(summary_of({}).mean));
  EXPECT_EQ(summary_of({7}).mean, 7);
  EXPECT_TRUE(std::isnan(summary_of({7}).deviation));
}

// Indices

/// sin x1 + a sin² x2 + b x3⁴ sin x1, x uniform in (-π, π)³: T. Ishigami, T. Homma, ISUMA 1990.
struct Ishigami {
  static constexpr double a = 7, b = 0.1;
  static double at(const double* x) {
    return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) +
           b * std::pow(x[2], 4) * std::sin(x[0]);
  }
  const double of_1 = 0.5 * std::pow(1 + b * std::pow(pi, 4) / 5, 2), of_2 = a * a / 8,
               of_13 = b * b * std::pow(pi, 8) * (1.0 / 18 - 1.0 / 50),
               variance = of_1 + of_2 + of_13;
  const double first[3] = {of_1 / variance, of_2 / variance, 0};
  const double total[3] = {(of_1 + of_13) / variance, of_2 / variance, of_13 / variance};
};

std::vector<double> values_of(const Sample& sample, double (*f)(const double*)) {
  std::vector<double> values, x(sample.quantities());
  for (std::size_t n = 0; n < sample.cases(); ++n) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = pi * (2 * sample.at(n, i) - 1);
    values.push_back(f(x.data()));
  }
  return values;
}

TEST(SobolIndices, OfIshigamisFunction) {
  const Ishigami known;
  EXPECT_NEAR(known.first[0], 0.3139, 1e-4);
  EXPECT_NEAR(known.first[1], 0.4424, 1e-4);
  EXPECT_NEAR(known.total[2], 0.2437, 1e-4);
  for (const Kind kind : {Kind::random, Kind::latin, Kind::sobol}) {
    const Sample sample({kind, 8192, 1, true}, 3);
    const SobolIndices found = sobol_indices(values_of(sample, Ishigami::at), 3);
    EXPECT_EQ(found.rows, 8192u);
    EXPECT_NEAR(found.variance / known.variance, 1, 0.05);
    for (std::size_t i = 0; i < 3; ++i) {
      const SobolIndex& index = found.of[i];
      EXPECT_NEAR(index.first, known.first[i], 4 * index.first_error) << i;
      EXPECT_NEAR(index.total, known.total[i], 4 * index.total_error) << i;
      EXPECT_LT(index.first_error, 0.03);
      EXPECT_LT(index.total_error, 0.03);
      if (kind != Kind::sobol) continue;
      EXPECT_NEAR(index.first, known.first[i], 5e-3) << i;
      EXPECT_NEAR(index.total, known.total[i], 5e-3) << i;
    }
  }
}

/// The error that is told is the spread of estimates from other seeds.
TEST(SobolIndices, TellTheirSamplingError) {
  std::vector<double> first, total, first_error, total_error;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Sample sample({Kind::random, 256, seed, true}, 3);
    const SobolIndex index = sobol_indices(values_of(sample, Ishigami::at), 3, seed, 200).of[0];
    first.push_back(index.first);
    total.push_back(index.total);
    first_error.push_back(index.first_error);
    total_error.push_back(index.total_error);
  }
  // A deviation of 100 is known to 7 %.
  EXPECT_NEAR(summary_of(first_error).mean / summary_of(first).deviation, 1, 0.25);
  EXPECT_NEAR(summary_of(total_error).mean / summary_of(total).deviation, 1, 0.25);
}

/// A sum has no part of two together.
TEST(SobolIndices, OfASum) {
  const Sample sample({Kind::sobol, 4096, 3, true}, 3);
  const SobolIndices found = sobol_indices(
      values_of(sample, [](const double* x) { return 100 + x[0] - 2 * x[1] + 0 * x[2]; }), 3);
  const double known[3] = {0.2, 0.8, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found.of[i].first, known[i], 2e-3);
    EXPECT_NEAR(found.of[i].total, known[i], 2e-3);
  }
}

/// The formulas written down again, rows with a missing value left out.
TEST(SobolIndices, AreTheEstimatesOfTheFormulas) {
  const Sample sample({Kind::random, 50, 9, true}, 3);
  std::vector<double> f = values_of(sample, Ishigami::at);
  f[7 * 5 + 3] = std::nan("");
  const SobolIndices found = sobol_indices(f, 3);
  ASSERT_EQ(found.rows, 49u);
  double mean = 0, variance = 0;
  for (std::size_t j = 0; j < 50; ++j)
    if (j != 7) mean += (f[j * 5] + f[j * 5 + 1]) / 98;
  for (std::size_t j = 0; j < 50; ++j)
    if (j != 7) variance += (std::pow(f[j * 5] - mean, 2) + std::pow(f[j * 5 + 1] - mean, 2)) / 98;
  EXPECT_NEAR(found.variance, variance, 1e-13 * variance);
  for (std::size_t i = 0; i < 3; ++i) {
    double first = 0, total = 0;
    for (std::size_t j = 0; j < 50; ++j) {
      if (j == 7) continue;
      const double a = f[j * 5], b = f[j * 5 + 1], ab = f[j * 5 + 2 + i];
      first += (b - mean) * (ab - a) / 49 / variance;
      total += (a - ab) * (a - ab) / 98 / variance;
    }
    EXPECT_NEAR(found.of[i].first, first, 1e-13);
    EXPECT_NEAR(found.of[i].total, total, 1e-13);
  }
  EXPECT_TRUE(std::isnan(sobol_indices(std::vector<double>(50, 2.0), 3).of[0].first));
  EXPECT_THROW(sobol_indices(std::vector<double>(7), 3), std::invalid_argument);
}

// Of scenes

const char* const block = R"toml(
name = "block"
gravity = [0, 0, 0]
[parameters]
x1 = 0
x2 = 0
x3 = 0
[[body]]
name = "block"
mass = 1
shape = { kind = "point" }
[[joint]]
name = "P"
kind = "prismatic"
parent = "ground"
child = "block"
axis = [1, 0, 0]
position = "sin(x1) + 7 * sin(x2)^2 + 0.1 * x3^4 * sin(x1)"
[run]
end = 0.1
samples = 2
)toml";

/// A block that rests where Ishigami's function says.
TEST(SampledSweep, FindsTheIndicesOfAScene) {
  SweepRequest request;
  request.text = block;
  request.file = "block";
  for (const char* x : {"x1", "x2", "x3"})
    request.varied.emplace_back(std::string(x) + "=-3.141592653589793:3.141592653589793");
  request.sample = std::make_shared<Sample>(SampleSettings{Kind::sobol, 512, 1, true}, 3);
  request.watched = {"P.q"};
  request.settings = [](const RunDefaults& defaults) {
    return default_settings(defaults, "momentum", "", 1e-8);
  };
  std::vector<SweepCase> cases;
  for (std::size_t n = 0; n < request.cases(); ++n) {
    cases.push_back(run_case(request, n));
    ASSERT_EQ(cases.back().status, "done") << cases.back().reason;
    EXPECT_NEAR(cases.back().watched[0].last, Ishigami::at(cases.back().values.data()), 1e-12);
  }
  const SweepStatistics found = sweep_statistics(request, cases);
  const auto last = std::find_if(found.quantities.begin(), found.quantities.end(),
                                 [](const auto& q) { return q.name == "P.q last"; });
  ASSERT_NE(last, found.quantities.end());
  EXPECT_EQ(last->summary.count, 2 * 512u);  // A and B
  const Ishigami known;
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(last->indices.of[i].first, known.first[i], 0.03);
    EXPECT_NEAR(last->indices.of[i].total, known.total[i], 0.03);
  }
  ASSERT_EQ(found.curves.size(), 1u);
  EXPECT_EQ(found.curves[0].label, "P.q [m]");
  ASSERT_EQ(found.curves[0].times.size(), 3u);
  EXPECT_EQ(found.curves[0].others, 0u);
  EXPECT_EQ(found.curves[0].at.back().mean, last->summary.mean);
  EXPECT_NEAR(found.curves[0].at.front().quantiles[3], last->summary.quantiles[3], 1e-12);
  // A case that is not done is no part of it, one with other times none of the curves.
  cases[0].status = "failed";
  cases[1].times.back() += 1;
  const SweepStatistics fewer = sweep_statistics(request, cases);
  EXPECT_EQ(fewer.quantities.back().summary.count, 2 * 512u - 1);
  EXPECT_EQ(fewer.quantities.back().indices.rows, 511u);
  EXPECT_EQ(fewer.curves[0].others + fewer.curves[0].at[0].count, 2 * 512u - 1);
  EXPECT_GT(fewer.curves[0].others, 0u);
}

TEST(SampledSweep, PlacesThatMoveTogetherHaveOneValue) {
  const Varied both("body.a.mass,body.b\\,c.mass=1:2:3");
  EXPECT_EQ(both.places, (std::vector<std::string>{"body.a.mass", "body.b,c.mass"}));
  SweepRequest request;
  request.text = block;
  request.file = "block";
  request.watched = {"P.q"};
  request.settings = [](const RunDefaults& defaults) {
    return default_settings(defaults, "momentum", "", 1e-8);
  };
  request.varied = {Varied("x1,x2=0.3,0.7")};
  ASSERT_EQ(request.cases(), 2u);
  const double x[3] = {0.7, 0.7, 0};
  EXPECT_NEAR(run_case(request, 1).watched[0].last, Ishigami::at(x), 1e-12);
  request.varied = {Varied("x1,x2=0.3,0.7"), Varied("x2=1,2")};
  EXPECT_THROW(request.cases(), std::invalid_argument);
  request.varied = {Varied("x1=0.3:0.7")};
  EXPECT_THROW(request.cases(), std::invalid_argument);
}

}  // namespace
}  // namespace momenta::laws::dae_uncertainty
