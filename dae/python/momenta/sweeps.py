"""Sweeps over numbers of a scene, as in the verb `sweep` of the program."""

import concurrent.futures
import csv
import io
import json
import os
import re

import numpy

from . import _momenta
from .plots import axes, legend
from .progress import teller
from .verbs import _ready, _text_of

# As the first line of Mechanism.run's help has them.
_RUN_ARGUMENTS = set(re.findall(r"(\w+): ", _momenta.Mechanism.run.__doc__.partition("\n")[0]))
_RUN_ARGUMENTS -= {"self", "reference", "progress"}


def sweep(
    scene, vary, *, watch=(), sample="", points=None, seed=None, indices=False, threads=0, progress=None, **run
):
    """One run for each combination of varied numbers of a scene, or for each point of a sample of
    their distributions: docs/reference/sweep.md.

    `vary`: {'body.crank.mass': [1, 2], 'gravity.1': '0:-9.81:5'}, or strings 'PLACE=VALUES'; `watch`:
    columns of the trajectory; `sample`: random, latin or sobol, of `points` points (256) with `seed`
    (1), where vary may also be 'FROM:TO', 'FROM:TO:log' or 'normal:MEAN:DEVIATION'; `indices`: Sobol'
    indices too; `threads`: how many run at a time, 0: one for each processor. Further arguments are
    those of Mechanism.run except `reference`. Returns a Sweep.
    """
    mechanism = _ready(scene)
    name = mechanism.name if mechanism is scene else _text_of(scene)[1]
    if isinstance(vary, dict):
        vary = [f"{place}={_values(x)}" for place, x in vary.items()]
    if threads < 0:
        raise ValueError(f"threads is {threads}, expected 0 or more; 0: one for each processor")
    if unknown := run.keys() - _RUN_ARGUMENTS:
        names = ", ".join(sorted(unknown))
        raise TypeError(f"{names}: sweep takes the arguments of Mechanism.run but for reference")
    text, options = _momenta.toml_of(mechanism), mechanism.options | run
    cases = _momenta.Cases(text, name, vary=_listed(vary), watch=_listed(watch), sample=sample, points=points, seed=seed, indices=indices, **options)
    total = len(cases)
    tell = teller(progress) or (lambda fraction, text: None)
    with concurrent.futures.ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        try:
            for number, _ in enumerate(pool.map(cases.make, range(total)), 1):
                tell(number / total, f"[{number}/{total}] cases")
        except BaseException:
            cases.stop()
            pool.shutdown(cancel_futures=True)
            raise
    return Sweep(cases.csv(), json.loads(cases.json()), cases.table())


class Sweep:
    """The results of a sweep, one row per case: sweep['B.y last'] is a column, an array or a list of
    strings.

    `csv` and `json`: what the program writes into sweep.csv and sweep.json; `table`: what it prints.
    Of a sample `json` has its statistics, indices and curves.
    """

    def __init__(self, csv_text, json_dict, table):
        self.csv, self.json, self.table = csv_text, json_dict, table
        header, *rows = csv.reader(io.StringIO(csv_text))
        self._columns = {name: [row[i] for row in rows] for i, name in enumerate(header)}

    @property
    def columns(self):
        """Names of the columns."""
        return list(self._columns)

    def __getitem__(self, name):
        """A column, by its name with the unit or without."""
        column = self._columns[name if name in self._columns else self._with_unit(name)]
        if name in ("status", "reason"):
            return list(column)
        return numpy.array([float(x) if x else numpy.nan for x in column])

    def __len__(self):
        return self.json["cases"]

    def __repr__(self):
        return self.table.rstrip()

    def plot(self, column="position_drift_max", *, ax=None):
        """Draws a column over the first varied number, one line for each combination of the others;
        of a sample a point for each case. Returns the axes."""
        first, *others = [varied["place"] for varied in self.json["varied"]]
        ax = axes(ax)
        x, y = self[first], self[column]
        if "sampling" in self.json:  # a point for each case: no two share what is varied
            others = []
        groups = list(zip(*(self[place] for place in others))) or [()] * len(self)
        for group in dict.fromkeys(groups):
            of_it = [g == group for g in groups]
            name = ", ".join(f"{place} = {value:g}" for place, value in zip(others, group))
            ax.plot(x[of_it], y[of_it], "." if "sampling" in self.json else ".-", label=name)
        ax.set_xlabel(first)
        ax.set_ylabel(self._with_unit(column))
        if others:
            legend(ax)
        return ax

    def plot_along_time(self, column, *, ax=None):
        """Draws what a sample says of a watched column: its mean, and the bands between its 5 % and
        95 % and its 25 % and 75 % quantiles. Returns the axes."""
        curve = self.json.get("along_time", {}).get(column)
        if curve is None:
            raise KeyError(f"no curve of '{column}': expected a column watched by a sample")
        y = {name: numpy.array(curve[name], float) for name in ("mean", "q05", "q25", "q75", "q95")}
        ax = axes(ax)
        line = ax.plot(curve["t"], y["mean"], label="mean")[0]
        for low, high in (("q05", "q95"), ("q25", "q75")):
            name = f"{int(low[1:])} to {int(high[1:])} %"
            ax.fill_between(curve["t"], y[low], y[high], color=line.get_color(), alpha=0.2, label=name)
        ax.set_xlabel("t [s]")
        ax.set_ylabel(curve["column"])
        legend(ax)
        return ax

    def _with_unit(self, name):
        for column in self._columns:
            if column == name or column.rpartition(" [")[0] == name:
                return column
        raise KeyError(f"no column '{name}'; `columns` has all of them")


def _listed(x):
    return [x] if isinstance(x, str) else list(x)


def _values(x):
    return x if isinstance(x, str) else ",".join(repr(float(value)) for value in numpy.ravel(x))
