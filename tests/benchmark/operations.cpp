// Operations of one evaluation of serial revolute joint chains, n bodies, gravity included, sines
// and cosines left out, counted by running the kernels on counting numbers; beside them the table
// of the paper. Formulas are the line through n = 40 and n = 41; the column "exact" says whether it
// meets n = 10.

#include <momenta/core/open_chain/operations.h>

#include <cstdio>
#include <string>

#include "models.h"

namespace {

using namespace momenta;

OperationCount count(Scene (*model)(int), int n, Recursion recursion) {
  const Scene scene = model(n);
  const Tree tree = build_tree(scene);
  return count_operations(tree, scene, make_plan(tree, scene), recursion);
}

struct Line {
  long slope, offset;
  std::string text() const {
    char s[64];
    std::snprintf(s, sizeof s, "%ldn %c %ld", slope, offset < 0 ? '-' : '+', std::labs(offset));
    return s;
  }
};
Line through(long a, long b) {
  return {b - a, a - 40 * (b - a)};
}

void row(const char* what, Scene (*model)(int), Recursion recursion) {
  const auto at = [&](int n) { return count(model, n, recursion); };
  const OperationCount a = at(40), b = at(41), small = at(10);
  const auto print = [&](const char* which, const Operations& x, const Operations& y,
                         const Operations& check) {
    const Line total = through(x.total(), y.total());
    std::printf("| %-34s | %-8s | %-11s | %-11s | %-9s | %-12s | %5ld | %s\n", what, which,
                through(x.adds, y.adds).text().c_str(),
                through(x.multiplications, y.multiplications).text().c_str(),
                through(x.divisions, y.divisions).text().c_str(), total.text().c_str(),
                check.total(), total.slope * 10 + total.offset == check.total() ? "yes |" : "no |");
  };
  print("executed", a.executed, b.executed, small.executed);
  print("needed", a.needed, b.needed, small.needed);
}

}  // namespace

int main() {
  using namespace benchmark_models;
  std::printf(
      "| %-34s | count    | adds        | multiplies  | divisions | all          |  n=10 | exact "
      "|\n"
      "|---|---|---|---|---|---|---|---|\n",
      "recursion, chain");
  row("momentum, any angles", random_chain, Recursion::momentum);
  row("acceleration, any angles", random_chain, Recursion::acceleration);
  row("momentum, right angles", right_angle_chain, Recursion::momentum);
  row("acceleration, right angles", right_angle_chain, Recursion::acceleration);
  row("momentum, planar", planar_chain, Recursion::momentum);
  row("acceleration, planar", planar_chain, Recursion::acceleration);
  std::printf(
      "\nTable 1 of the paper (additions, multiplications, all):\n"
      "  Featherstone    275n - 18   336n - 220  611n - 238\n"
      "  Vukobratovic    231n - 294  249n - 272  480n - 566\n"
      "  Valasek         206n - 345  226n - 343  432n - 688\n"
      "  Rein            195n - 247  216n - 317  411n - 669  (its terms add up to 411n - 564)\n"
      "  Naudet-Lefeber  178n - 230  185n - 245  363n - 475\n");
}
