"""What the documents call the numbers of a run, how they write them, and how near two machines come.

A run is deterministic on one machine. Between machines sums round differently, and what a method makes
of that differs by its kind:

    fixed      one step like the other: the same motion to all digits that are shown
    adaptive   a step that is judged a rounding differently moves all later ones: errors by a part of
               themselves, counts by a few in a hundred
    implicit   Newton's iterations and the choice of order are decided by rounding now and then: drifts
               by a factor of five, errors, which may cancel, by twenty, counts by a third

Found by tolerances changed by parts in 10⁷ and by kernels of another level; the factors below have
room for as much again. What is no more than rounding is compared as that. Motions that magnify it, past
singular poses say, have a "within FACTOR" of their own. Processor times are not compared at all.
"""
import math
import re

FIXED = {"rk4", "gauss4", "gauss6", "rattle", "energy-momentum"}
IMPLICIT = {"ida", "radau5", "hem5", "bdf", "adams", "generalised-alpha", "bayo-ledesma"}
VALUES = {"fixed": 1.1, "adaptive": 2.0, "implicit": 10.0}  # factor that two machines may differ by
ERRORS = {"fixed": 1.1, "adaptive": 2.0, "implicit": 30.0}  # of what is held against a reference
COUNTS = {"fixed": 1.0, "adaptive": 1.15, "implicit": 1.5}
BRANCH_LOST = "branch lost"  # and what goes on from there is chance
SENSITIVE_COUNT = 3.0  # of counts where a mark says "within" more
ROUNDING = 1e-12  # in metres, m/s, J or of an error: what is below is rounding
SUPERSCRIPTS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")


def kind_of(summary):
    if summary["integrator"] in FIXED:
        return "fixed"
    # `partitioned` chooses its coordinates among others that are as good.
    return "implicit" if summary["integrator"] in IMPLICIT or summary["form"] == "partitioned" else "adaptive"


class Growth:
    """t^exponent with its half range; no exponent at rounding level, and where there is no power."""

    def __init__(self, exponent, half_range, kind):
        self.exponent, self.half_range, self.kind = exponent, half_range or 0.0, kind

    def __str__(self):
        if self.half_range > 0.3:
            return "no power"
        if self.exponent is None:
            return "rounding"
        if abs(self.exponent) + self.half_range <= 0.15:
            return "level"
        return f"t^{self.exponent:.2f} ± {self.half_range:.2f}"

    def agrees(self, text):
        """Exponents are slopes of a curve with corners: what matters is whether the ranges meet."""
        slack = 0.05 if self.kind == "fixed" else 0.25
        if text == "no power":
            return self.half_range > 0.3 - slack
        rounding = self.exponent is None and self.half_range == 0
        if rounding or text == "rounding":
            return rounding and text == "rounding"
        if self.exponent is None:
            return False
        if text == "level":
            exponent, half_range = 0.0, 0.15
        else:
            found = re.fullmatch(r"(?:t\^)?(-?[\d.]+)(?: ± ([\d.]+))?", text)
            if not found:
                return False
            exponent, half_range = float(found[1]), float(found[2] or 0)
        return abs(self.exponent - exponent) <= self.half_range + half_range + slack


class Run:
    """One run of a summary.json. Each look at a number leaves in `used` the factor it may differ by.

    Counts are those of a run that nobody looks at: `timed` gives its summary.
    """

    def __init__(self, summary, half_ranges, used, timed):
        self.summary, self._half_ranges, self._used, self._timed = summary, half_ranges, used, timed
        self.kind = kind_of(summary)

    def _look(self, factors, summary, *keys):
        self._used.append(factors[self.kind])
        for key in keys:
            summary = summary[key]
        return summary

    def _value(self, *keys):
        return self._look(VALUES, self.summary, *keys)

    def _count(self, name):
        return self._look(COUNTS, self.summary if self.kind == "fixed" else self._timed(), "counters", name)

    position_drift = property(lambda self: self._value("drift", "position_max"))
    velocity_drift = property(lambda self: self._value("drift", "velocity_max"))
    energy_error = property(lambda self: self._value("energy", "error_max"))
    error = property(lambda self: self._look(ERRORS, self.summary, "error", "position_max"))
    rate_error = property(lambda self: self._look(ERRORS, self.summary, "error", "velocity_max"))
    force_error = property(lambda self: self._look(ERRORS, self.summary, "error", "force_max"))
    multiplier_error = property(lambda self: self._look(ERRORS, self.summary, "error", "multiplier_max"))
    momentum_error = property(lambda self: self._look(ERRORS, self.summary, "error", "momentum_max"))
    impulse_error = property(lambda self: self._look(ERRORS, self.summary, "error", "impulse_max"))
    effort_error = property(lambda self: self._look(ERRORS, self.summary, "error", "effort_max"))
    reaction_error = property(lambda self: self._look(ERRORS, self.summary, "error", "reaction_max"))
    work_error = property(lambda self: self._look(ERRORS, self.summary, "error", "work_max"))
    multiplier_difference = property(lambda self: self._look(ERRORS, self.summary, "multiplier_difference_max"))
    steps = property(lambda self: self._count("steps"))
    evaluations = property(lambda self: self._count("evaluations"))
    solutions = property(lambda self: self._count("factorizations"))
    crossings = property(lambda self: len(self.summary["singular_crossings"]))
    ambiguous = property(lambda self: any(c["ambiguous"] for c in self.summary["singular_crossings"]))
    done = property(lambda self: self.summary["status"] == "done")

    @property
    def growth(self):
        return Growth(self.summary["drift"]["position_exponent"], self._half_ranges[0], self.kind)

    @property
    def velocity_growth(self):
        return Growth(self.summary["drift"]["velocity_exponent"], self._half_ranges[1], self.kind)

    @property
    def accuracy(self):
        """The error of positions, or what there is in place of one."""
        return BRANCH_LOST if self.ambiguous and (self.error or 1.0) > 0.1 else self.error


COLUMNS = {  # header of a column, without units: the quantity of a run
    "position drift": "position_drift", "velocity drift": "velocity_drift", "growth": "growth",
    "grows like": "growth", "energy error": "energy_error", "of energy": "energy_error",
    "error of positions": "accuracy", "of rates": "rate_error", "of λ": "force_error",
    "of the form's own λ": "multiplier_error", "of p": "momentum_error", "of ∫λ dt": "impulse_error",
    "of efforts": "effort_error", "of reactions": "reaction_error", "of work": "work_error", "steps": "steps", "evaluations": "evaluations",
    "solutions": "solutions",
}
COUNTED = {"steps", "evaluations", "solutions"}


def parse(text):
    """The number that a text is, or None: 8.2e-5, 5·10⁻⁸, 28 000, 10⁶."""
    text = text.strip().strip("`*").replace("−", "-").replace("\u2009", " ").translate(SUPERSCRIPTS)
    power = re.fullmatch(r"(?:(-?\d+(?:\.\d+)?)·)?10(-\d+|[2-9]|1\d)", text)
    if power and not re.fullmatch(r"10\d*", text):
        return float(power[1] or 1) * 10.0 ** int(power[2])
    text = re.sub(r"(?<=\d) (?=\d{3}(\D|$))", "", text)
    try:
        return float(text)
    except ValueError:
        return None


def digits(text):
    """How many digits of a number are meant: of 28 000 two, of 0.030 two, of 1.0e-3 two."""
    mantissa = re.split(r"[e·]", text.strip().strip("`"))[0]
    figures = re.sub(r"\D", "", mantissa).lstrip("0")
    return max(1, len(figures if "." in mantissa else figures.rstrip("0")))


def written(value, like=""):
    """A number as tables write it, with as many digits as stand there already."""
    if value is None or isinstance(value, (Growth, str)):
        return "–" if value is None else str(value)
    known = parse(like) is not None
    if isinstance(value, int) and not (known and len(re.sub(r"\D", "", like)) > digits(like)):
        text = str(value)
    else:
        n = digits(like) if known else 2
        mantissa, exponent = f"{value:.{n - 1}e}".split("e")
        exponent = int(exponent)
        if "·10" in like:
            return mantissa + "·10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        if "e" in like or not -3 < exponent < 5:
            return f"{mantissa}e{exponent}"
        text = f"{value:.{n - 1 - exponent}f}" if n - 1 >= exponent else str(int(float(f"{mantissa}e{exponent}")))
    return f"{int(text):,}".replace(",", " ") if " " in like.strip() and "." not in text else text


def digit(text):
    """One unit of the last digit of a number as it is written, relative to it."""
    mantissa = re.split(r"[e·]", text.strip().strip("`"))[0].strip("-−").replace(" ", "")
    decimals = mantissa[::-1].find(".") if "." in mantissa else -(len(mantissa) - len(mantissa.rstrip("0")))
    number = abs(float(mantissa)) if re.fullmatch(r"[\d.]+", mantissa) else 0.0
    return 10.0**-decimals / number if number else 1.0


def agree(text, value, factor):
    """Whether what stands there is `value`, up to `factor` and the digits that are written."""
    if isinstance(value, Growth):
        return value.agrees(text.strip())
    if value is None or isinstance(value, str):
        return text.strip().strip("`") == (value or "–")
    number = parse(text)
    if number is None:
        return text.strip() == "rounding" and abs(value) <= ROUNDING
    if isinstance(value, int) and factor == 1.0 and digit(text) * abs(number) <= 1:
        return number == value
    if number == value or (abs(number) <= ROUNDING and abs(value) <= ROUNDING):
        return True
    if number * value <= 0:
        return False
    return abs(math.log(number / value)) <= math.log(factor) + 0.55 * digit(text) + 1e-9
