#include "bindings.h"

#include <momenta/core/scene/scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/environment.h>

// The compiled part of the package momenta; the package decides what is public.
PYBIND11_MODULE(_momenta, module) {
  using namespace momenta::python;
  module.doc() = "The compiled part of momenta.";
  // Signatures, messages and pickles name the package, where users find its parts.
  module.attr("__module__") = "momenta";
  try {
    py::module_::import("numpy");
  } catch (const py::error_already_set&) {
    throw py::import_error(
        "momenta gives and takes NumPy arrays, and there is no NumPy: install "
        "python3-numpy");
  }
  module.attr("__version__") = momenta::version();
  py::register_exception<momenta::SceneError>(module, "SceneError", PyExc_ValueError)
      .attr("__module__") = "momenta";
  // Names in messages may contain bytes that are not UTF-8, of which Python makes no string.
  py::register_exception_translator([](std::exception_ptr thrown) {
    const auto raise = [](PyObject* kind, const char* what) {
      PyErr_SetString(kind, momenta::reading::on_one_line(what).c_str());
    };
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const momenta::SceneError& e) {
      raise(py::module_::import("momenta").attr("SceneError").ptr(), e.what());
    } catch (const py::value_error& e) {
      raise(PyExc_ValueError, e.what());
    } catch (const py::key_error& e) {
      raise(PyExc_KeyError, e.what());
    } catch (const std::invalid_argument& e) {
      raise(PyExc_ValueError, e.what());
    }
  });
  bind_runs(module);  // first: signatures of Mechanism name its classes
  bind_mechanism(module);
  bind_verbs(module);
}
