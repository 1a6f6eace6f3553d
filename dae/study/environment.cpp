#include <momenta/core/kernel/levels/level.h>
#include <momenta/dae/study/environment.h>
#include <suitesparse/SuiteSparse_config.h>
#include <sundials/sundials_config.h>

#include <Eigen/Core>
#ifdef __GLIBC__
#include <gnu/libc-version.h>
#endif

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <thread>
#include <vector>

namespace momenta {
namespace {

// Fowler, Noll and Vo, 64 bits.
constexpr std::uint64_t fnv_start = 14695981039346656037ull, fnv_prime = 1099511628211ull;

}  // namespace

const char* version() {
  return MOMENTA_VERSION;
}

Environment environment() {
  Environment e;
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) {
      e.cpu = line.substr(line.find(':') + 2);
      break;
    }
#ifdef __clang__
  e.compiler = "clang " __clang_version__;
#else
  e.compiler = "g++ " __VERSION__;
#endif
  e.level = best_level();
  e.flags = MOMENTA_FLAGS;
  e.build_type = MOMENTA_BUILD_TYPE;
  const auto dotted = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  e.versions = {{"momenta", version()},
                {"SUNDIALS", SUNDIALS_VERSION},
                {"SuiteSparse", dotted(SUITESPARSE_MAIN_VERSION, SUITESPARSE_SUB_VERSION,
                                       SUITESPARSE_SUBSUB_VERSION)},
                {"Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)}};
#ifdef __GLIBC__
  e.versions.push_back({"C library", std::string("glibc ") + gnu_get_libc_version()});
#endif
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  e.date = text;
  return e;
}

std::string build_digest() {
  const Environment e = environment();
  std::string all = e.cpu + std::to_string(e.level) + e.compiler + e.flags + e.build_type;
  for (const auto& [name, version] : e.versions) all += name + version;
  // Word by word: tens of megabytes byte by byte take a fifth of a second.
  std::ifstream program("/proc/self/exe", std::ios::binary);
  std::vector<std::uint64_t> words(1 << 13);
  std::uint64_t h = fnv_start;
  while (program) {
    std::fill(words.begin(), words.end(), 0);
    program.read(reinterpret_cast<char*>(words.data()),
                 static_cast<std::streamsize>(words.size() * sizeof words[0]));
    for (const std::uint64_t word : words) h = (h ^ word) * fnv_prime;
  }
  return digest(all + std::to_string(h));
}

int threads_of(int asked) {
  return asked > 0 ? asked : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

std::string digest(std::string_view text) {
  std::uint64_t h = fnv_start;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * fnv_prime;
  char hex[17];
  std::snprintf(hex, sizeof hex, "%016llx", static_cast<unsigned long long>(h));
  return hex;
}

}  // namespace momenta
