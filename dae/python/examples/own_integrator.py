"""A method of one's own on the canonical equations: classical Runge-Kutta in ten lines.

sigma is a gauge: after each step its part is taken off p again (reset), so that p stays small.
"""

import os
import pathlib

import momenta
import numpy as np

examples = pathlib.Path(os.environ.get("MOMENTA_EXAMPLES", "examples"))
mechanism = momenta.load(str(examples / "four_bar" / "scene.toml"))
start = mechanism.assemble()


def rates(t, y):
    u, _, pdot = mechanism.momentum_rates(t, y[: mechanism.nq], y[mechanism.nq :])
    return np.concatenate([u, pdot])  # here the coordinates' rates are u: hinges alone


def integrate(h, end):
    y = np.concatenate([start.q, mechanism.momenta(0.0, start.q, start.u)])
    for i in range(round(end / h)):
        t = i * h
        k1 = rates(t, y)
        k2 = rates(t + h / 2, y + h / 2 * k1)
        k3 = rates(t + h / 2, y + h / 2 * k2)
        k4 = rates(t + h, y + h * k3)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        u = rates(t + h, y)[: mechanism.nq]
        y[mechanism.nq :] = mechanism.momenta(t + h, y[: mechanism.nq], u)
    return y[: mechanism.nq]


exact = integrate(1e-3, 1.0)
errors = [np.abs(integrate(h, 1.0) - exact).max() for h in (0.04, 0.02)]
order = np.log2(errors[0] / errors[1])
print(f"errors {errors[0]:.2e}, {errors[1]:.2e}: order {order:.2f}")
assert 3.5 < order < 4.7
