#!/usr/bin/env python3
"""Draws the figures of the course, docs/index-reduction/lesson*.svg, from the program's own output.

    docs/index-reduction/figures.py build/release/dae/momenta [2 3 …]

runs what the lessons run, in a folder of its own; numbers choose lessons, all otherwise. A minute or two.
"""
import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
BLUE, SKY, RED, ORANGE, GREEN = "#0072b2", "#56b4e9", "#d55e00", "#e69f00", "#009e73"  # Okabe and Ito
W, H, RIGHT = 860, 420, 250  # of the chart with its labels; room for the labels
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def run(program, scene, form, folder, *options):
    """One run: (summary, trajectory as a list of rows)."""
    command = [program, "run", TOP / "examples" / scene, "--form", form, "--out", folder, "--quiet", *options]
    subprocess.run([str(part) for part in command], check=False, stderr=subprocess.DEVNULL)
    with open(Path(folder) / "summary.json", encoding="utf-8") as f:
        summary = json.load(f)
    with open(Path(folder) / "trajectory.csv", encoding="utf-8") as f:
        return summary, list(csv.DictReader(f))


def running_max(rows, column, after, start=None):
    """(t, largest |value| up to t); with `start` |value − start|."""
    top, points = 0.0, []
    for row in rows:
        t = float(row["t [s]"])
        top = max(top, abs(float(row[column]) - (start or 0.0)))
        if t >= after and top > 0:
            points.append((t, top))
    return points


class Chart:
    """Curves on logarithmic axes (x linear if asked), each with a label at its right end."""

    def __init__(self, title, x_label, x, y, linear_x=False, size=(W, H, RIGHT)):
        self.x, self.y, self.linear_x = x, y, linear_x
        width, height, labels = size
        self.left, self.right, self.top, self.bottom = 64, width - labels, 40, height - 54
        self.out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" role="img" '
                    'font-family="system-ui, sans-serif" font-size="14">', f"<title>{title}</title>",
                    "<style>.bg{fill:#fff}.ink{fill:#222}.grid{stroke:#ddd}.slope{stroke:#999}"
                    "@media (prefers-color-scheme:dark){.bg{fill:#16181c}.ink{fill:#e6e6e6}"
                    ".grid{stroke:#3a3d44}.slope{stroke:#777}}</style>",
                    f'<rect class="bg" width="{width}" height="{height}"/>',
                    f'<text class="ink" x="{self.left}" y="24" font-weight="600">{title}</text>']
        self.ends = []
        for e in range(y[0], y[1] + 1, 2):
            v = self.at_y(10.0**e)
            self.line("grid", self.left, v, self.right, v)
            self.text(self.left - 8, v + 5, self.power(e), "end")
        every = 2 if linear_x and x[1] - x[0] > 10 else 1
        ticks = range(math.ceil(x[0]), math.floor(x[1]) + 1, every) if linear_x else range(x[0], x[1] + 1)
        for e in ticks:
            u = self.at_x(e if linear_x else 10.0**e)
            self.line("grid", u, self.top, u, self.bottom)
            if not linear_x or e % 2 == 0:
                self.text(u, self.bottom + 20, str(e) if linear_x else self.power(e), "middle")
        self.text((self.left + self.right) / 2, self.bottom + 42, x_label, "middle")

    @staticmethod
    def power(e):
        return {0: "1", 1: "10", 2: "100", 3: "1000"}.get(e, "10" + str(e).translate(SUPERSCRIPT))

    def at_x(self, x):
        part = (x if self.linear_x else math.log10(x)) - self.x[0]
        return self.left + (self.right - self.left) * part / (self.x[1] - self.x[0])

    def at_y(self, y):
        part = (math.log10(y) - self.y[0]) / (self.y[1] - self.y[0])
        return self.bottom - (self.bottom - self.top) * min(max(part, 0), 1.02)

    def line(self, kind, x1, y1, x2, y2):
        self.out.append(f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>')

    def text(self, x, y, text, anchor="start"):
        self.out.append(f'<text class="ink" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{text}</text>')

    def slope(self, power, x, y):
        """A piece of the law t^power from (x, y), eight times as far in x."""
        self.line("slope", self.at_x(x), self.at_y(y), self.at_x(8 * x), self.at_y(y * 8**power))
        self.text(self.at_x(8.3 * x), self.at_y(y * 8**power) + 4, "t" + ("²" if power == 2 else ""))

    def curve(self, points, label, colour, dash="", dots=False, more=""):
        thin, last = [], -1e9
        for x, y in points:
            if y > 0 and (dots or self.at_x(x) > last + 1.5 or (x, y) == points[-1]):
                thin.append((self.at_x(x), self.at_y(y)))
                last = thin[-1][0]
        path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in thin)
        self.out.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="2"'
                        + (f' stroke-dasharray="{dash}"' if dash else "") + more + "/>")
        if dots:
            self.out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>' for x, y in thin]
        self.ends.append((thin[-1][1], thin[-1][0], label, colour))

    def text_of(self):
        self.ends.sort()
        places = [y for y, _, _, _ in self.ends]
        for _ in range(300):  # labels push one another apart
            for i in range(len(places) - 1):
                gap = 18 - (places[i + 1] - places[i])
                if gap > 0:
                    places[i] -= gap / 2
                    places[i + 1] += gap / 2
        for place, (y, x, label, colour) in zip(places, self.ends):
            self.out.append(f'<path d="M{x:.1f} {y:.1f}L{self.right + 12} {place:.1f}" stroke="{colour}" '
                            'stroke-width="0.7" fill="none"/>')
            self.text(self.right + 16, place + 5, label)
        return "\n".join([*self.out, "</svg>", ""])

    def write(self, file):
        (TOP / "docs/index-reduction" / file).write_text(self.text_of(), encoding="utf-8")


def lesson2(program, folder):
    chart = Chart("Pendulum: the rod is too long or too short by, up to time t [m]", "t [s]", (0, 2), (-12, -2))
    for form, method, colour, dash in (("acceleration-index1", "ida", RED, "6 4"), ("acceleration", "rk4", RED, ""),
                                       ("acceleration-index2", "ida", ORANGE, "6 4"),
                                       ("acceleration-index3", "ida", SKY, "6 4"),
                                       ("stabilised-index2", "ida", GREEN, "6 4")):
        _, rows = run(program, "pendulum/cartesian.toml", form, folder, "--integrator", method, "--end", "100")
        chart.curve(running_max(rows, "position_drift [m]", 1), form, colour, dash)
    chart.slope(1, 1.5, 2e-12)
    chart.slope(2, 1.5, 2e-12)
    chart.write("lesson2.svg")


def lesson3(program, folder):
    chart = Chart("Four-bar, Baumgarte, RK4 with h = 5 ms, 10 s", "α = β [1/s]", (-1, 3), (-8, 2))
    gains, drift, error = (0.1, 0.3, 1, 3, 10, 30, 100, 300, 400, 500), [], []
    for gain in gains:
        summary, _ = run(program, "four_bar/scene.toml", "baumgarte", folder, "--integrator", "rk4", "--end", "10",
                         "--baumgarte-alpha", str(gain), "--baumgarte-beta", str(gain),
                         "--reference", TOP / "examples/four_bar/reference.csv")
        if summary["status"] == "done":
            drift.append((gain, summary["drift"]["position_max"]))
            error.append((gain, summary["error"]["position_max"]))
    chart.curve(drift, "position drift [m]", BLUE, dots=True)
    chart.curve(error, "error of positions", RED, dots=True)
    chart.write("lesson3.svg")


def lesson4(program, folder):
    chart = Chart("Four-bar: position drift up to time t [m]", "t [s]", (0, 2), (-12, -2))
    for form, gauge, label, colour, dash in (
            ("acceleration", "none", "acceleration", RED, ""),
            ("momentum", "none", "momentum, no gauge", BLUE, "12 4"),
            ("momentum", "leak:3", "momentum, leak 3/s", BLUE, ""),
            ("momentum", "reset", "momentum, reset", BLUE, "2 3"),
            ("momentum-index2", "leak:3", "momentum-index2, leak 3/s", SKY, "6 4")):
        method = "ida" if "index" in form else "rk4"
        _, rows = run(program, "four_bar/scene.toml", form, folder, "--integrator", method, "--gauge", gauge,
                      "--end", "100")
        chart.curve(running_max(rows, "position_drift [m]", 1), label, colour, dash)
    chart.slope(1, 1.5, 2e-12)
    chart.slope(2, 1.5, 2e-12)
    chart.write("lesson4.svg")


def lesson5(program, folder):
    chart = Chart("Slider-crank through its crossing: largest energy error up to time t [J]", "t [s]", (0, 10), (-10, 2),
                  linear_x=True)
    for form, project, label, colour, dash in (
            ("momentum", False, "momentum, reset", BLUE, "6 4"),
            ("acceleration", False, "acceleration", RED, "6 4"),
            ("momentum", True, "momentum, reset, projected", BLUE, ""),
            ("acceleration", True, "acceleration, projected", RED, "")):
        _, rows = run(program, "slider_crank/scene.toml", form, folder, "--integrator", "dop853", "--gauge", "reset",
                      "--project" if project else "--no-project", "--end", "10")
        points = running_max(rows, "energy [J]", 0.01, float(rows[0]["energy [J]"]))
        chart.curve(points, label, colour, dash)
    chart.write("lesson5.svg")


def lesson6(program, folder):
    for scene, name, file, x in (("four_bar", "Four-bar, 10 s", "lesson6_four_bar.svg", (2, 4)),
                                 ("n_four_bar", "Forty four-bars, 10 s", "lesson6_n_four_bar.svg", (2, 4))):
        command = [program, "work", TOP / "examples" / scene / "scene.toml", "--forms", "momentum,projected",
                   "--gauge", "reset", "--end", "10", "--reference", TOP / "examples" / scene / "reference.csv",
                   "--quiet", "--out", folder]
        subprocess.run([str(part) for part in command], check=True)
        with open(Path(folder) / "summary.json", encoding="utf-8") as f:
            runs = [r for r in json.load(f) if r["status"] == "done" and r["error"]["position_max"]]
        chart = Chart(f"{name}, dop853 at 1e-4 … 1e-12: error of positions", "solutions of (7) or (3)", x, (-12, 0))
        for form, label, colour in (("momentum", "momentum, reset, projected", BLUE),
                                    ("projected", "projected (accelerations)", RED)):
            points = [(r["counters"]["factorizations"], r["error"]["position_max"]) for r in runs if r["form"] == form]
            chart.curve(points, label, colour, dots=True)
        chart.write(file)


def main():
    program = Path(sys.argv[1]).resolve()
    lessons = {"2": lesson2, "3": lesson3, "4": lesson4, "5": lesson5, "6": lesson6}
    for number in sys.argv[2:] or lessons:
        with tempfile.TemporaryDirectory() as folder:
            lessons[number](program, folder)


if __name__ == "__main__":
    main()
