#!/usr/bin/env python3
"""Draws docs/figures/strandbeest.svg: two legs of Jansen's Strandbeest on two forms, moving, and their drift as it grows.

    docs/figures/strandbeest.py build/release/dae/momenta

A few seconds. The scene is that of `momenta make jansen-legs --n 2`; each form runs with RK4 and h = 12.5 ms, long enough
for the loops of `acceleration` to open by centimetres. Bodies stand where trajectory.csv has them: nothing is exaggerated.
Animated by SMIL alone, so that it moves within <img> too; what does not play it shows the end of the run.
"""
import math
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path.append(str(TOP / "docs/index-reduction"))
from figures import BLUE, GREEN, RED, Chart, run, running_max  # noqa: E402

END, RATE, PAUSE = 12, 20, 1.5  # [s] of the run, pictures a second, [s] with the last of them
STEP = "0.0125"  # [s]
WIDTH, HEIGHT, PANEL = 900, 360, 244  # [px]; a panel for each mechanism, the chart in what is left
SCALE = 186  # [px/m]
FINE = 3  # points are written in thirds of a pixel


class Legs:
    """Where the points of a planar tree of revolute joints are, from the joint angles."""

    def __init__(self, scene):
        self.joints, self.loops = scene["joint"], scene["loop"]
        self.points = {body["name"]: [(0.0, 0.0)] for body in scene["body"]}  # of each, in its own frame [m]
        for tie in self.joints + self.loops:
            for side in ("parent", "child"):
                if tie[side] in self.points:
                    point = self.at(tie, side)
                    if point not in self.points[tie[side]]:
                        self.points[tie[side]].append(point)
        for marker in scene["marker"]:
            self.points[marker["body"]].append(tuple(marker["point"][:2]))

    @staticmethod
    def at(tie, side):
        return tuple(tie.get("origin", {}).get(side, (0.0, 0.0))[:2])

    def frames(self, row):
        """Origin and angle of each body in ground axes, [m] and [rad]."""
        placed = {"ground": (0.0, 0.0, 0.0)}
        for joint in self.joints:  # a parent stands before its children
            x, y = self.seen(placed[joint["parent"]], self.at(joint, "parent"))
            placed[joint["child"]] = (x, y, placed[joint["parent"]][2] + float(row[joint["name"] + ".q [rad]"]))
        return placed

    @staticmethod
    def seen(frame, point):
        x, y, angle = frame
        return (x + math.cos(angle) * point[0] - math.sin(angle) * point[1],
                y + math.sin(angle) * point[0] + math.cos(angle) * point[1])


def animated(attribute, values):
    """The values at RATE a second, the last of them for PAUSE seconds more; again and again."""
    whole = (len(values) - 1) / RATE + PAUSE
    times = ";".join(f"{i / RATE / whole:.4f}".lstrip("0") or "0" for i in range(len(values))) + ";1"
    return (f'<animate attributeName="{attribute}" dur="{whole}s" repeatCount="indefinite" keyTimes="{times}" '
            f'values="{";".join([*values, values[-1]])}"/>')


class Panel:
    """One mechanism: paths whose points move."""

    def __init__(self, left, legs, rows, title, colour):
        self.left, self.legs, self.colour = left, legs, colour
        self.frames = [legs.frames(row) for row in rows]
        self.out = [f'<text class="ink" x="{left + 12}" y="24" font-weight="600" fill="{colour}">{title}</text>',
                    f'<g transform="scale({1 / FINE})" fill="none" stroke-linejoin="round" stroke-linecap="round">']

    def pixel(self, point):
        return (round(FINE * (self.left + 194 + SCALE * point[0])), round(FINE * (122 - SCALE * point[1])))

    def path(self, strokes, closed, style):
        """`strokes`: a list of lists of (body, point)."""
        values = []
        for frame in self.frames:
            text, at = "", (0, 0)
            for stroke in strokes:
                pixels = [self.pixel(self.legs.seen(frame[body], point)) for body, point in stroke]
                for i, (x, y) in enumerate(pixels):  # the way from the point before: shorter to write
                    text += f"{'l' if i else 'm'}{x - at[0]} {y - at[1]}"
                    at = (x, y)
                if closed:
                    at = pixels[0]
                text += "z" if closed else "h0" if len(pixels) == 1 else ""
            values.append(text.replace(" -", "-"))
        self.out.append(f'<path d="{values[-1]}" {style}>{animated("d", values)}</path>')

    def trace(self, marker):
        """The way of a foot during the first turn and a half."""
        pixels = [self.pixel(self.legs.seen(frame[marker["body"]], marker["point"][:2])) for frame in self.frames[:RATE * 3 // 2]]
        self.out.append('<path class="faint" stroke-width="3" stroke-dasharray="6 10" d="M'
                        + "L".join(f"{x} {y}" for x, y in pixels) + '"/>')

    def leg(self, number, strength):
        bodies = [b for b in self.legs.points if b.endswith(number)]
        outlines = [[(b, p) for p in self.legs.points[b]] for b in bodies]
        for corners, style in ((3, f'fill="{self.colour}" fill-opacity="{0.3 * strength}"'), (2, "")):
            self.path([o for o in outlines if len(o) == corners], corners == 3,
                      f'{style} stroke="{self.colour}" stroke-opacity="{strength}" stroke-width="11"')
        ends = [[(loop[side], self.legs.at(loop, side))] for loop in self.legs.loops if loop["name"].endswith(number)
                for side in ("parent", "child")]
        self.path(ends, False, f'class="pin" stroke-opacity="{strength}" stroke-width="21"')

    def crank(self):
        self.path([[("crank", p) for p in self.legs.points["crank"]]], False, 'class="line" stroke-width="14"')
        for joint in self.legs.joints:
            if joint["parent"] == "ground":
                x, y = self.pixel(self.legs.at(joint, "parent"))
                self.out.append(f'<path class="line bg" stroke-width="4" d="M{x} {y}l-21 33h42z"/>')

    def text(self):
        return "\n".join([*self.out, "</g>"])


def main():
    program = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "legs.toml"
        scene.write_bytes(subprocess.run([program, "make", "jansen-legs", "--n", "2"], check=True, capture_output=True).stdout)
        parsed = tomllib.loads(scene.read_text(encoding="utf-8"))
        rows = {}
        for form in ("acceleration", "momentum", "projected"):
            summary, rows[form] = run(program, scene, form, folder, "--integrator", "rk4", "--step", STEP, "--gauge", "reset",
                                      "--end", str(END), "--samples", str(END * RATE), "--timing", "none")
            if summary["status"] != "done":
                sys.exit(f"strandbeest.py: {form} is {summary['status']}; expected done")
    legs = Legs(parsed)
    panels = []
    for i, (form, title, colour) in enumerate((("acceleration", "acceleration", RED), ("momentum", "momentum", BLUE))):
        panel = Panel(i * PANEL, legs, rows[form], title, colour)
        for marker in parsed["marker"][:1]:
            panel.trace(marker)
        panel.leg("2", 0.35)
        panel.leg("1", 1)
        panel.crank()
        panels.append(panel.text())

    chart = Chart("Position drift up to time t [m]", "t [s]", (0, END), (-16, 0), linear_x=True,
                  size=(WIDTH - 2 * PANEL, HEIGHT, 146))
    for form, label, colour in (("acceleration", "acceleration", RED), ("momentum", "momentum, reset", BLUE),
                                ("projected", "projected", GREEN)):
        points = running_max(rows[form], "position_drift [m]", 0)
        points[0] = (0, points[1][1])  # the start itself is closed to rounding
        chart.curve(points, label, colour, more=' clip-path="url(#grown)"')
        chart.out.append(f'<circle r="4" fill="{colour}" cx="{chart.right}" cy="{chart.at_y(points[-1][1]):.1f}">'
                         + animated("cx", [f"{chart.at_x(t):.1f}" for t, _ in points])
                         + animated("cy", [f"{chart.at_y(d):.1f}" for _, d in points]) + "</circle>")
    widths = [f"{chart.at_x(i / RATE) - chart.left:.1f}" for i in range(END * RATE + 1)]
    chart.out.append(f'<clipPath id="grown"><rect x="{chart.left}" y="0" height="{HEIGHT}" width="{widths[-1]}">'
                     + animated("width", widths) + "</rect></clipPath>")
    drawn = chart.text_of().replace("<svg ", f'<svg x="{2 * PANEL}" width="{WIDTH - 2 * PANEL}" height="{HEIGHT}" ', 1)

    note = f"RK4, h = {1000 * float(STEP):g} ms. Dots: the joints that close the loops."
    title = "Two legs of a Strandbeest on two forms, RK4 with h = 12.5 ms, and their position drift"
    file = TOP / "docs/figures/strandbeest.svg"
    file.write_text("\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
        'font-family="system-ui, sans-serif" font-size="14">', f"<title>{title}</title>",
        "<style>.bg{fill:#fff}.ink{fill:#222}.line{stroke:#222}.faint{stroke:#999}.pin{stroke:#111}"
        "@media (prefers-color-scheme:dark){.bg{fill:#16181c}.ink{fill:#e6e6e6}.line{stroke:#e6e6e6}.pin{stroke:#fff}}</style>",
        f'<rect class="bg" width="{WIDTH}" height="{HEIGHT}"/>', *panels,
        f'<text class="ink" x="12" y="{HEIGHT - 12}">{note}</text>', drawn + "</svg>", ""]), encoding="utf-8")
    print(f"{file.relative_to(TOP)}: {file.stat().st_size / 1000:.0f} kB")


main()
