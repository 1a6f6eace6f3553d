#include <momenta/dae/report/page.h>
#include <momenta/dae/report/still.h>

#include <cstdio>

#include "answers.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {

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

}  // namespace momenta::program
