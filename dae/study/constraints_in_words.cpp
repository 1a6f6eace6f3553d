#include <momenta/dae/study/constraints_in_words.h>

#include <map>

namespace momenta {
namespace {

using Origin = Constraint::Origin;
using Constraints = std::vector<Constraint>;

const std::string positions = "Φ(q, t) = 0";
const std::string velocities = "Φ̇ = Φ_q v + Φ_t = 0";
const std::string rates = "Φ̇ = Φ_q u + Φ_t = 0";
const std::string accelerations = "Φ̈ = Φ_q v̇ + Φ̇_q v + Φ̇_t = 0 with v̇ from (1a)";
const std::string of_momenta = "Φ̇ = Φ_q M⁻¹(p − Φ_qᵀσ) + Φ_t = 0";

Constraint given(const std::string& equation, const std::string& gives = "") {
  return {Origin::given, 0, 0, 1, equation, gives};
}
Constraint hidden(int differentiations, const std::string& equation, const std::string& gives) {
  return {Origin::hidden, differentiations, 0, 1, equation, gives};
}
Constraint invariant(const std::string& equation) {
  return {Origin::invariant, 0, 0, 1, equation, ""};
}

FormInWords dae(const std::string& x, const std::string& s, const Constraints& constraints) {
  FormInWords words;
  words.x = x;
  words.s = s;
  words.constraints = constraints;
  return words;
}
FormInWords ode(const std::string& x, const std::string& solved, const Constraints& constraints) {
  FormInWords words;
  words.x = x;
  words.solved = solved;
  words.constraints = constraints;
  return words;
}
FormInWords penalised(const std::string& x, const Constraints& constraints) {
  FormInWords words = ode(x, "M + Φ_qᵀαΦ_q, regular whatever the rank of Φ_q", constraints);
  words.penalised = true;
  return words;
}

const std::map<std::string, FormInWords>& all() {
  const Constraint of_stabilised =
      hidden(1, "Φ̇ = Φ_q(v − Φ_qᵀμ) + Φ_t = 0, that is Φ_qΦ_qᵀμ = 0", "μ");
  const Constraints both{invariant(rates), invariant(positions)};
  static const std::map<std::string, FormInWords> words{
      {"momentum", ode("p", "(7) for u and σ", {invariant(positions)})},
      {"momentum-index1", dae("p", "σ", {given(of_momenta, "σ"), invariant(positions)})},
      {"momentum-index2", dae("p", "σ", {given(positions), hidden(1, of_momenta, "σ")})},
      {"momentum-stabilised", dae("p", "σ",
                                  {{Origin::given, 0, 1, 0, "M v + Φ_qᵀσ = p", "v"},
                                   given(velocities, "σ"),
                                   given(positions),
                                   of_stabilised})},
      {"momentum-index3",
       dae("p", "λ",
           {given(positions), hidden(1, "Φ̇ = Φ_q M⁻¹p + Φ_t = 0", ""),
            hidden(2, "Φ̈ = Φ_q M⁻¹ṗ + d/dt(Φ_q M⁻¹) p + Φ̇_t = 0 with ṗ from (5b)", "λ")})},
      {"augmented-lagrangian-canonical", penalised("p", {invariant(positions)})},
      {"acceleration", ode("u", "(3) for u̇ and λ", both)},
      {"baumgarte", ode("u", "(3) for u̇ and λ, with feedback of Φ and Φ̇", both)},
      {"maximal-coordinates",
       ode("u",
           "accelerations of all bodies, reactions of all joints and λ, with feedback of Φ and Φ̇",
           both)},
      {"projected", ode("u", "(3) for u̇ and λ; Φ and Φ̇ put to zero after each step", both)},
      {"partitioned", ode("u", "(3) for u̇, with independent q and u for unknowns",
                          {given(positions, "dependent q"), given(rates, "dependent u")})},
      {"augmented-lagrangian", penalised("u", both)},
      {"acceleration-index1",
       dae("v", "λ", {given(accelerations, "λ"), invariant(velocities), invariant(positions)})},
      {"acceleration-index2",
       dae("v", "λ", {given(velocities), hidden(1, accelerations, "λ"), invariant(positions)})},
      {"acceleration-index3",
       dae("v", "λ", {given(positions), hidden(1, velocities, ""), hidden(2, accelerations, "λ")})},
      {"stabilised-index2",
       dae("v", "λ",
           {given(velocities), given(positions), of_stabilised, hidden(1, accelerations, "λ")})},
  };
  return words;
}

}  // namespace

FormInWords in_words(const std::string& form) {
  const auto found = all().find(form);
  return found == all().end() ? FormInWords{} : found->second;
}

const char* name_of(Constraint::Origin origin) {
  switch (origin) {
    case Origin::given:
      return "given";
    case Origin::hidden:
      return "hidden";
    case Origin::invariant:
      return "invariant";
  }
  return "";
}

}  // namespace momenta
