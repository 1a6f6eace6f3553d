#include <momenta/dae/integrator/butcher_tableau.h>
#include <momenta/dae/integrator/tableau_dop853.h>
#include <momenta/dae/integrator/tableau_dp5.h>
#include <momenta/dae/integrator/tableau_rk4.h>
#include <momenta/dae/integrator/tableau_vern9.h>

#include <stdexcept>

namespace momenta {
namespace {

template <class Tableau>
ButcherTableau numbers_of() {
  constexpr auto s = static_cast<std::size_t>(Tableau::stages);
  ButcherTableau tableau;
  for (std::size_t i = 0; i < s; ++i) {
    tableau.c.push_back(Tableau::c[i]);
    tableau.a.emplace_back(s, 0.0);
    for (std::size_t j = 0; j < i; ++j) tableau.a[i][j] = Tableau::a[i][j];
  }
  tableau.first_is_end = Tableau::end_derivative_always;
  for (std::size_t j = 0; j < s; ++j) tableau.b.push_back(Tableau::a[s][j]);
  return tableau;
}

}  // namespace

ButcherTableau butcher_tableau(const std::string& method) {
  using namespace explicit_rk;
  if (method == "rk4") return numbers_of<TableauRk4>();
  if (method == "dp5") return numbers_of<TableauDp5>();
  if (method == "dop853") return numbers_of<TableauDop853>();
  if (method == "vern9") return numbers_of<TableauVern9>();
  throw std::invalid_argument("no explicit method \"" + method +
                              "\": rk4, dp5, dop853, vern9 are known");
}

}  // namespace momenta
