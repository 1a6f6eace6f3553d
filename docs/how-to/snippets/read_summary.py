"""summary.json: what was asked and what came out. Not measured is None."""
import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    run = json.load(file)
for one in run if isinstance(run, list) else [run]:  # drift and work write a list
    print(one["form"], one["status"], "position drift", one["drift"]["position_max"], "m")
