#include <momenta/dae/report/page.h>
#include <momenta/dae/report/picture_data.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cstdio>

#include "options.h"

namespace momenta::program {
namespace {

std::string counted(std::size_t n, const std::string& one, const std::string& more) {
  return std::to_string(n) + " " + (n == 1 ? one : more);
}

/// What there is to see, in a sentence or two.
std::string words_of(const Mechanism& mechanism, const Assembly& a) {
  const Scene& scene = mechanism.scene();
  const auto couplers = static_cast<std::size_t>(
      std::count_if(scene.loops.begin(), scene.loops.end(),
                    [](const LoopSpec& l) { return l.kind == LoopKind::coupler; }));
  std::string words =
      counted(scene.bodies.size(), "body", "bodies") + ", " +
      counted(scene.joints.size(), "joint", "joints") + ", " +
      counted(scene.loops.size() - couplers, "loop", "loops") +
      (couplers > 0 ? ", " + counted(couplers, "coupler", "couplers") : "") + "; " +
      counted(static_cast<std::size_t>(mechanism.nv()), "rate", "rates") + ", " +
      counted(static_cast<std::size_t>(mechanism.m()), "loop equation", "loop equations") +
      (mechanism.plan().planar ? ", in a plane." : ", in space.");
  if (mechanism.m() > 0)
    words += " Assembly moved the joints by up to " + compact(a.moved, 2) +
             " against the guess (rad or m).";
  return words;
}

}  // namespace

int view(const Options& o) {
  const auto mechanism = load(o);
  if (mechanism->scene().bodies.size() > most_bodies_drawn)
    throw std::invalid_argument("view: found " + std::to_string(mechanism->scene().bodies.size()) +
                                " bodies, expected at most " + std::to_string(most_bodies_drawn));
  expect_own_results(o.out, "");
  const Assembly a = assemble(*mechanism);
  StudyResult study;
  describe(study, o, *mechanism, a);
  if (o.out.empty()) show(study, *mechanism, a);
  const std::string page = view_page(study, words_of(*mechanism, a));
  if (o.out.empty()) {
    std::fputs(page.c_str(), stdout);
    return done;
  }
  if (!write_results({{o.out / "index.html", page}})) return run_failed;
  if (!o.quiet) std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "index.html").c_str());
  return done;
}

}  // namespace momenta::program
