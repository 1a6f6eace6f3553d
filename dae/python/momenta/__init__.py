"""Constrained multibody systems on canonical momenta: open chains, closed loops, and their drift.

    m = momenta.load('examples/four_bar/scene.toml')
    run = m.run(form='momentum', end=10)
    run.t, run['B.x']
    run.plot()

A scene is a file, TOML text, or a Scene built in Python. SI units and radians; arrays are float64.
t: time [s]; q: coordinates (nq); u: rates (nv); p: momenta (nv); sigma, lambda_: impulse and force
multipliers of the loops (m). One Mechanism serves one thread at a time.

Methods of Mechanism take and return NumPy arrays. The functions evaluate, index, run, sweep and view are the
verbs of the program: they take the same input and return what the program writes.
"""

from ._momenta import Mechanism, Run, SceneError, Start, __version__, forms, integrators
from .formulas import Formula
from .plots import Study, plot_run
from .scene import Scene
from .sweeps import Sweep, sweep
from .verbs import Page, evaluate, index, load, parse, run, view

__all__ = [
    "Formula", "Mechanism", "Page", "Run", "Scene", "SceneError", "Start", "Study", "Sweep", "__version__",
    "evaluate", "forms", "index", "integrators", "load", "parse", "run", "sweep", "view",
]  # fmt: skip

Run.plot = plot_run
for _public in (Formula, Page, Scene, Study, Sweep, evaluate, index, load, parse, plot_run, run, sweep, view):
    _public.__module__ = __name__
plot_run.__name__, plot_run.__qualname__ = "plot", "Run.plot"
del _public, plot_run
