// The verb `move`: the mechanism moved through its poses by one coordinate.

#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/report/move_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/report/picture_data.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/motion.h>

#include "answers.h"
#include "cpu_limit.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {
int move(const Options& o, const MoveOptions& options) {
  const CpuLimit limit(o.cpu_limit.value_or(0));
  const Mechanism mechanism(held_at_start(read(o)), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "move.csv");
  const Assembly a = assemble(mechanism, Assembled::rates);
  MoveRequest request;
  request.sweep = amounts_in("--sweep", options.sweep, "A=1,B=-0.5");
  if (request.sweep.empty())
    throw std::invalid_argument("--sweep is empty; expected the name of a coordinate");
  request.hold = names_in(options.hold);
  request.output = options.output;
  request.to = options.to;
  request.by = options.by.value_or(0);
  request.singular_values = options.singular_values;
  const MoveResult result = momenta::move(mechanism, a.start.t, a.start.q, request);
  auto json = move_json(result);
  json["environment"] = environment_json(environment());
  const std::string text = json.dump(2) + "\n";
  if (!o.out.empty()) {
    StudyResult study;
    if (const int intervals = film_intervals_of(mechanism, o, 1); intervals > 0) {
      study.motions.push_back(motion_of(mechanism, move_film(result, std::min(intervals, 720))));
      study.motions.back().run = -1;
    }
    describe(study, o, mechanism, a);
    if (!write_results({{o.out / "move.csv", move_csv(result)},
                        {o.out / "move.json", text},
                        {o.out / "index.html", move_page(study, result)}}))
      return run_failed;
  }
  tell(o, text, move_table(result), "index.html");
  return result.end == MoveResult::End::stopped ? run_failed : done;
}

}  // namespace momenta::program
