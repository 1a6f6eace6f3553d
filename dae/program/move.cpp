// The verb `move`: the mechanism taken through its poses by one coordinate.

#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/report/move_report.h>
#include <momenta/dae/report/page.h>
#include <momenta/dae/report/picture_data.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/motion.h>

#include <charconv>
#include <cmath>

#include "options.h"

namespace momenta::program {
namespace {

/// "A", or "A=1,B=-0.5": coordinates, and how far they go in proportion.
std::vector<std::pair<std::string, double>> swept_in(const std::string& text) {
  std::vector<std::pair<std::string, double>> swept;
  for (const std::string& part : names_in(text)) {
    const std::size_t equals = part.find('=');
    double amount = 1;
    if (equals != std::string::npos) {
      const char *begin = part.data() + equals + 1, *end = part.data() + part.size();
      const auto [read, error] = std::from_chars(begin, end, amount);
      if (error != std::errc{} || read != end || !std::isfinite(amount) || amount == 0)
        throw std::invalid_argument("--sweep '" + text +
                                    "': expected NAME or NAME=AMOUNT, amounts other than zero, as "
                                    "in A=1,B=-0.5");
    }
    swept.emplace_back(part.substr(0, equals), amount);
  }
  if (swept.empty())
    throw std::invalid_argument("--sweep is empty; expected the name of a coordinate");
  return swept;
}

}  // namespace

int move(const Options& o, const MoveOptions& options) {
  const Mechanism mechanism(held_at_start(read(o)), {.algebra = mechanism_options(o).algebra});
  expect_own_results(o.out, "move.csv");
  const Assembly a = assemble(mechanism, Assembled::rates);
  MoveRequest request;
  request.sweep = swept_in(options.sweep);
  request.hold = names_in(options.hold);
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
