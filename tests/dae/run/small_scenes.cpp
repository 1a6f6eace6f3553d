// Any bytes are a scene or refused in one sentence, any small mechanism runs or says in one
// sentence why not: seeds, mutations of them, and a bounded number at random.

#include "equations/small_scenes.h"
#include "equations/any_text.h"
#include "equations/ensemble.h"
#include "equations/refusal.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/table.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/drift_study.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace momenta::dae_small_scenes {
namespace {

using namespace equations;
namespace fs = std::filesystem;

std::vector<std::string> contents(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(MOMENTA_SOURCE_DIR) / folder))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> all;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    all.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return all;
}

std::span<const unsigned char> bytes_of(const std::string& text) {
  return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

std::string hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    constexpr auto digits = "0123456789abcdef";
    const auto b = static_cast<unsigned char>(c);
    text += {digits[b >> 4], digits[b & 15]};
  }
  return text;
}

Tried expect_taken_or_refused(const std::string& bytes) {
  const std::string form = form_for(bytes_of(bytes));
  Tried tried = try_scene(small_scene(bytes_of(bytes)), form);
  EXPECT_EQ(tried.wrong, "") << form << ", bytes " << hex(bytes);
  return tried;
}

TEST(AnyBytes, AreASceneOrRefusedInOneSentence) {
  std::mt19937 random(1);
  auto seeds = contents("examples");
  for (auto& text : contents("tests/core/format/broken_scenes")) seeds.push_back(std::move(text));
  std::erase_if(seeds, [](const std::string& text) { return text.size() > 20'000; });
  ASSERT_GT(seeds.size(), 60u);
  for (const std::string& seed : seeds) {
    EXPECT_EQ(wrong_in_reading(seed), "");
    for (int round = 0; round < 10; ++round) {
      std::string text = seed;
      const auto at = [&] { return random() % (text.size() + 1); };
      for (unsigned k = 0; k < 1 + random() % 3; ++k) {
        const std::size_t from = at(), size = random() % 40;
        switch (random() % 3) {
          case 0:
            text.erase(from, size);
            break;
          case 1:
            text.insert(at(), text.substr(from, size));
            break;
          case 2: {
            const std::string& other = seeds[random() % seeds.size()];
            text.insert(from, other, std::min<std::size_t>(random(), other.size()), 4 * size);
            break;
          }
        }
      }
      ASSERT_EQ(wrong_in_reading(text), "") << text;
    }
  }
}

TEST(SmallScenes, OfTheCorpusRunOrSayWhyNot) {
  const auto corpus = contents("tests/fuzz/small_scenes");
  ASSERT_GT(corpus.size(), 5u);
  for (const std::string& bytes : corpus) expect_taken_or_refused(bytes);
}

TEST(SmallScenes, AtRandomRunOrSayWhyNot) {
  std::mt19937 random(2);
  int ran = 0, looped = 0, quiet = 0;
  for (int round = 0; round < 400; ++round) {
    std::string bytes(random() % 300, '\0');
    for (char& c : bytes) c = static_cast<char>(random() % 3 == 0 ? 0 : random());
    const bool through = expect_taken_or_refused(bytes).ran;
    const Scene scene = small_scene(bytes_of(bytes));
    ran += through;
    looped += through && !scene.loops.empty();
    quiet += scene.drives.empty() && scene.forces.empty();
  }
  // They are worth the name: many come through, with loops too, and some have little in them.
  EXPECT_GT(ran, 150);
  EXPECT_GT(looped, 50);
  EXPECT_GT(quiet, 20);
}

// Found by the above.

const std::string welded = R"(
gravity = [0, 0, -9.81]
[[body]]
name = "block"
mass = 2.0
shape = { kind = "box", size = [1, 1, 1] }
[[joint]]
name = "foot"
kind = "weld"
child = "block"
)";

TEST(NothingMoves, AndEveryMethodComesToItsEnd) {
  const Mechanism mechanism(parse_scene(welded));
  const Start start = equations::start_of(mechanism);
  for (const auto& [form, method] :
       {std::pair{"momentum", "dop853"}, std::pair{"acceleration", "rk4"},
        std::pair{"momentum", "bdf"}, std::pair{"acceleration", "adams"},
        std::pair{"momentum", "gauss4"}, std::pair{"momentum-index2", "ida"},
        std::pair{"stabilised-index2", "radau5"}, std::pair{"acceleration-index2", "hem5"},
        std::pair{"momentum-index2", "hem8"}, std::pair{"acceleration-index3", "generalised-alpha"},
        std::pair{"partitioned", "dop853"}, std::pair{"projected", "vern9"},
        std::pair{"baumgarte", "dp5"}, std::pair{"augmented-lagrangian", "dop853"},
        std::pair{"augmented-lagrangian-canonical", "dop853"},
        std::pair{"maximal-coordinates", "dop853"}, std::pair{"momentum-stabilised", "ida"},
        std::pair{"momentum-index3", "radau5"}}) {
    const RunResult run =
        run_form(mechanism, start, equations::stepped(form, method, "none", 0.1, 1, 4));
    EXPECT_EQ(run.status, "done") << form << " " << method << ": " << run.reason;
    EXPECT_EQ(run.series.t, (std::vector<double>{0, 0.25, 0.5, 0.75, 1})) << method;
    EXPECT_EQ(run.energy_error_max, 0) << method;
  }
}

// A rod of next to no mass: no pivot of its turning counts beside those of its sliding.
TEST(NoPartition, FailsTheRunAndNotTheStudy) {
  const Mechanism mechanism(parse_scene(R"(
[[body]]
name = "dust"
mass = 1e-88
com = [0.05, 0.05, 0.04]
inertia = [0.1, 0.1, 0.1, 0, 0, 0]
[[joint]]
name = "O"
kind = "free"
child = "dust"
[[loop]]
name = "C"
kind = "distance"
child = "dust"
origin = { parent = [-0.4, 0.05, 0.5], child = [-0.4, -0.3, -0.4] }
length = 1.0
)"));
  const Start start = equations::start_of(mechanism);
  RunRequest request;
  request.settings.form = "partitioned";
  request.settings.integrator = "dop853";
  request.keep_trajectory = true;
  const RunResult run = run_form(mechanism, start, request);
  EXPECT_EQ(run.status, "failed");
  EXPECT_NE(run.reason.find("no regular partition"), std::string::npos) << run.reason;
  EXPECT_TRUE(run.series.t.empty());
  DriftRequest drift;
  drift.forms = {"partitioned", "momentum-index2"};
  drift.end_time = 0.1;
  drift.samples = 2;
  const auto runs = run_drift_study(mechanism, start, drift);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].status, "failed");
  EXPECT_FALSE(runs[1].series.t.empty());
  StudyResult study;
  study.runs = runs;
  EXPECT_FALSE(drift_page(study).empty());
  EXPECT_FALSE(drift_table(study).empty());
  study.runs = {run};
  EXPECT_FALSE(run_page(study).empty());
}

TEST(NothingMoves, ALoopThereIsRefused) {
  const Mechanism mechanism(parse_scene(
      welded +
      "[[loop]]\nname = \"C\"\nkind = \"point\"\nparent = \"ground\"\nchild = \"block\"\n"));
  EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] { assemble(mechanism); }),
                              "loop 'C' ties bodies of which none can move"));
}

}  // namespace
}  // namespace momenta::dae_small_scenes
