#include <momenta/dae/output/mechanism_view.h>
#include <momenta/dae/output/page.h>

#include <cstdio>

#include "loading.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

int view(const Options& o) {
  const auto mechanism = load(o);
  expect_drawable(*mechanism);
  expect_own_results(o.out, "");
  const Assembly a = assemble(*mechanism);
  StudyResult study;
  describe(study, o, *mechanism, a);
  if (o.out.empty()) show(study, o, *mechanism, a);
  const std::string page = view_page(study, still_words(*mechanism, a));
  if (o.out.empty()) {
    std::fputs(page.c_str(), stdout);
    return done;
  }
  if (!write_results({{o.out / "index.html", page}})) return run_failed;
  if (!o.quiet) std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "index.html").c_str());
  return done;
}

}  // namespace

Verb declare_view(CLI::App& app, Options& o) {
  CLI::App& verb =
      add_verb(app, "view", "A page that shows the assembled mechanism, to turn and zoom",
               "momenta view examples/models/agility_cassie/cassie.xml --out results");
  add_scene(verb, o);
  without(verb, {"--json", "--kkt", "--cut"});
  add_out(verb, o, "Directory for index.html (default: standard output)");
  add_mesh_bytes(verb, o);
  return {&verb, [&o] { return view(o); }};
}

}  // namespace momenta::program
