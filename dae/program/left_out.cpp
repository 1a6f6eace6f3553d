// Replaces verbs that momenta_main_job leaves out, to halve its compile time.

#include <cstdio>

#include "answers.h"

namespace momenta::program {
namespace {

int left_out(const char* verb) {
  std::fprintf(
      stderr,
      "momenta: this program has run, view, drift and make alone; for '%s' build all verbs:"
      " cmake --build --preset release --target momenta\n",
      verb);
  return bad_input;
}

}  // namespace

int check(const Options&) {
  return left_out("check");
}
int assemble_verb(const Options&) {
  return left_out("assemble");
}
int assemblies(const Options&, const AssembliesOptions&) {
  return left_out("assemble");
}
int work(const Options&, const WorkOptions&) {
  return left_out("work");
}
int stress(const Options&, const StressOptions&) {
  return left_out("stress");
}
int sweep(const Options&, const SweepOptions&) {
  return left_out("sweep");
}
int modes(const Options&, const ModesOptions&) {
  return left_out("modes");
}
int linearise_verb(const Options&, const LineariseOptions&) {
  return left_out("linearise");
}
int move(const Options&, const MoveOptions&) {
  return left_out("move");
}
int effort(const Options&, const EffortOptions&) {
  return left_out("effort");
}
int gradient_verb(const Options&, const GradientOptions&) {
  return left_out("gradient");
}
int section(const Options&, const SectionOptions&) {
  return left_out("section");
}
int fit(const Options&, const FitOptions&) {
  return left_out("fit");
}
int evaluate(const Options&, const std::string&) {
  return left_out("evaluate");
}
int index_verb(const Options&, const std::string&, const std::string&) {
  return left_out("index");
}
int run_equation_file(const Options&) {
  return left_out("run of equations");
}
int index_of_equations(const Options&) {
  return left_out("index");
}
int work_on_equations(const Options&, const WorkOptions&) {
  return left_out("work");
}
int bench(const Options&, bool) {
  return left_out("bench");
}
int convert(const Options&, const ConvertOptions&) {
  return left_out("convert");
}

}  // namespace momenta::program
