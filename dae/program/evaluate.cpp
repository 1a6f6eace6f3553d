// Everything at one state, as one JSON document; keys and units: docs/reference/evaluate.md.

#include <momenta/dae/joint_places.h>

#include <cstdio>

#include "options.h"
#include "state_input.h"

namespace momenta::program {
namespace {

using Json = nlohmann::ordered_json;

template <class Numbers>
Json numbers(const Numbers& x) {
  Json array = Json::array();
  for (const double value : x) array.push_back(number_or_null(value));
  return array;
}

/// Indented objects; arrays of numbers stay on one line, matrices take one line a row.
void print(const Json& j, int depth, std::string& out) {
  if (!j.is_structured() || j.empty()) {
    out += j.dump();
    return;
  }
  const bool line = j.is_array() && !j.front().is_structured();
  const std::string margin(static_cast<std::size_t>(2 * depth), ' ');
  const std::string start = line ? "" : "\n" + margin + "  ";
  out += j.is_array() ? "[" : "{";
  std::string before = start;
  for (const auto& [key, value] : j.items()) {
    out += before;
    if (j.is_object()) out += Json(key).dump() + ": ";
    print(value, depth + 1, out);
    before = "," + (line ? std::string(" ") : start);
  }
  if (!line) out += "\n" + margin;
  out += j.is_array() ? "]" : "}";
}

class Document {
 public:
  Document(const Mechanism& mechanism, const GivenState& given, const StateValues& s)
      : mechanism_(mechanism),
        given_(given),
        s_(s),
        loops_(mechanism.m() > 0),
        places_(joint_places(mechanism.tree())) {}

  Json write() const {
    Json j;
    j["scene"] = mechanism_.scene().name;
    j["t"] = given_.t;
    j["given"] = given_.of_momenta ? "p" : "v";
    if (loops_)
      j["gauge"] = given_.of_momenta
                       ? "p has the impulses of the loops in it: v and sigma solve (7)"
                       : "sigma = 0: p = M v";
    j["q"] = by_joint(given_.q, &JointPlace::q);
    j["v"] = by_joint(s_.v);
    j["p"] = by_joint(s_.p);
    j["tau"] = by_joint(given_.tau);
    j["qdot"] = by_joint(s_.qdot, &JointPlace::q);
    j["pdot"] = by_joint(s_.pdot);
    j["bias"] = by_joint(s_.bias);
    j["acceleration"]["free"] = by_joint(s_.free);
    if (loops_) j["acceleration"]["constrained"] = by_joint(s_.constrained);
    driven(j);
    if (loops_) loops(j);
    dense(j);
    j["energy"] = {{"T", number_or_null(s_.kinetic)},
                   {"V", number_or_null(s_.potential)},
                   {"H", number_or_null(s_.hamiltonian)}};
    j["whole"] = {{"mass", number_or_null(s_.whole.mass)},
                  {"centre_of_mass", numbers(s_.whole.centre)},
                  {"linear_momentum", numbers(s_.whole.linear_momentum)},
                  {"angular_momentum", numbers(s_.whole.angular_momentum)}};
    j["reactions"] = Json::object();
    for (const Transmitted& r : s_.reactions.joints)
      j["reactions"][r.name] = {
          {"force", numbers(r.force)}, {"torque", numbers(r.torque)}, {"at", numbers(r.at)}};
    j["markers"] = Json::object();
    const double* x = s_.markers.data();
    for (const auto& marker : mechanism_.scene().markers) {
      j["markers"][marker.name] = {{"position", numbers(std::vector(x, x + 3))},
                                   {"velocity", numbers(std::vector(x + 3, x + 6))}};
      x += 6;
    }
    return j;
  }

 private:
  Json by_joint(const Eigen::VectorXd& x,
                std::vector<int> JointPlace::*where = &JointPlace::u) const {
    Json table = Json::object();
    for (const JointPlace& joint : places_) {
      if (joint.u.empty()) continue;
      Json& array = table[joint.name] = Json::array();
      for (const int i : joint.*where) array.push_back(number_or_null(x[i]));
    }
    return table;
  }

  void driven(Json& j) const {
    for (const JointPlace& joint : places_)
      for (const int drive : joint.drives) {
        double f, rate, acceleration;
        mechanism_.tree().drives[static_cast<std::size_t>(drive)].evaluate(given_.t, f, rate,
                                                                           acceleration);
        Json& table = j["driven"][joint.name];
        table["q"].push_back(number_or_null(f));
        table["v"].push_back(number_or_null(rate));
        table["acceleration"].push_back(number_or_null(acceleration));
      }
  }

  const RowName& row(int i) const { return mechanism_.rows()[static_cast<std::size_t>(i)]; }
  void loops(Json& j) const {
    int i = 0;  // rows stand loop by loop
    for (const Transmitted& r : s_.reactions.loops) {
      Json& loop = j["loops"][r.name];
      for (const char* key : {"equations", "phi", "phidot", "sigma", "lambda"})
        loop[key] = Json::array();
      for (; i < mechanism_.m() && row(i).loop == r.name; ++i) {
        loop["equations"].push_back(row(i).what);
        loop["phi"].push_back(number_or_null(s_.phi[i]));
        loop["phidot"].push_back(number_or_null(s_.phidot[i]));
        loop["sigma"].push_back(number_or_null(s_.sigma[i]));
        loop["lambda"].push_back(number_or_null(s_.lambda[i]));
      }
      loop["force"] = numbers(r.force);
      loop["torque"] = numbers(r.torque);
      loop["at"] = numbers(r.at);
    }
    j["loop_equations"] = mechanism_.m();
    j["faded_equations"] = s_.faded;
  }

  void dense(Json& j) const {
    if (!s_.dense) {
      j["left_out"] = std::string(loops_ ? "M, rank and singular values" : "M") + ": more than " +
                      std::to_string(dense_state_limit) + " rates and loop equations";
      return;
    }
    if (loops_) {
      j["rank"] = s_.rank;
      j["mobility"] = mechanism_.nv() - s_.rank;
      j["singular_values"] = numbers(s_.singular_values);
    }
    std::vector<std::string> names(static_cast<std::size_t>(mechanism_.nv()));
    for (const JointPlace& joint : places_)
      for (std::size_t i = 0; i < joint.u.size(); ++i)
        names[static_cast<std::size_t>(joint.u[i])] =
            joint.name + (joint.u.size() == 1 ? "" : "[" + std::to_string(i) + "]");
    j["dofs"] = names;
    j["M"] = Json::array();
    for (const auto& row : s_.mass.rowwise()) j["M"].push_back(numbers(row));
  }

  const Mechanism& mechanism_;
  const GivenState& given_;
  const StateValues& s_;
  bool loops_;
  std::vector<JointPlace> places_;
};

}  // namespace

int evaluate(const Options& o, const std::string& state) {
  const auto mechanism = load(o);
  const GivenState given = read_state(state, *mechanism);
  const StateValues values = evaluate_state(*mechanism, given);
  std::string json;
  print(Document(*mechanism, given, values).write(), 0, json);
  json += "\n";
  if (!o.out.empty() && !write_result(o.out / "evaluate.json", json)) return run_failed;
  if (o.out.empty() || o.json) std::fputs(json.c_str(), stdout);
  if (!o.out.empty() && !o.quiet)
    std::fprintf(stderr, "momenta: wrote %s\n", (o.out / "evaluate.json").c_str());
  return done;
}

}  // namespace momenta::program
