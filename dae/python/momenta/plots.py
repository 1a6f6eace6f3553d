"""Plots in one call, by matplotlib where it is installed: run.plot(), study.plot(), sweep.plot()."""

import numpy

from . import _momenta


class Study(list):
    """A list of Run, from Mechanism.drift or, as ladders of tolerances, from Mechanism.work."""

    def __init__(self, runs=(), ladder=False):
        super().__init__(runs)
        self.ladder = ladder

    @property
    def table(self):
        """The table of the runs, one row each, as the program prints it."""
        return _momenta.table(list(self), self.ladder)

    def __repr__(self):
        return self.table.rstrip()

    def plot(self, what=None, *, ax=None):
        """Draws the runs. For a drift study it draws `what` over time: position_drift by default, or
        another series of the runs, such as velocity_drift or energy_error. For the runs of work it
        draws processor time over error. Returns the axes."""
        ax = axes(ax)
        if self.ladder and what is None:
            for name in dict.fromkeys(map(_name, self)):
                runs = [run for run in self if _name(run) == name and run.status == "done"]
                errors = [run.position_error_max for run in runs]
                ax.loglog(errors, [run.cpu_s for run in runs], ".-", label=name)
            ax.set_xlabel("largest error against the reference, relative")
            ax.set_ylabel("processor time [s]")
        else:
            what = what or "position_drift"
            for run in self:
                ax.semilogy(run.t, numpy.abs(getattr(run, what)), label=_name(run))
            ax.set_xlabel("t [s]")
            ax.set_ylabel(_LABELS.get(what, what))
        return legend(ax)


def plot_run(self, *columns, ax=None):
    """Draws columns of the trajectory over time, by their names; without names it draws the drifts
    and the energy error. Returns the axes."""
    ax = axes(ax)
    for name in columns:
        ax.plot(self.t, self[name], label=name)
    if not columns:
        for what in ("position_drift", "velocity_drift", "energy_error"):
            ax.semilogy(self.t, numpy.abs(getattr(self, what)), label=_LABELS[what])
    ax.set_xlabel("t [s]")
    return legend(ax)


_LABELS = {
    "position_drift": "position drift [m]",
    "velocity_drift": "velocity drift [m/s]",
    "energy_error": "energy error [J]",
}


def _name(run):
    parts = [run.form, run.integrator, run.gauge, "projected" if run.project else ""]
    return ", ".join(part for part in parts if part)


def axes(given):
    """The given axes, else new ones. Raises ImportError where there is no matplotlib."""
    if given is not None:
        return given
    try:
        from matplotlib import pyplot
    except ImportError:
        raise ImportError(
            "plot() draws by matplotlib, and there is no matplotlib: install python3-matplotlib"
        ) from None
    return pyplot.subplots()[1]


def legend(ax):
    ax.legend()
    ax.grid(True, alpha=0.3)
    return ax
