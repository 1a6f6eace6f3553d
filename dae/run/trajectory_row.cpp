#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/trajectory_row.h>

#include <algorithm>
#include <unordered_map>

namespace momenta {

namespace {

/// Number of drift columns.
std::size_t drift_columns(const Mechanism& mechanism) {
  if (mechanism.m() == 0) return 0;
  return mechanism.has_lengths() && mechanism.has_angles() ? 4 : 2;
}

}  // namespace

TrajectoryRow::TrajectoryRow(const Mechanism& mechanism, bool reactions)
    : mechanism_(mechanism),
      reactions_(reactions),
      both_(mechanism.has_lengths() && mechanism.has_angles()),
      columns_(trajectory_columns(mechanism, reactions)),
      markers_(6 * mechanism.scene().markers.size()) {}

void TrajectoryRow::take_forces_of(const Mechanism& acting, Evaluation<double>& e,
                                   LoopSolver* solver) {
  forces_.emplace(acting, e, solver, reactions_);
  places_.clear();
  if (&acting == &mechanism_) return;
  const std::vector<std::string> all = trajectory_columns(acting, reactions_);
  const std::size_t state =
      static_cast<std::size_t>(mechanism_.nq() + mechanism_.nv()) + markers_.size() + 2;
  const std::size_t before = state + drift_columns(acting);
  for (std::size_t c = state + drift_columns(mechanism_); c < columns_.size(); ++c) {
    const auto at =
        std::find(all.begin() + static_cast<std::ptrdiff_t>(before), all.end(), columns_[c]);
    places_.push_back(static_cast<std::size_t>(at - all.begin()) - before);
  }
}

void TrajectoryRow::set(double t, const Snapshot& state, Evaluation<double>& e, double energy,
                        const Drift& position, const Drift& velocity) {
  row_.clear();
  row_.push_back(t);
  row_.insert(row_.end(), state.q.begin(), state.q.end());
  row_.insert(row_.end(), state.u.begin(), state.u.end());
  e.markers(markers_.data());
  row_.insert(row_.end(), markers_.begin(), markers_.end());
  row_.push_back(energy);
  if (mechanism_.m() > 0) {
    row_.push_back(position.named(mechanism_));
    row_.push_back(velocity.named(mechanism_));
    if (both_) row_.insert(row_.end(), {position.angles, velocity.angles});
  }
  if (forces_) append_forces(t, state);
}

void TrajectoryRow::append_forces(double t, const Snapshot& state) {
  first_force_ = row_.size();
  not_unique_.clear();
  forces_->solve(t, state.q, state.u);
  if (places_.empty()) return forces_->append(row_, not_unique_);
  // The acting mechanism has loops of stops that hold besides.
  acting_.clear();
  not_unique_acting_.clear();
  forces_->append(acting_, not_unique_acting_);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    row_.push_back(acting_[places_[k]]);
    if (std::find(not_unique_acting_.begin(), not_unique_acting_.end(), places_[k]) !=
        not_unique_acting_.end())
      not_unique_.push_back(first_force_ + k);
  }
}

void TrajectoryRow::note_undetermined(double t, std::size_t columns,
                                      std::vector<RunResult::Undetermined>& all) {
  if (noted_.size() != columns_.size()) {  // `all` may come from a run that this one continues
    noted_.assign(columns_.size(), columns_.size());
    std::unordered_map<std::string, std::size_t> place;
    for (std::size_t i = 0; i < all.size(); ++i) place.emplace(all[i].column, i);
    for (std::size_t c = 0; c < columns_.size(); ++c)
      if (const auto at = place.find(columns_[c]); at != place.end()) noted_[c] = at->second;
  }
  for (const std::size_t column : not_unique_) {
    if (column >= columns) return;
    std::size_t& at = noted_[column];
    if (at == columns_.size()) {
      at = all.size();
      all.push_back({columns_[column], 0, t, t});
    }
    ++all[at].samples;
    all[at].to = t;
  }
}

std::vector<std::string> trajectory_columns(const Mechanism& mechanism, bool reactions) {
  std::vector<std::string> columns{"t [s]"};
  const auto add = [&](const std::vector<Column>& more) {
    for (const auto& c : more) columns.push_back(c.label());
  };
  add(mechanism.coordinate_columns());
  add(mechanism.rate_columns());
  add(mechanism.marker_columns());
  columns.emplace_back("energy [J]");
  if (mechanism.m() > 0) {
    const bool lengths = mechanism.has_lengths();
    columns.emplace_back(lengths ? "position_drift [m]" : "position_drift [rad]");
    columns.emplace_back(lengths ? "velocity_drift [m/s]" : "velocity_drift [rad/s]");
    if (lengths && mechanism.has_angles()) {
      columns.emplace_back("angle_drift [rad]");
      columns.emplace_back("angle_rate_drift [rad/s]");
    }
    const std::vector<Column> multipliers = mechanism.multiplier_columns();
    const std::vector<RowName>& rows = mechanism.rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      columns.push_back(multipliers[i].label());
      if (i + 1 == rows.size() || rows[i + 1].loop != rows[i].loop)
        columns.push_back(rows[i].loop + ".undetermined [1]");
    }
  }
  add(mechanism.effort_columns());
  if (reactions && !mechanism.scene().lagrangian)
    for (const JointPlace& joint : joint_places(mechanism)) {
      for (const char* axis : {".force_x", ".force_y", ".force_z"})
        columns.push_back(joint.name + axis + " [N]");
      for (const char* axis : {".torque_x", ".torque_y", ".torque_z"})
        columns.push_back(joint.name + axis + " [N m]");
    }
  return columns;
}

}  // namespace momenta
