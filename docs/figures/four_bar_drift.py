#!/usr/bin/env python3
"""Draws docs/figures/four_bar_drift.svg: how far the loop of examples/four_bar opens in 1000 s.

First the data, one folder a curve (repeat for the forms named in CURVES below):
    momenta run examples/four_bar/scene.toml --form acceleration --integrator rk4 --out DATA/acceleration
Then:
    docs/figures/four_bar_drift.py DATA > docs/figures/four_bar_drift.svg
"""
import csv
import json
import math
import sys
from pathlib import Path

# folder, label, colour (Okabe and Ito), dash
CURVES = [
    ("acceleration", "acceleration", "#d55e00", ""),
    ("momentum-none", "momentum, no gauge", "#0072b2", "12 4"),
    ("acceleration-index2", "acceleration-index2, IDA", "#e69f00", "6 4"),
    ("momentum-leak", "momentum, leak 3/s", "#0072b2", ""),
    ("momentum-reset", "momentum, reset", "#0072b2", "2 3"),
    ("baumgarte", "baumgarte", "#e69f00", ""),
    ("momentum-index2", "momentum-index2, IDA", "#56b4e9", "6 4"),
]
W, H = 970, 500
LEFT, RIGHT, TOP, BOTTOM = 72, 640, 40, 446
T0, T1, Y0, Y1 = 1.0, 1000.0, -10, 0


def x_of(t):
    return LEFT + (RIGHT - LEFT) * math.log10(t / T0) / math.log10(T1 / T0)


def y_of(v):
    return BOTTOM - (BOTTOM - TOP) * (math.log10(v) - Y0) / (Y1 - Y0)


def running_max(folder):
    """(t, largest drift up to t), thinned to what a curve of this size can show."""
    top, points, last = 0.0, [], -1e9
    with open(folder / "trajectory.csv", encoding="utf-8") as f:
        for row in csv.DictReader(f):
            t, top = float(row["t [s]"]), max(top, abs(float(row["position_drift [m]"])))
            if t >= T0 and (x_of(t) > last + 1.5 or t == T1):
                points.append((t, top))
                last = x_of(t)
    return points


def is_power(points, exponent):
    """Whether it grows by this power in the last half decade and hardly otherwise in the one before."""
    at = [next(v for t, v in points if t >= T) for T in (100, 316, T1)]
    earlier, later = (2 * math.log10(at[i + 1] / at[i]) for i in (0, 1))
    return abs(later - exponent) < 0.2 and abs(later - earlier) < 0.4 and exponent > 0.5


def told(v):
    """0.28 m, 7.3 µm, 14 nm"""
    for unit, size in (("m", 1), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9)):
        if v >= (0.1 if unit == "m" else 1) * size:
            n = v / size
            return (f"{n:.0f}" if n >= 10 else f"{n:.2g}") + " " + unit
    return f"{v:.1e} m"


def main(data):
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {W} {H}" role="img" '
           'font-family="system-ui, sans-serif" font-size="14">',
           "<title>Largest loop opening up to time t, planar four-bar, 1000 s</title>",
           "<style>.bg{fill:#fff}.ink{fill:#222}.grid{stroke:#ddd}.slope{stroke:#999}"
           "@media (prefers-color-scheme:dark){.bg{fill:#16181c}.ink{fill:#e6e6e6}.grid{stroke:#3a3d44}"
           ".slope{stroke:#777}}</style>",
           f'<rect class="bg" width="{W}" height="{H}"/>',
           f'<text class="ink" x="{LEFT}" y="24" font-weight="600">Largest opening of the loop up to '
           'time t [m]</text>']
    for e in range(Y0, Y1 + 1, 2):
        y = y_of(10.0**e)
        out.append(f'<line class="grid" x1="{LEFT}" y1="{y:.1f}" x2="{RIGHT}" y2="{y:.1f}"/>')
        label = "1" if e == 0 else f'10<tspan dy="-6" font-size="10">{str(e).replace("-", "−")}</tspan>'
        out.append(f'<text class="ink" x="{LEFT - 8}" y="{y + 5:.1f}" text-anchor="end">{label}</text>')
    for e in range(4):
        x = x_of(10.0**e)
        out.append(f'<line class="grid" x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{BOTTOM}"/>')
        out.append(f'<text class="ink" x="{x:.1f}" y="{BOTTOM + 20}" text-anchor="middle">{10**e}</text>')
    out.append(f'<text class="ink" x="{(LEFT + RIGHT) / 2}" y="{BOTTOM + 42}" text-anchor="middle">t [s]</text>')
    for power, v in ((1, 2e-10), (2, 2e-10)):
        end = v * 8**power
        out.append(f'<line class="slope" x1="{x_of(3):.1f}" y1="{y_of(v):.1f}" x2="{x_of(24):.1f}" '
                   f'y2="{y_of(end):.1f}" stroke-dasharray="2 3"/>')
        out.append(f'<text class="ink" x="{x_of(25):.1f}" y="{y_of(end) + 4:.1f}" font-size="12">'
                   f't{"²" if power == 2 else ""}</text>')

    ends = []
    for folder, label, colour, dash in CURVES:
        points = running_max(data / folder)
        path = "M" + "L".join(f"{x_of(t):.1f} {y_of(v):.1f}" for t, v in points)
        out.append(f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="2"'
                   + (f' stroke-dasharray="{dash}"' if dash else "") + "/>")
        with open(data / folder / "summary.json", encoding="utf-8") as f:
            drift = json.load(f)["drift"]
        exponent = drift["position_exponent"] or 0
        law = f", ∝ t^{exponent:.2f}" if is_power(points, exponent) else ""
        ends.append((y_of(points[-1][1]), f"{label}: {told(points[-1][1])}" + law, colour))
    ends.sort()
    places = [y for y, _, _ in ends]
    for _ in range(200):  # labels push one another apart
        for i in range(len(places) - 1):
            gap = 18 - (places[i + 1] - places[i])
            if gap > 0:
                places[i] -= gap / 2
                places[i + 1] += gap / 2
    for place, (y, label, colour) in zip(places, ends):
        out.append(f'<path d="M{RIGHT} {y:.1f}L{RIGHT + 12} {place:.1f}" stroke="{colour}" fill="none"/>')
        out.append(f'<text class="ink" x="{RIGHT + 16}" y="{place + 5:.1f}">{label}</text>')
    out.append("</svg>")
    print("\n".join(out))


main(Path(sys.argv[1]))
