// The same numbers everywhere: at one instruction level a scene and its settings give the same bits
// on every processor that has it. Digests of whole trajectories, by level, are in digests.json.
// What is promised and why: docs/reference/same-numbers.md.

#include <gnu/libc-version.h>
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/kernel/levels/level.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/environment.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "equations/runs.h"

namespace momenta::dae_digests {
namespace {

const std::filesystem::path source = MOMENTA_SOURCE_DIR;

std::string digest_of(const std::vector<double>& numbers) {
  std::string bytes;
  for (const double x : numbers) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    for (int i = 0; i < 8; ++i) bytes += static_cast<char>(bits >> (8 * i));
  }
  return digest(bytes);
}

struct Case {
  std::string scene, form, integrator;
  double tolerance, end, step = 0;
  KktChoice kkt = KktChoice::automatic;
};
// One of each kind of state, of integrator and of solver, in a plane and in space.
const Case cases[] = {
    {"four_bar", "momentum", "dop853", 1e-9, 2},
    {"four_bar", "momentum", "rk4", 1e-9, 2, 5e-3},
    {"four_bar", "momentum", "dp5", 1e-6, 2, 0, KktChoice::dense},
    {"four_bar", "momentum", "dp5", 1e-6, 2, 0, KktChoice::sparse},
    {"four_bar", "baumgarte", "vern9", 1e-9, 2},
    {"four_bar", "momentum-index2", "ida", 1e-8, 1},
    {"four_bar", "momentum-index2", "radau5", 1e-8, 1},
    {"andrews", "momentum", "dop853", 1e-9, 0.01},
    {"andrews", "projected", "dop853", 1e-9, 0.01},
    {"andrews", "stabilised-index2", "ida", 1e-6, 0.01},
    {"bricard", "momentum", "dop853", 1e-8, 1},
    {"bricard", "projected", "dp5", 1e-6, 1},
    {"slider_crank", "momentum", "dop853", 1e-8, 1},
    {"spatial_slider_crank", "acceleration", "dop853", 1e-8, 0.5},
    {"driven", "momentum", "dop853", 1e-8, 0.5},
    {"pendulum", "momentum", "vern9", 1e-10, 2},
};

std::string name_of(const Case& c) {
  return c.scene + " " + c.form + " " + c.integrator +
         (c.kkt == KktChoice::automatic ? "" : std::string(" ") + momenta::name_of(c.kkt));
}

std::string trajectory_digest(const Case& c) {
  const Mechanism mechanism(read_scene(source / "examples" / c.scene / "scene.toml"),
                            {Algebra::automatic, c.kkt});
  RunRequest request = equations::kept(equations::adaptive(
      c.form, c.integrator, c.form == "momentum" ? "reset" : "leak:3", c.tolerance, c.end, 20));
  request.settings.project = c.form == "momentum" && c.integrator != "rk4";
  request.settings.step = c.step;
  const RunResult run = run_form(mechanism, assemble(mechanism).start, request);
  EXPECT_EQ(run.status, "done") << name_of(c) << ": " << run.reason;
  std::vector<double> numbers;
  for (const auto& row : run.trajectory.rows) numbers.insert(numbers.end(), row.begin(), row.end());
  return digest_of(numbers);
}

/// (q̇, ṗ) and u̇ of the examples' chain, one state and eleven side by side.
std::string chain_digest() {
  OpenChain chain(read_scene(source / "examples" / "chain" / "scene.toml"));
  constexpr Eigen::Index count = 11;
  StateMatrix q(chain.nq(), count), p(chain.nv(), count), qdot(chain.nq(), count),
      pdot(chain.nv(), count), udot(chain.nv(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int k = 0; k < chain.nq(); ++k)
      q(k, i) = chain.tree().q0[k] + 0.125 * static_cast<double>(i * (k % 3));
    for (int k = 0; k < chain.nv(); ++k) p(k, i) = 0.25 * static_cast<double>(k - i);
  }
  EXPECT_TRUE(chain.rates_of_states(0, q, p, qdot, pdot)) << chain.failure();
  EXPECT_TRUE(chain.accelerations_of_states(0, q, p, udot)) << chain.failure();
  Eigen::VectorXd one_qdot(chain.nq()), one_pdot(chain.nv());
  EXPECT_TRUE(chain.rates(0, q.col(1), p.col(1), one_qdot, one_pdot)) << chain.failure();
  std::vector<double> numbers(one_qdot.begin(), one_qdot.end());
  numbers.insert(numbers.end(), one_pdot.begin(), one_pdot.end());
  for (const StateMatrix* m : {&qdot, &pdot, &udot})
    for (Eigen::Index i = 0; i < m->size(); ++i) numbers.push_back(m->reshaped()[i]);
  return digest_of(numbers);
}

class Digests : public testing::Test {
 protected:
  ~Digests() override { use_level(before_); }

 private:
  int before_ = best_level();
};

TEST_F(Digests, OfEveryLevelAreThoseOnRecord) {
#if defined(__clang__)
  const std::string compiler = "clang " + std::to_string(__clang_major__);
#else
  const std::string compiler = "g++ " + std::to_string(__GNUC__);
#endif
  const nlohmann::json record =
      nlohmann::json::parse(std::ifstream(source / "tests/dae/run/digests.json"));
  if (record["libc"] != gnu_get_libc_version() || !record["levels"].contains(compiler))
    GTEST_SKIP() << "digests are those of glibc " << record["libc"] << "; found "
                 << gnu_get_libc_version() << ", " << compiler;
#ifdef __x86_64__
  if (!__builtin_cpu_supports("fma") || !__builtin_cpu_supports("avx2"))
    GTEST_SKIP() << "without fused multiply-add the C library computes other last digits";
#endif
  // The project's own -ffp-contract=off is not for kernels; one more is the builder's, for all.
  const std::string flags = environment().flags;
  if (flags.find("-ffp-contract") != flags.rfind("-ffp-contract"))
    GTEST_SKIP() << "kernels of this build fuse other products: " << flags;
  nlohmann::json found;
  for (const int level : {1, 3, 4}) {
    if (level_at_most(level) != level) continue;
    use_level(level);
    auto& of_level = found[std::to_string(level)];
    for (const Case& c : cases) of_level[name_of(c)] = trajectory_digest(c);
    of_level["chain"] = chain_digest();
    const nlohmann::json recorded =
        record["levels"][compiler].value(std::to_string(level), nlohmann::json::object());
    for (const auto& [name, value] : of_level.items())
      EXPECT_EQ(value, recorded.value(name, "")) << "level " << level << ", " << name;
  }
  if (HasFailure()) std::printf("found, %s:\n%s\n", compiler.c_str(), found.dump(1).c_str());
}

// Twice in one process, and after other mechanisms have left their traces in memory.
TEST_F(Digests, OfTheSameRunAreTheSame) {
  for (const int i : {0, 3, 6}) {
    const Case& c = cases[i];
    const std::string first = trajectory_digest(c);
    trajectory_digest(cases[i + 1]);
    EXPECT_EQ(trajectory_digest(c), first) << name_of(c);
  }
}

}  // namespace
}  // namespace momenta::dae_digests
