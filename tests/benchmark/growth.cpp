// What a mechanism costs as it grows: rows of four-bars, ladders, closed chains and grids from ten
// to a hundred thousand bodies. A table, and below each family the slope of log cost over log
// bodies from a thousand bodies on; 1 is cost that grows like the mechanism.
//
//   load        the scene's text to a Mechanism
//   assemble    a consistent start, with the rank of Φ_q
//   evaluation  of (7)-(8) at that start, pushed
//   run         momentum form, five steps of rk4, positions corrected; left out where an evaluation
//               takes longer than a second
//   memory      of the process that did all this, at most
//   check       `momenta check`, a process of its own, and its memory
//
// Each row is made by processes of its own, so that memory is that of the row. Times are of the
// processor.
//
// Usage: momenta_growth [MOST [FAMILY …]]   mechanisms of at most so many bodies; 100000

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "made_scenes.h"
#include "processor_time.h"
#include "pushed_state.h"

namespace momenta {
namespace {

using benchmark_models::Family, benchmark_models::families_with_loops;

enum Cost { load, assembling, evaluation, run, memory, check, check_memory, costs };
constexpr std::array<const char*, costs> titles{
    "load [s]",    "assemble [s]", "evaluation [ms]",     "run [s]",
    "memory [MB]", "check [s]",    "memory of check [MB]"};

/// −1: not known.
struct Row {
  double bodies = -1;
  std::array<double, costs> cost;
};

double megabytes(const rusage& used) {
  return static_cast<double>(used.ru_maxrss) / 1024;  // Linux counts kB
}
double seconds_of(const rusage& used) {
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return of(used.ru_utime) + of(used.ru_stime);
}

/// Runs `work` in a process of its own; what it used, and whether it ended well.
bool in_child(const std::function<void()>& work, rusage& used) {
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    try {
      work();
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      _exit(1);
    }
    _exit(0);
  }
  int status = 1;
  return child > 0 && wait4(child, &status, 0, &used) == child && WIFEXITED(status) &&
         WEXITSTATUS(status) == 0;
}

/// `momenta` in this process's place, its standard output into a file.
[[noreturn]] void become_momenta(std::vector<std::string> words, const std::filesystem::path& out) {
  const int file = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file >= 0) dup2(file, STDOUT_FILENO);
  std::vector<char*> pointers;
  words.insert(words.begin(), MOMENTA_PROGRAM);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv(MOMENTA_PROGRAM, pointers.data());
  _exit(127);
}

/// The stages one after the other; each is told as soon as it is known.
void measure(const std::filesystem::path& file, const std::function<void(int, double)>& tell) {
  double from = processor_seconds();
  const auto since = [&] {
    const double took = processor_seconds() - from;
    from += took;
    return took;
  };
  const Mechanism mechanism(read_scene(file));
  tell(load, since());
  tell(costs, static_cast<double>(mechanism.scene().bodies.size()));
  const Assembly assembly = assemble(mechanism);
  tell(assembling, since());
  constexpr double most_ms = 1000;
  double took = 0;
  {
    const PushedState s = pushed_state(mechanism, assembly.start.q);
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    Eigen::VectorXd u(mechanism.nv()), pdot(mechanism.nv()), sigma(mechanism.m());
    bool solved = true;
    took = least_ms([&] {
      solved &= solver->momentum(0, s.q.data(), s.p.data(), nullptr, fade_evaluation, 0, u.data(),
                                 sigma.data(), pdot.data());
    });
    tell(evaluation, took);
    if (!solved || !pdot.allFinite()) throw std::runtime_error("(7) has no solution");
  }
  if (took > most_ms) return;
  RunRequest request;
  request.settings.form = "momentum";
  request.settings.integrator = "rk4";
  request.settings.step = 1e-3;
  request.settings.end_time = 5e-3;
  request.settings.samples = 1;
  request.settings.project = true;
  from = processor_seconds();
  const RunResult result = run_form(mechanism, assembly.start, request);
  if (result.status != "done") throw std::runtime_error(result.reason);
  tell(run, since());
}

Row measured(const Family& family, int bodies, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "scene.toml";
  Row row;
  row.cost.fill(-1);
  rusage used{};
  if (!in_child(
          [&] {
            become_momenta({"make", family.name, "--n", std::to_string(family.size(bodies))}, file);
          },
          used))
    return row;
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return row;
  struct Told {
    int what;
    double value;
  };
  const bool ended = in_child(
      [&] {
        measure(file, [&](int what, double value) {
          const Told told{what, value};
          if (write(pipe_ends[1], &told, sizeof told) != sizeof told) _exit(1);
        });
      },
      used);
  close(pipe_ends[1]);
  for (Told told; read(pipe_ends[0], &told, sizeof told) == sizeof told;)
    (told.what == costs ? row.bodies : row.cost[static_cast<std::size_t>(told.what)]) = told.value;
  close(pipe_ends[0]);
  if (ended) row.cost[memory] = megabytes(used);
  if (in_child(
          [&] {
            become_momenta({"check", "--json", file.string()}, folder / "check.json");
          },
          used)) {
    row.cost[check] = seconds_of(used);
    row.cost[check_memory] = megabytes(used);
  }
  return row;
}

/// Of log cost over log bodies, least squares over the rows of a thousand bodies and more.
double slope(const std::vector<Row>& rows, std::size_t cost) {
  constexpr double least_bodies = 900;
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const Row& row : rows) {
    if (row.bodies < least_bodies || !(row.cost[cost] > 0)) continue;
    const double a = std::log(row.bodies), b = std::log(row.cost[cost]);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return n < 2 ? NAN : (n * xy - x * y) / (n * xx - x * x);
}

void print(const char* name, const std::string& bodies, const std::array<double, costs>& cost) {
  std::printf("| %s | %s |", name, bodies.c_str());
  for (const double x : cost)
    if (x >= 0)
      std::printf(x >= 100 ? " %.0f |" : " %.3g |", x);
    else
      std::printf(" – |");
  std::printf("\n");
  std::fflush(stdout);
}

void table(const Family& family, int most, const std::filesystem::path& folder) {
  std::vector<Row> rows;
  for (int bodies = 10; bodies <= most; bodies *= 10) {
    rows.push_back(measured(family, bodies, folder));
    print(family.name, std::to_string(std::lround(rows.back().bodies)), rows.back().cost);
  }
  std::array<double, costs> slopes{};
  for (std::size_t cost = 0; cost < costs; ++cost) slopes[cost] = slope(rows, cost);
  print(family.name, "slope", slopes);
}

}  // namespace
}  // namespace momenta

int main(int argc, char** argv) {
  using namespace momenta;
  const int most = argc > 1 ? std::atoi(argv[1]) : 100'000;
  for (int i = 2; i < argc; ++i)
    if (std::none_of(families_with_loops.begin(), families_with_loops.end(),
                     [&](const Family& f) { return std::string(argv[i]) == f.name; })) {
      std::fprintf(stderr,
                   "momenta_growth: found family '%s', expected n-four-bar, scissor-ladder, "
                   "closed-chain or grid\n",
                   argv[i]);
      return 2;
    }
  if (most < 10) {
    std::fprintf(stderr, "momenta_growth: found '%s', expected a number of bodies from 10 on\n",
                 argv[1]);
    return 2;
  }
  std::string folder = (std::filesystem::temp_directory_path() / "momenta_growth_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) {
    std::fprintf(stderr, "no folder for scenes could be made in %s\n", folder.c_str());
    return 1;
  }
  std::printf("| scene | bodies |");
  for (const char* title : titles) std::printf(" %s |", title);
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < titles.size(); ++i) std::printf("---|");
  std::printf("\n");
  for (const Family& family : families_with_loops) {
    bool asked = argc <= 2;
    for (int i = 2; i < argc; ++i) asked |= std::string(argv[i]) == family.name;
    if (asked) table(family, most, folder);
  }
  std::filesystem::remove_all(folder);
  return 0;
}
