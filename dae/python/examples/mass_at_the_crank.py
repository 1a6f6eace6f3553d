"""Effective inertia of Andrews' squeezer at its crank, from M and the loop equations alone.

The null vector n of Phi_q tells how all joints move with the crank; n' M n is the inertia felt
there, and the momentum equation (7) has to give the same.
"""

import os
import pathlib

import momenta
import numpy as np

examples = pathlib.Path(os.environ.get("MOMENTA_EXAMPLES", "examples"))
mechanism = momenta.load(str(examples / "andrews" / "scene.toml"))
start = mechanism.assemble()

mass, jacobian = mechanism.kkt(0.0, start.q)
motion = np.linalg.svd(jacobian)[2][-1]
motion /= motion[0]  # one rad/s at the crank
inertia = motion @ mass @ motion
print(f"mobility {start.mobility}, inertia at the crank {inertia:.4e} kg m2")

# An impulse at the crank: u of (7) is motion / inertia.
impulse = np.zeros(mechanism.nv)
impulse[0] = 1e-6
rates, sigma, _ = mechanism.momentum_rates(0.0, start.q, impulse)
print(f"crank after an impulse of 1e-6 N m s: {rates[0]:.6f} rad/s")
assert abs(rates[0] * inertia / 1e-6 - 1) < 1e-9
