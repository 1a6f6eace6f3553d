"""trajectory.csv by numpy: columns by their label."""
import sys
import numpy as np

with open(sys.argv[1], encoding="utf-8") as file:
    names = next(file).rstrip("\n").split(",")
    table = np.genfromtxt(file, delimiter=",", ndmin=2)
column = dict(zip(names, table.T))

t, energy = column["t [s]"], column["energy [J]"]
print(f"{len(t)} samples to {t[-1]:g} s, largest change of energy {np.abs(energy - energy[0]).max():.3g} J")
