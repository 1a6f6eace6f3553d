#include "bindings.h"

#include <momenta/core/scene/scene.h>

PYBIND11_MODULE(momenta, module) {
  using namespace momenta::python;
  module.doc() =
      "Constrained multibody systems on canonical momenta: open chains, closed loops, and how far "
      "they drift.\n\n"
      "    m = momenta.load('examples/four_bar/scene.toml')\n"
      "    run = m.run(form='momentum', end=10)\n"
      "    run.t, run['B.x']\n\n"
      "SI units and radians; arrays are float64. t: time [s]; q: coordinates (nq); u: rates (nv); "
      "p: momenta (nv); sigma, lambda_: impulse and force multipliers of the loops (m). One "
      "Mechanism serves one thread at a time.";
  try {
    py::module_::import("numpy");
  } catch (const py::error_already_set&) {
    throw py::import_error(
        "momenta gives and takes NumPy arrays, and there is no NumPy: install "
        "python3-numpy");
  }
  py::register_exception<momenta::SceneError>(module, "SceneError", PyExc_ValueError);
  bind_runs(module);  // first: names of its classes stand in the signatures of Mechanism
  bind_mechanism(module);
}
