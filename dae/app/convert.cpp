// The verb `convert`: writes any scene as TOML, unchanged or with other joints cut.

#include <momenta/core/format/toml/write_scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/topology/cut/recut.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "checked.h"
#include "loading.h"
#include "results.h"
#include "verb.h"

namespace momenta::program {
namespace {

struct ConvertOptions {
  std::filesystem::path out;      ///< empty or "-": standard output
  bool recut = false;             ///< cuts loops for the least work
  std::vector<std::string> keep;  ///< joints and loops that stay
};

Scene recut_scene(const Options& o, const ConvertOptions& c) {
  const Mechanism mechanism(read(o));
  Recut found = recut(mechanism, assemble(mechanism).start, c.keep);
  if (!o.quiet) std::fprintf(stderr, "momenta: %s\n", cuts_in_words(found).c_str());
  std::vector<std::string> lost;
  for (const JointSpec& joint : mechanism.scene().joints)
    if (joint.limits &&
        std::find(found.cut.begin(), found.cut.end(), joint.name) != found.cut.end())
      lost.push_back(joint.name);
  if (!lost.empty()) {
    const std::string remark =
        "left out: limits of joints that became loops: " + reading::all_in_quotes(lost);
    found.scene.remarks.push_back(remark);
    if (!o.quiet) std::fprintf(stderr, "momenta: %s\n", remark.c_str());
  }
  return found.scene;
}

/// Names files of meshes from the folder of `out`.
void find_meshes_from(const std::filesystem::path& out, Scene& scene) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path before = fs::weakly_canonical(fs::absolute(scene.file), error).parent_path(),
                 now = fs::weakly_canonical(fs::absolute(out), error).parent_path();
  for (VisualSpec& visual : scene.visuals)
    if (!visual.file.empty())
      visual.file = (before / visual.file).lexically_normal().lexically_relative(now).string();
}

int convert(const Options& o, const ConvertOptions& c) {
  if (!c.keep.empty() && !c.recut)
    throw std::invalid_argument("--keep says what --recut leaves as it is; expected both");
  Scene scene = c.recut ? recut_scene(o, c) : read(o);
  if (c.out.empty() || c.out == "-") {
    std::fputs(scene_text(scene).c_str(), stdout);
    return done;
  }
  std::vector<std::filesystem::path> read = o.inputs;
  read.insert(read.end(), scene.included.begin(), scene.included.end());
  const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
  for (const VisualSpec& visual : scene.visuals)
    if (!visual.file.empty()) read.push_back(folder / visual.file);
  if (is_read(c.out, read))
    throw std::invalid_argument(c.out.string() +
                                " is a file that the scene is read from, expected another to "
                                "write the TOML to");
  find_meshes_from(c.out, scene);
  return write_results({{c.out, scene_text(scene)}}) ? done : run_failed;
}

}  // namespace

Verb declare_convert(CLI::App& app, Options& o) {
  const auto own = std::make_shared<ConvertOptions>();
  CLI::App& verb = add_verb(app, "convert", "Writes a scene, URDF or MJCF as a scene in TOML",
                            "momenta convert examples/models/ur5/ur5_robot.urdf ur5.toml");
  add_scene_file(verb, o);
  verb.add_flag("--quiet", o.quiet, "No messages about what was skipped");
  verb.add_option("out", own->out, "TOML file to write (default: standard output)")
      ->type_name("FILE");
  verb.add_flag("--recut", own->recut, "Assemble it, and move loop cuts to where they cost less");
  verb.add_option("--keep", own->keep, "With --recut: a joint or loop to leave; repeatable")
      ->type_name("NAME");
  return {&verb, [&o, own] { return convert(o, *own); }};
}

}  // namespace momenta::program
