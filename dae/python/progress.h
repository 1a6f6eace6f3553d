#pragma once
// Progress of a long call, told to a Python function of (fraction, text), at most a hundred times
// and at the end. An exception of the function, and Ctrl-C, stop the call at its next sample.

#include <algorithm>

#include "bindings.h"

namespace momenta::python {

class Progress {
 public:
  /// `told`: argument of the package's teller().
  explicit Progress(const py::object& told)
      : told_(py::module_::import("momenta.progress").attr("teller")(told)) {}

  /// False once the call should stop. @pre the interpreter's lock is released
  bool operator()(double fraction, const std::string& text) {
    const py::gil_scoped_acquire lock;
    return PyErr_Occurred() == nullptr && PyErr_CheckSignals() == 0 && tell(fraction, text);
  }
  bool of_study(int number, int total, const std::string& label, double part) {
    return (*this)((number - 1 + part) / std::max(total, 1),
                   "[" + std::to_string(number) + "/" + std::to_string(total) + "] " + label);
  }

  /// Calls work() without the interpreter's lock, reports its end, and raises what stopped it.
  template <class Work>
  void during(const Work& work) {
    try {
      const py::gil_scoped_release unlocked;
      work();
    } catch (...) {
      raise();
      throw;
    }
    if (PyErr_Occurred() == nullptr && next_ <= 1) tell(1, text_);
    raise();
  }

 private:
  static void raise() {
    if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  }
  bool tell(double fraction, const std::string& text) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    if (told_.is_none() || fraction < next_) return true;
    next_ = fraction < 1 ? std::min(1.0, fraction + 0.01) : 2;
    text_ = text;
    try {
      told_(fraction, text);
    } catch (py::error_already_set& raised) {
      raised.restore();
      return false;
    }
    return true;
  }

  py::object told_;
  std::string text_;
  double next_ = 0;  ///< next fraction to report
};

}  // namespace momenta::python
