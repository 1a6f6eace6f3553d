// Any scene as TOML.

#include <momenta/core/scene/write_scene.h>

#include <cstdio>

#include "options.h"

namespace momenta::program {

int convert(const Options& o, const std::filesystem::path& out) {
  const std::string text = scene_text(read(o));
  if (out.empty() || out == "-")
    std::fputs(text.c_str(), stdout);
  else if (!write_result(out, text))
    return run_failed;
  return done;
}

}  // namespace momenta::program
