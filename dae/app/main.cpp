// The program `momenta`.

#include <momenta/core/kernel/levels/level.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/text/utf8.h>
#include <momenta/dae/study/environment.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "help.h"
#include "loading.h"
#include "results.h"
#include "verb.h"

using namespace momenta::program;

namespace {

int answer(int argc, char** argv) {
  Options o;
  o.command = "momenta";
  for (int i = 1; i < argc; ++i) o.command += " " + momenta::reading::as_utf8(argv[i]);
  CLI::App app(
      "Constrained multibody systems on canonical momenta: open chains, closed loops, "
      "and how far they drift.");
  app.require_subcommand(1);
  // First: verbs inherit it.
  app.formatter_fn(
      [](const CLI::App* of, std::string, CLI::AppFormatMode) { return screen_help(*of); });
  app.set_help_flag("--help", "This text");
  app.set_version_flag("--version", std::string("momenta ") + momenta::version(), "The version");
  app.footer(std::string(exit_status) +
             "\nExample: momenta drift examples/four_bar/scene.toml --out results");

  const std::vector<Verb> verbs = all_verbs(app, o);

  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return bad_input;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::fprintf(stderr, "momenta: %s\n", typed_wrong(app, e, {argv + 1, argv + argc}).c_str());
    return bad_input;
  }
  for (const CLI::App* verb : app.get_subcommands()) {
    o.asked = verb->get_name();
    for (const CLI::Option* option : verb->get_options()) {
      const std::string name = option->get_name();
      if (option->count() > 0 && name.starts_with("--")) o.given.push_back(name);
      const Values::Paths paths = values_of(option->get_type_name()).paths;
      if (name != "out" && (paths == Values::Paths::scenes || paths == Values::Paths::files))
        for (const std::string& file : option->results()) o.inputs.emplace_back(file);
      if (option->count() == 0 || name == "scene" || name == "--reference" || name == "--out" ||
          name == "--figures" || name == "--json" || name == "--quiet" || name == "--threads" ||
          name == "--task")
        continue;
      for (const std::string& value : option->results()) o.asked += " " + name + "=" + value;
    }
  }
  try {
    expect_inputs_kept(o);
    if (!o.level.empty()) momenta::use_level(std::stoi(o.level));
    const auto asked =
        std::find_if(verbs.begin(), verbs.end(), [](const Verb& verb) { return bool(*verb.app); });
    if (!names_equations(o)) return asked->answer();
    if (asked->of_equations) return asked->of_equations();
    throw std::invalid_argument(o.scene.string() +
                                " holds equations, expected a scene; run, "
                                "index, work and, in a suite, bench take equations");
  } catch (const momenta::SceneError& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
  } catch (const std::invalid_argument& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
  } catch (const std::runtime_error& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
    return run_failed;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "momenta: not enough memory for this scene\n");
    return run_failed;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "momenta: %s\n", e.what());
    return run_failed;
  }
  return bad_input;
}

}  // namespace

int main(int argc, char** argv) {
  // A file at its size limit is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  const int status = answer(argc, argv);
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  std::fprintf(stderr, "momenta: standard output cannot be written: %s\n", std::strerror(errno));
  return status == done ? run_failed : status;
}
