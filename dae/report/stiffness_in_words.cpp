#include <momenta/dae/form/form.h>
#include <momenta/dae/report/stiffness_in_words.h>
#include <momenta/dae/text/number_text.h>

#include <cmath>

namespace momenta {
namespace {

/// Options for a run by BDF, whose memory allows no change of the state.
std::string implicit_instead(const RunSettings& s) {
  if (needs_one_step_method(s.form)) return "--form momentum --integrator bdf";
  const bool altering = s.gauge == "reset" || s.gauge == "flip";
  return std::string("--integrator bdf") + (altering ? " --gauge leak" : "");
}

}  // namespace

std::string stiffness_in_words(const RunResult& run) {
  if (std::isnan(run.stiff_from)) return "";
  const RunSettings& s = run.settings;
  const std::string from =
      "Stiff from t = " + compact(run.stiff_from, 4) + " s: steps of " + s.integrator;
  if (changed(run))
    return from + " became as long as its stability allows, shorter than its tolerance asks for; " +
           s.when_stiff + " went on from t = " + compact(run.changed_at, 4) + " s (--integrator " +
           s.integrator + ": no change)";
  return from +
         " are as long as its stability allows, shorter than its tolerance asks for; implicit "
         "methods take fewer: " +
         implicit_instead(s) + ", or a form by ida";
}

}  // namespace momenta
