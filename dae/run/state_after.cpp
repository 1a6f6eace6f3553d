#include <momenta/core/text/number_text.h>
#include <momenta/dae/run/state_after.h>

#include <algorithm>

namespace momenta {

Start state_after(const Mechanism& mechanism, const Start& start, const RunSettings& settings,
                  double max_cpu_seconds) {
  RunRequest request;
  request.settings = settings;
  request.settings.samples = 1;
  request.keep_trajectory = true;
  request.max_cpu_seconds = max_cpu_seconds;
  const RunResult run = run_form(mechanism, start, request);
  if (run.status != "done")
    throw SceneError(mechanism.scene().where({}) +
                     "the run to t = " + compact(settings.end_time, 6) +
                     " s ends at t = " + compact(run.stopped_at, 6) + " s (" + run.status +
                     (run.reason.empty() ? "" : ": " + run.reason) + "); expected it to be done");
  // trajectory_columns(): t, then q, then u.
  const std::vector<double>& row = run.trajectory.rows.back();
  Eigen::VectorXd q(mechanism.nq()), u(mechanism.nv());
  std::copy_n(row.begin() + 1, q.size(), q.begin());
  std::copy_n(row.begin() + 1 + q.size(), u.size(), u.begin());
  return assemble(mechanism, row.front(), q, u).start;
}

}  // namespace momenta
