"""run.h5 by h5py: one dataset a column, with its unit."""
import json
import sys
import h5py

with h5py.File(sys.argv[1], "r") as file:
    labels = file["trajectory"].attrs["columns"].decode().split("\n")[:-1]
    t, energy = file["trajectory/t"], file["trajectory/energy"]
    status = json.loads(file.attrs["summary"].decode())["status"] if "summary" in file.attrs else "unfinished"
    print(f"{len(t)} samples to {t[-1]:g} {t.attrs['unit'].decode()}, {len(labels)} columns, {status}")
    print(f"largest change of energy {abs(energy[:] - energy[0]).max():.3g} J")
