// `momenta assemble --all`: the assemblies of a mechanism with some coordinates held.

#include <momenta/dae/kinematics/assemblies.h>
#include <momenta/dae/linear/linearisation.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cstdio>
#include <thread>

#include "answers.h"
#include "loading.h"
#include "results.h"

namespace momenta::program {
namespace {

std::string number_of(int n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

double value_ratio(const FoundAssembly& a) {
  return a.most_value > 0 ? a.least_value / a.most_value : 1;
}

std::string assemblies_in_words(const Mechanism& mechanism, const AssembliesRequest& request,
                                const Assemblies& found) {
  std::string text = mechanism.scene().name + ": ";
  text += std::to_string(found.all.size()) + (found.all.size() == 1 ? " assembly" : " assemblies");
  for (std::size_t i = 0; i < request.hold.size(); ++i)
    text += (i == 0 ? " with " : ", ") + request.hold[i];
  text += request.hold.empty() ? "" : " held";
  text += ", from " + number_of(found.starts, "start") + ": " + std::to_string(found.closed) +
          " closed";
  if (found.turned > 0) text += ", " + std::to_string(found.turned) + " with axes turned";
  text += ", " + std::to_string(found.starts - found.closed - found.turned) + " did not close.\n";
  text += "A search proves no completeness: ";
  if (found.met_once() == 0)
    text += "each was met more than once, or is the scene's own";
  else
    text +=
        std::to_string(found.met_once()) + (found.met_once() == 1 ? " was" : " were") +
        " met once, so that one more start that closes meets a new one with a chance of about " +
        compact(static_cast<double>(found.met_once()) / found.closed, 2);
  return text + ".\n\n";
}

std::string assemblies_table(const Mechanism& mechanism, const Assemblies& found) {
  std::vector<std::vector<std::string>> rows{{"", "met", "apart", "least/largest value"}};
  for (const Column& c : mechanism.coordinate_columns()) rows[0].push_back(c.label());
  for (std::size_t i = 0; i < found.all.size(); ++i) {
    const FoundAssembly& a = found.all[i];
    rows.push_back({i == 0 ? "own" : std::to_string(i), std::to_string(a.met), compact(a.apart, 4),
                    compact(value_ratio(a), 3)});
    for (const double x : a.q) rows.back().push_back(compact(x, 6));
  }
  return in_columns(rows);
}

}  // namespace

int assemblies(const Options& o, const AssembliesOptions& a) {
  const Mechanism mechanism(held_at_start(read(o)), mechanism_options(o));
  const Assembly own = assemble(mechanism, Assembled::rates);
  AssembliesRequest request;
  request.hold = names_in(a.hold);
  request.starts = a.starts;
  request.seed = a.seed;
  request.threads = a.threads > 0
                        ? a.threads
                        : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const Assemblies found = find_assemblies(mechanism, own.start.t, own.start.q, request);
  nlohmann::ordered_json j;
  j["scene"] = mechanism.scene().name;
  j["held"] = request.hold;
  j["starts"] = found.starts;
  j["seed"] = request.seed;
  j["closed"] = found.closed;
  j["turned"] = found.turned;
  j["met_once"] = found.met_once();
  j["assemblies"] = nlohmann::ordered_json::array();
  const std::vector<Column> columns = mechanism.coordinate_columns();
  for (const FoundAssembly& one : found.all) {
    nlohmann::ordered_json q;
    for (std::size_t i = 0; i < columns.size(); ++i)
      q[columns[i].label()] = one.q[static_cast<Eigen::Index>(i)];
    j["assemblies"].push_back({{"own", j["assemblies"].empty()},
                               {"met", one.met},
                               {"apart", one.apart},
                               {"least_singular_value", one.least_value},
                               {"largest_singular_value", one.most_value},
                               {"q", q}});
  }
  tell(o, j.dump(2) + "\n",
       assemblies_in_words(mechanism, request, found) + assemblies_table(mechanism, found));
  return done;
}

}  // namespace momenta::program
