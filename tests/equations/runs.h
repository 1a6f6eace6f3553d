#pragma once
// Runs as tests ask for them: a form by an integrator, with error control or by steps of one
// length, in a gauge, up to an end, with so many samples.

#include <momenta/dae/run/run_form.h>

#include <string>
#include <utility>

namespace momenta::equations {

/// With error control at one tolerance. What is left out is as RunSettings has it.
inline RunRequest adaptive(const std::string& form, const std::string& integrator,
                           const std::string& gauge, double tolerance,
                           double end = RunSettings().end_time,
                           int samples = RunSettings().samples) {
  RunRequest request;
  request.settings.form = form;
  request.settings.integrator = integrator;
  request.settings.gauge = gauge;
  request.settings.rtol = request.settings.atol = tolerance;
  request.settings.end_time = end;
  request.settings.samples = samples;
  return request;
}

/// By steps of one length [s].
inline RunRequest stepped(const std::string& form, const std::string& integrator,
                          const std::string& gauge, double step,
                          double end = RunSettings().end_time,
                          int samples = RunSettings().samples) {
  RunRequest request = adaptive(form, integrator, gauge, RunSettings().rtol, end, samples);
  request.settings.step = step;
  return request;
}

/// The same, whose trajectory is kept.
inline RunRequest kept(RunRequest request) {
  request.keep_trajectory = true;
  return request;
}

}  // namespace momenta::equations
