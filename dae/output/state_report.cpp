#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/state_report.h>
#include <momenta/dae/run/measure/rank.h>

#include <array>
#include <map>

namespace momenta {
namespace {

class StateDocument {
 public:
  StateDocument(const Mechanism& mechanism, const GivenState& given, const StateValues& s)
      : mechanism_(mechanism),
        given_(given),
        s_(s),
        loops_(mechanism.m() > 0),
        places_(joint_places(mechanism)) {}

  std::string write() {
    w_.text("scene", mechanism_.scene().name);
    w_.number("t", given_.t);
    w_.text("given", given_.of_momenta ? "p" : "v");
    if (loops_)
      w_.text("gauge", given_.of_momenta ? "p has the impulses of the loops in it: v and sigma "
                                           "solve (7)"
                                         : "sigma = 0: p = M v");
    by_joint("q", given_.q, &JointPlace::q);
    by_joint("v", s_.v);
    by_joint("p", s_.p);
    by_joint("tau", given_.tau);
    by_joint("qdot", s_.qdot, &JointPlace::q);
    by_joint("pdot", s_.pdot);
    by_joint("bias", s_.bias);
    w_.open("acceleration");
    by_joint("free", s_.free);
    if (loops_) by_joint("constrained", s_.constrained);
    w_.close();
    if (mechanism_.plan().drives && !mechanism_.scene().lagrangian) driven();
    if (loops_) loops();
    dense();
    if (!given_.residue.empty()) w_.text("residue", given_.residue);
    if (!s_.not_there.empty()) w_.text("not_there", s_.not_there);
    w_.open("energy");
    w_.number("T", s_.kinetic);
    w_.number("V", s_.potential);
    w_.number("H", s_.hamiltonian);
    w_.close();
    const bool bodies = !mechanism_.scene().lagrangian;
    for (const char* key : {"centroidal", "whole"}) {  // `whole`: deprecated
      if (!bodies) break;
      w_.open(key);
      w_.number("mass", s_.centroidal.mass);
      w_.numbers("centre_of_mass", s_.centroidal.centre);
      w_.numbers("linear_momentum", s_.centroidal.linear_momentum);
      w_.numbers("angular_momentum", s_.centroidal.angular_momentum);
      w_.close();
    }
    w_.open("reactions");
    for (const Transmitted& r : s_.reactions.joints) {
      w_.open(r.name);
      wrench(r);
      w_.close();
    }
    w_.close();
    markers();
    return w_.take();
  }

 private:
  void by_joint(const std::string& key, const Eigen::VectorXd& x,
                std::vector<int> JointPlace::*where = &JointPlace::u) {
    w_.open(key);
    for (const JointPlace& joint : places_)
      if (!joint.u.empty()) w_.numbers(joint.name, x(joint.*where));
    w_.close();
  }

  void wrench(const Transmitted& r) {
    w_.numbers("force", r.force);
    w_.numbers("torque", r.torque);
    w_.numbers("at", r.at);
    if (!r.unique) w_.text("not_unique", "redundant loops share this load");
  }

  void driven() {
    w_.open("driven");
    for (const JointPlace& joint : places_) {
      if (joint.drives.empty()) continue;
      std::vector<double> q, v, acceleration;
      for (const int drive : joint.drives) {
        double f, rate, second;
        mechanism_.tree().drives[static_cast<std::size_t>(drive)].evaluate(given_.t, f, rate,
                                                                           second);
        q.push_back(f);
        v.push_back(rate);
        acceleration.push_back(second);
      }
      prescribed(joint.name, q, v, acceleration);
    }
    std::map<std::string, std::array<std::vector<double>, 3>> of_loops;  // values in the order of
                                                                         // drives
    for (const DriveSpec& drive : mechanism_.scene().drives) {
      if (drive.loop.empty()) continue;
      double f, rate, second;
      MotionLaw(drive).evaluate(given_.t, f, rate, second);
      auto& [q, v, acceleration] = of_loops[drive.loop];
      q.push_back(f);
      v.push_back(rate);
      acceleration.push_back(second);
    }
    for (const auto& [name, x] : of_loops) prescribed(name, x[0], x[1], x[2]);
    w_.close();
  }

  void prescribed(const std::string& name, const std::vector<double>& q,
                  const std::vector<double>& v, const std::vector<double>& acceleration) {
    w_.open(name);
    w_.numbers("q", q);
    w_.numbers("v", v);
    w_.numbers("acceleration", acceleration);
    w_.close();
  }

  void loops() {
    w_.open("loops");
    const std::vector<RowName>& rows = mechanism_.rows();
    std::size_t row = 0;  // rows are ordered by loop
    for (std::size_t i = 0; i < s_.reactions.loops.size(); ++i) {
      const Transmitted& r = s_.reactions.loops[i];
      const auto first = static_cast<Eigen::Index>(row);
      std::vector<std::string> what;
      for (; row < rows.size() && rows[row].loop == r.name; ++row) what.push_back(rows[row].what);
      const auto count = static_cast<Eigen::Index>(row) - first;
      w_.open(r.name);
      w_.texts("equations", what);
      w_.numbers("phi", s_.phi.segment(first, count));
      w_.numbers("phidot", s_.phidot.segment(first, count));
      w_.numbers("sigma", s_.sigma.segment(first, count));
      w_.numbers("lambda", s_.lambda.segment(first, count));
      if (!mechanism_.scene().lagrangian && ties_bodies(mechanism_.scene().loops[i])) wrench(r);
      w_.close();
    }
    w_.close();
    w_.whole_number("loop_equations", mechanism_.m());
    w_.whole_number("faded_equations", s_.faded);
  }

  void dense() {
    if (!s_.dense) {
      w_.text("left_out", std::string(loops_ ? "M, rank and singular values" : "M") +
                              ": more than " + std::to_string(dense_state_limit) +
                              " rates and loop equations");
      return;
    }
    if (loops_) {
      w_.whole_number("rank", s_.loops.rank);
      w_.whole_number("mobility", mechanism_.nv() - s_.loops.rank);
      std::vector<std::string> dependent;
      for (const int row : s_.loops.dependent) dependent.push_back(row_in_words(mechanism_, row));
      w_.texts("dependent_equations", dependent);
      w_.numbers("singular_values", s_.loops.singular_values);
    }
    std::vector<std::string> names(static_cast<std::size_t>(mechanism_.nv()));
    for (const JointPlace& joint : places_)
      for (std::size_t i = 0; i < joint.u.size(); ++i)
        names[static_cast<std::size_t>(joint.u[i])] =
            joint.name + (joint.u.size() == 1 ? "" : "[" + std::to_string(i) + "]");
    w_.texts("dofs", names);
    w_.rows("M", s_.mass);
  }

  void markers() {
    w_.open("markers");
    const double* x = s_.markers.data();
    for (const auto& marker : mechanism_.scene().markers) {
      w_.open(marker.name);
      w_.numbers("position", std::vector(x, x + 3));
      w_.numbers("velocity", std::vector(x + 3, x + 6));
      w_.close();
      x += 6;
    }
    w_.close();
  }

  const Mechanism& mechanism_;
  const GivenState& given_;
  const StateValues& s_;
  bool loops_;
  std::vector<JointPlace> places_;
  JsonWriter w_;
};

}  // namespace

std::string state_json(const Mechanism& mechanism, const GivenState& given,
                       const StateValues& values) {
  return StateDocument(mechanism, given, values).write();
}

}  // namespace momenta
