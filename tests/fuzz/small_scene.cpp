// Any bytes as a small mechanism: checked, assembled and run for 0.01 s, or refused in one
// sentence.

#include "equations/small_scenes.h"

#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace momenta::equations;
  const std::span bytes(data, size);
  const Tried tried = try_scene(small_scene(bytes), form_for(bytes), 0.01);
  if (tried.wrong.empty()) return 0;
  std::fprintf(stderr, "%s: %s\n", form_for(bytes).c_str(), tried.wrong.c_str());
  std::abort();
}
