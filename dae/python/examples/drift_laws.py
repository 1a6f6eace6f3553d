"""How far the loop of a four-bar opens: exponents of drift, fitted from the runs themselves.

    PYTHONPATH=build/release/dae/python python3 dae/python/examples/drift_laws.py
"""

import os
import pathlib

import momenta
import numpy as np

examples = pathlib.Path(os.environ.get("MOMENTA_EXAMPLES", "examples"))
mechanism = momenta.load(str(examples / "four_bar" / "scene.toml"))


def exponent(run):
    """Slope of log(largest drift so far) over log t, second half of the run in decades."""
    largest = np.maximum.accumulate(run.position_drift)
    late = run.t > run.t[-1] / 10
    return np.polyfit(np.log(run.t[late]), np.log(largest[late]), 1)[0]


print(f"{'form':14} {'gauge':8} {'pos. drift [m]':>14} {'t^':>6}")
for form, gauge in [("momentum", "leak:3"), ("momentum", "reset"), ("acceleration", "")]:
    run = mechanism.run(form=form, gauge=gauge, integrator="rk4", step=0.01, end=100.0, samples=2000)
    print(f"{form:14} {gauge:8} {run.position_drift_max:14.2e} {exponent(run):6.2f}")
    assert run.status == "done", run.reason
    if form == "acceleration":
        assert 1.7 < exponent(run) < 2.3, "positions of twice differentiated loops drift like t^2"
