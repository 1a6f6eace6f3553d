#include <momenta/core/kernel/levels/level.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace momenta {
namespace {

struct Level {
  int number;
  bool built, runs;
};

#ifdef MOMENTA_LEVEL1
constexpr bool built1 = true;
#else
constexpr bool built1 = false;
#endif
#ifdef MOMENTA_LEVEL3
constexpr bool built3 = true;
#else
constexpr bool built3 = false;
#endif
#ifdef MOMENTA_LEVEL4
constexpr bool built4 = true;
#else
constexpr bool built4 = false;
#endif

bool runs3() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi2");
#else
  return false;
#endif
}
bool runs4() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512cd");
#else
  return false;
#endif
}

std::atomic<int> asked{0};  ///< level of use_level(); 0: none

/// `level`, if machine and library have it; `who` is named in the error.
int available(int level, const std::string& who) {
  const Level all[] = {{1, built1, true}, {3, built3, runs3()}, {4, built4, runs4()}};
  std::string those;
  for (const Level& l : all) {
    if (l.number == level && l.built && l.runs) return level;
    if (l.built && l.runs) those += (those.empty() ? "" : ", ") + std::to_string(l.number);
  }
  throw std::invalid_argument(who +
                              ": expected an instruction level that this processor and this " +
                              "build have (" + those + ")");
}

}  // namespace

int level_at_most(int level) {
  const Level all[] = {{4, built4, runs4()}, {3, built3, runs3()}, {1, built1, true}};
  int lowest = 0;
  for (const Level& l : all) {
    if (!l.built || !l.runs) continue;
    if (l.number <= level) return l.number;
    lowest = l.number;
  }
  if (lowest > 0) return lowest;
  throw std::runtime_error(std::string("the kernels of this build are for x86-64 level ") +
                           (built3 ? "3 (AVX2)" : "4 (AVX-512)") +
                           ", which this processor does not have; build with "
                           "-D MOMENTA_LEVELS=\"1;3;4\"");
}

int best_level() {
  if (const int level = asked.load(std::memory_order_relaxed)) return level;
  const char* wanted = std::getenv("MOMENTA_LEVEL");
  if (!wanted || !*wanted) return level_at_most(4);
  const std::string text = wanted;
  return available(text == "1" || text == "3" || text == "4" ? text[0] - '0' : 0,
                   "MOMENTA_LEVEL is '" + text.substr(0, 20) + "'");
}

void use_level(int level) {
  asked = available(level, "found level " + std::to_string(level));
}

}  // namespace momenta
