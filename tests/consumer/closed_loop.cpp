// A mechanism with loops, run in one form; what was measured on the way.
#include <momenta/core/scene/read_scene.h>
#include <momenta/dae/study/run_form.h>

#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const momenta::Mechanism mechanism(momenta::read_scene(argv[1]));
  const momenta::Assembly assembly = momenta::assemble(mechanism);

  momenta::RunRequest request;
  request.settings.form = "momentum";
  request.settings.integrator = "dop853";
  request.settings.gauge = "leak:3";
  request.settings.rtol = request.settings.atol = 1e-10;
  request.settings.end_time = 10;
  const momenta::RunResult run = momenta::run_form(mechanism, assembly.start, request);

  std::cout << run.status << ": position drift " << run.position_drift_max << " m, energy within "
            << run.energy_error_max << " J\n";
  return run.status == "done" && run.position_drift_max < 1e-8 ? 0 : 1;
}
