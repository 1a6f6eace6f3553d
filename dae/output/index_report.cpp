#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/index_report.h>
#include <momenta/dae/output/json.h>

#include <algorithm>

namespace momenta {
namespace {

std::string unknowns_text(const FormIndex& f) {
  if (!f.dae) return "q, " + (f.words.x.empty() ? "x" : f.words.x);
  std::string text;
  for (const auto& b : f.blocks) text += (text.empty() ? "" : ", ") + b.symbol;
  return text;
}

std::string constraint_lines(const FormIndex& f) {
  std::string text;
  for (const Constraint& c : f.words.constraints) {
    std::string line = "  " + padded(name_of(c.origin), 11) + c.equation;
    if (!c.gives.empty()) line += "; gives " + c.gives;
    if (c.differentiations > 0)
      line += "; after " + std::to_string(c.differentiations) + " differentiation" +
              (c.differentiations == 1 ? "" : "s");
    text += line + "\n";
  }
  return text;
}

std::string details(const FormIndex& f, int m) {
  std::string text = "\n" + f.form + ": " + unknowns_text(f) + "\n";
  if (!f.dae) {
    if (m == 0)
      return text + "  " + padded("solves", 11) + "nothing but the tree's own recursion\n";
    if (!f.words.solved.empty()) text += "  " + padded("solves", 11) + f.words.solved + "\n";
    return text + constraint_lines(f);
  }
  if (m > 0) text += constraint_lines(f);
  std::string after;
  for (const auto& b : f.blocks)
    after += (after.empty() ? "" : ", ") + b.symbol + "' " +
             (b.determined_after < 0 ? "never" : std::to_string(b.determined_after));
  if (!after.empty()) text += "  " + padded("determined", 11) + "after ν = " + after + "\n";
  if (f.found.index < 0) text += "  " + padded("no index", 11) + f.found.why + "\n";
  if (!f.ida.empty()) text += "  " + padded("IDA", 11) + f.ida + "\n";
  return text;
}

const FormIndex* find(const IndexStudy& study, const std::string& form) {
  for (const auto& f : study.forms)
    if (f.form == form) return &f;
  return nullptr;
}

/// Says only what this study's numbers show.
std::string lambda_or_sigma(const IndexStudy& study) {
  const FormIndex* with_force = find(study, "momentum-index3");
  const FormIndex* with_impulse = find(study, "momentum-index2");
  if (!with_force || !with_impulse || with_force->found.index < 0 || with_impulse->found.index < 0)
    return "";
  return "\n(5a)-(5c) as printed, with λ: index " + with_force->text() +
         ". (7), (8) with Φ = 0, with σ: index " + with_impulse->text() +
         ".\nΦ = 0 differentiated once has q̇ in it. σ stands in the equation of q̇, so it is there; "
         "λ "
         "stands in that of ṗ,\nand p in that of q̇: one more differentiation. Written with σ, "
         "λ = σ̇, the same motion has one index less.\n";
}

}  // namespace

std::string over_levels(const IndexFound& found, int ArrayLevel::*number) {
  std::string all;
  for (const ArrayLevel& level : found.levels)
    all += (all.empty() ? "" : " ") + std::to_string(level.*number);
  return all;
}

double smallest_gap(const IndexFound& found) {
  double gap = found.levels.empty() ? 0 : found.levels.front().gap;
  for (const ArrayLevel& level : found.levels) gap = std::min(gap, level.gap);
  return gap;
}

std::string index_table(const IndexStudy& study) {
  std::string text = study.scene + ": " + std::to_string(study.nq) + " coordinates, " +
                     std::to_string(study.nv) + " rates, " + std::to_string(study.m) +
                     (study.m == 1 ? " loop equation" : " loop equations");
  if (study.m > 0) text += " of rank " + std::to_string(study.loops.rank);
  text += "; at t = " + compact(study.t, 4) + " s\n";
  if (study.loops.rank < study.m)
    text +=
        "Φ_q has less than full rank here. If so everywhere, loops are redundant and multipliers "
        "never determined; if at this\npose alone, it is singular, and what is found is true of it "
        "alone.\n";
  text += "\n";
  std::vector<std::vector<std::string>> table{
      {"form", "index", "y' free", "constraints", "unknowns", "gap"}};
  for (const auto& f : study.forms) {
    if (!f.dae) {
      const bool regular = f.inner.rank == f.inner_size;
      table.push_back({f.form, f.text(),
                       std::string(study.m > 0 && !f.words.penalised ? "(M Φ_qᵀ; Φ_q 0) " : "M ") +
                           (regular ? "regular, rank " : "rank ") + std::to_string(f.inner.rank) +
                           " of " + std::to_string(f.inner_size),
                       "", std::to_string(f.unknowns), scientific(f.inner.gap(), 1)});
      continue;
    }
    table.push_back({f.form, f.text(), over_levels(f.found, &ArrayLevel::undetermined),
                     over_levels(f.found, &ArrayLevel::constraints), std::to_string(f.unknowns),
                     scientific(smallest_gap(f.found), 1)});
  }
  text += in_columns(table);
  text +=
      "\ny' free: directions of y' that F = 0 and its first ν = 0, 1, … time derivatives leave "
      "open; "
      "the index is the first ν with none.\nconstraints: what they say of the unknowns alone. gap: "
      "smallest singular value that counts over largest that does not, the least of all ranks.\n";
  if (study.nonholonomic > 0)
    text += "nonholonomic: " + std::to_string(study.nonholonomic) + " of the " +
            std::to_string(study.m) +
            " equations. For them Φ_q is A, Φ̇ is A u − b and Φ̇_qᵀσ is Ȧᵀσ; they have no Φ: where "
            "Φ = 0 is given, A u − b = 0 stands for it.\n";
  for (const auto& f : study.forms) text += details(f, study.m);
  return text + lambda_or_sigma(study);
}

nlohmann::ordered_json levels_json(const IndexFound& found) {
  auto levels = nlohmann::ordered_json::array();
  for (const ArrayLevel& level : found.levels)
    levels.push_back({{"differentiations", level.differentiations},
                      {"equations", level.equations},
                      {"rank", level.rank},
                      {"constraints", level.constraints},
                      {"free", level.undetermined},
                      {"gap", number_or_null(level.gap)},
                      {"residual", number_or_null(level.residual)}});
  return levels;
}

nlohmann::ordered_json index_json(const IndexStudy& study) {
  const auto rank_json = [](const RankFound& r, int of) {
    return Json{{"rank", r.rank},
                {"of", of},
                {"kept", number_or_null(r.kept)},
                {"dropped", number_or_null(r.dropped)}};
  };
  Json j;
  j["scene"] = study.scene;
  j["t"] = study.t;
  j["coordinates"] = study.nq;
  j["rates"] = study.nv;
  j["loop_equations"] = study.m;
  j["nonholonomic_equations"] = study.nonholonomic;
  if (study.m > 0) j["loops"] = rank_json(study.loops, study.m);
  j["forms"] = Json::array();
  for (const auto& f : study.forms) {
    Json form;
    const bool loops = study.m > 0;
    form["form"] = f.form;
    form["kind"] = f.dae ? "DAE" : "ODE";
    form["unknowns"] = f.unknowns;
    if (!f.dae) {
      form["index"] = nullptr;
      form["solved"] = loops ? f.words.solved : "";
      form["matrix"] = rank_json(f.inner, f.inner_size);
    } else {
      form["index"] = f.found.index < 0 ? Json(nullptr) : Json(f.found.index);
      form["decided"] = f.found.decided;
      form["why"] = f.found.why;
      form["levels"] = levels_json(f.found);
      form["blocks"] = Json::array();
      for (const UnknownBlock& b : f.blocks)
        form["blocks"].push_back(
            {{"symbol", b.symbol},
             {"size", b.size},
             {"algebraic", b.algebraic},
             {"determined_after",
              b.determined_after < 0 ? Json(nullptr) : Json(b.determined_after)},
             {"error_tested", b.tested},
             {"newton_norm", b.in_newton_norm}});
      form["semi_explicit"] = f.semi_explicit;
      form["ida_holds"] = f.ida_holds;
      form["ida"] = f.ida;
    }
    form["constraints"] = Json::array();
    if (loops)
      for (const Constraint& c : f.words.constraints)
        form["constraints"].push_back({{"origin", name_of(c.origin)},
                                       {"equation", c.equation},
                                       {"differentiations", c.differentiations},
                                       {"rows", c.per_rate * study.nv + c.per_loop_row * study.m},
                                       {"gives", c.gives}});
    j["forms"].push_back(std::move(form));
  }
  return j;
}

}  // namespace momenta
