"""How many samples does each method need? A sweep over all methods, answered by a table and two plots.

The methods march the same directions, so their visibility agrees; they differ in `ambient`, the light that arrives.
Run it with `python examples/07_sweep.py [FOLDER]`. A second run with the same folder computes nothing twice.
"""

import sys
from pathlib import Path

import aolab
from aolab.modules import MODULES

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/sweep")
methods = [name for name, module in MODULES.items() if "directions" in module.stated()]

table = aolab.sweep(
    ["boxes", "colonnade"],
    methods,
    directions=[2, 4, 8, 16, 32],
    radius=0.4,
    filter="none",  # the samples alone, without a filter's help
    seed=range(3),
    size=(240, 135),
    rays=256,
    measures=["ambient.rmse", "visibility.rmse"],
    folder=folder,
)
error = table.pivot_table("ambient.rmse", "module", "directions")
print(error.to_string(float_format="{:.4f}".format))
enough = error.le(1.1 * error.min(axis=1), axis=0).idxmax(axis=1)
print("\nThe fewest directions within 10 % of the least error:", enough.to_string(), sep="\n")
table.lines("directions").savefig(folder / "directions.png")
table.pareto().savefig(folder / "pareto.png")
print(f"\nPictures: {folder}/directions.png, {folder}/pareto.png")
