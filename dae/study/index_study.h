#pragma once
// The index of each form of one mechanism at one consistent state, and whether the convergence
// theory of IDA's method covers it.

#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/measure/derivative_array.h>

#include <functional>

namespace momenta {

struct Start;

/// One block of a form's unknowns, as q or σ.
struct UnknownBlock {
  std::string symbol;
  int size = 0;
  bool algebraic = false;       ///< its derivative is not in the equations
  bool tested = false;          ///< takes part in IDA's error test here
  bool in_newton_norm = false;  ///< takes part in the norm that ends Newton's method
  int determined_after = -1;    ///< differentiations that determine its derivative; −1: none did
};

struct FormIndex {
  std::string form;
  bool dae = false;
  int unknowns = 0;
  FormInWords words;

  // ODE forms: rank of the system solved at each evaluation, (7) or (3), with the matrix (M Φ_qᵀ;
  // Φ_q 0); of M without loops and for penalty forms.
  RankFound inner;
  int inner_size = 0;

  // DAE forms
  IndexFound found;
  std::vector<UnknownBlock> blocks;
  bool semi_explicit = false;  ///< y' stands in F through independent columns alone
  bool ida_holds = false;      ///< the proof for BDF with variable steps holds
  std::string ida;             ///< the verdict in a sentence, and what is done here

  /// "ODE", "2", "not defined", "not decided"
  std::string text() const;
};

struct IndexStudy {
  std::string scene;
  double t = 0;
  int nq = 0, nv = 0, m = 0;
  int nonholonomic = 0;  ///< such rows among the m
  RankFound loops;       ///< rank of Φ_q; zero without loops
  std::vector<FormIndex> forms;
};

/// Most unknowns of a form whose array is built.
inline constexpr int index_limit = 450;

/// `forms` empty: all, without loops the two ODE forms. `progress` before each form; false stops.
/// @throws std::invalid_argument for an unknown form, SceneError for too large a scene.
IndexStudy run_index_study(const Mechanism& mechanism, const Start& start,
                           std::vector<std::string> forms,
                           const std::function<bool(const std::string& form)>& progress = {});

}  // namespace momenta
