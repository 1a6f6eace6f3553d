// Options of verbs that write scenes and texts.

#include "verbs.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "help.h"
#include "values.h"

namespace momenta::program {

Verb add_convert(CLI::App& app, Options& o) {
  const auto own = std::make_shared<ConvertOptions>();
  CLI::App* verb = app.add_subcommand("convert", "Writes a scene, URDF or MJCF as a scene in TOML");
  verb->footer("Example: momenta convert examples/models/ur5/ur5_robot.urdf ur5.toml");
  add_scene_file(*verb, o);
  verb->add_flag("--quiet", o.quiet, "No messages about what was skipped");
  verb->add_option("out", own->out, "TOML file to write (default: standard output)")
      ->type_name("FILE");
  verb->add_flag("--recut", own->recut, "Assemble it, and move loop cuts to where they cost less");
  verb->add_option("--keep", own->keep, "With --recut: a joint or loop to leave; repeatable")
      ->type_name("NAME");
  return {verb, [&o, own] { return convert(o, *own); }};
}

Verb add_make(CLI::App& app, Options&) {
  struct Asked {
    std::string family;
    std::optional<int> n;
    bool turned = false;
  };
  const auto own = std::make_shared<Asked>();
  CLI::App* verb = app.add_subcommand("make", "Prints a scene of a family");
  verb->footer("Example: momenta make stewart --n 6 > stewart.toml");
  verb->add_option("family", own->family, "Which mechanism")->required()->type_name("FAMILY");
  verb->add_option("--n", own->n, "Size (each family has its own default)")->type_name("N");
  verb->add_flag("--turned", own->turned, "Planar families: in a plane oblique to all axes");
  return {verb, [own] { return make(own->family, own->n, own->turned); }};
}

Verb add_completion(CLI::App& app, Options&) {
  const auto own = std::make_shared<std::string>();
  CLI::App* verb =
      app.add_subcommand("completion", "Prints a script that completes this command line");
  verb->footer("Example: momenta completion bash > momenta");
  one_of(verb->add_option("shell", *own, "For which shell")->required(), {"bash", "zsh", "fish"});
  return {verb,
          [own, &app] { return std::fputs(completion_script(app, *own).c_str(), stdout), done; }};
}

Verb add_manual(CLI::App& app, Options&) {
  CLI::App* verb = app.add_subcommand("manual", "Prints momenta(1) in roff")->group("");
  return {verb, [&app] { return std::fputs(man_page(app).c_str(), stdout), done; }};
}

}  // namespace momenta::program
