#include <momenta/core/scalar/all_finite.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <optional>

namespace momenta {
namespace {

/// Names of a drive's formula: t and its functions.
class OfTime final : public FormulaNames {
 public:
  explicit OfTime(const DriveSpec& drive) : drive_(drive) {}
  std::optional<Meaning> meaning(std::string_view name, std::size_t) override {
    return name == "t" ? std::optional(Meaning{0, 0}) : std::nullopt;
  }
  std::shared_ptr<const CubicSpline> function(std::string_view name) override {
    for (const FunctionSpec& f : drive_.functions)
      if (f.name == name && spline_fault(f.x, f.y, "x", "y").empty()) return curve_of(f);
    return nullptr;
  }
  std::vector<std::string_view> functions() const override {
    std::vector<std::string_view> all;
    for (const FunctionSpec& f : drive_.functions) all.push_back(f.name);
    return all;
  }
  std::string expected(std::string_view) const override { return ", expected t or pi"; }

 private:
  const DriveSpec& drive_;
};

Expression law_of(const DriveSpec& drive) {
  OfTime names(drive);
  return Expression(drive.law, names);
}

}  // namespace

std::string law_fault(const DriveSpec& spec) {
  if (spec.kind == "polynomial") {
    if (spec.coefficients.empty())
      return "coefficients is empty, expected c0, c1, ... of f = c0 + c1 t + ...";
    if (!all_finite(spec.coefficients)) return "coefficients must be finite";
    return "";
  }
  if (spec.kind == "harmonic")
    return all_finite({spec.offset, spec.amplitude, spec.frequency, spec.phase})
               ? ""
               : "offset, amplitude, frequency and phase must be finite";
  if (spec.kind == "step") {
    if (!all_finite({spec.from, spec.to, spec.start, spec.duration}))
      return "from, to, start and duration must be finite";
    return spec.duration > 0 ? "" : "duration must be > 0 [s]";
  }
  if (spec.kind == "table") return spline_fault(spec.times, spec.values, "times", "values");
  if (spec.kind == "formula") try {
      if (!law_of(spec).is_truth()) return "";
      return "law, " + reading::in_quotes(spec.law) +
             ", is a comparison, expected a formula of a number";
    } catch (const ExpressionError& e) {
      return "law, " + reading::in_quotes(spec.law) + ": " + e.what();
    }
  return "kind must be polynomial, harmonic, step, table or formula";
}

std::string law_corner(const DriveSpec& spec) {
  return spec.kind == "formula" ? std::string(law_of(spec).corner()) : std::string();
}

bool has_running_drive(const Scene& scene) {
  return std::any_of(scene.drives.begin(), scene.drives.end(), [](const DriveSpec& drive) {
    return drive.kind != "polynomial" ||
           std::any_of(drive.coefficients.begin() + !drive.coefficients.empty(),
                       drive.coefficients.end(), [](double c) { return c != 0; });
  });
}

MotionLaw::MotionLaw(const DriveSpec& spec)
    : coefficients_(spec.coefficients),
      offset_(spec.offset),
      amplitude_(spec.amplitude),
      frequency_(spec.frequency),
      phase_(spec.phase),
      from_(spec.from),
      to_(spec.to),
      start_(spec.start),
      duration_(spec.duration) {
  if (const std::string fault = law_fault(spec); !fault.empty())
    throw SceneError(
        (spec.joint.empty() ? "drive of loop '" + spec.loop : "drive of joint '" + spec.joint) +
        "': " + fault);
  if (spec.kind == "harmonic") kind_ = Kind::harmonic;
  if (spec.kind == "step") kind_ = Kind::step;
  if (spec.kind == "table") {
    kind_ = Kind::table;
    spline_ = CubicSpline(spec.times, spec.values);
  }
  if (spec.kind == "formula") {
    kind_ = Kind::formula;
    formula_ = law_of(spec).with_two_derivatives(0);
  }
}

}  // namespace momenta
