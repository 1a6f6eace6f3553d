// The verb `convert`: writes any scene as TOML, as it is or with other joints cut.

#include <momenta/core/scene/toml/write_scene.h>
#include <momenta/dae/cut/recut.h>

#include <cstdio>

#include "cut_words.h"
#include "options.h"

namespace momenta::program {
namespace {

Scene recut_scene(const Options& o, const ConvertOptions& c) {
  const Mechanism mechanism(read(o));
  const Recut found = recut(mechanism, assemble(mechanism).start, c.keep);
  if (!o.quiet) std::fprintf(stderr, "momenta: %s\n", cuts_in_words(found).c_str());
  return found.scene;
}

}  // namespace

int convert(const Options& o, const ConvertOptions& c) {
  if (!c.keep.empty() && !c.recut)
    throw std::invalid_argument("--keep says what --recut leaves as it is; expected both");
  const std::string text = scene_text(c.recut ? recut_scene(o, c) : read(o));
  if (c.out.empty() || c.out == "-")
    std::fputs(text.c_str(), stdout);
  else if (!write_results({{c.out, text}}))
    return run_failed;
  return done;
}

}  // namespace momenta::program
