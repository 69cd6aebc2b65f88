"""How many samples does each method need? A sweep over all methods, answered by a table and two plots.

A sample is a direction, or a line through the sphere. The methods that march the same directions agree in visibility;
they differ in `ambient`, the light that arrives.
Run it with `python examples/07_sweep.py [FOLDER]`. A second run with the same folder computes nothing twice.
"""

import sys
from pathlib import Path

import aolab
from aolab.modules import MODULES

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/sweep")
counts = {"directions", "line_samples"}  # the second is that of rotated_ssao; rsm and none sample no occlusion
methods = [name for name, module in MODULES.items() if counts & set(module.stated())]

table = aolab.sweep(
    ["boxes", "colonnade"],
    methods,
    directions=[2, 4, 8, 16, 32],
    line_samples=[2, 4, 8, 16, 32],
    radius=0.4,
    filter="none",  # the samples alone, without a filter's help
    seed=range(3),
    size=(240, 135),
    rays=256,
    measures=["ambient.rmse", "visibility.rmse"],
    folder=folder,
)
table["samples"] = table["directions"].fillna(table["line_samples"])
error = table.pivot_table("ambient.rmse", "module", "samples")
print(error.to_string(float_format="{:.4f}".format))
enough = error.le(1.1 * error.min(axis=1), axis=0).idxmax(axis=1)
print("\nThe fewest samples within 10 % of the least error:", enough.to_string(), sep="\n")
table.lines("samples").savefig(folder / "samples.png")
table.pareto().savefig(folder / "pareto.png")
print(f"\nPictures: {folder}/samples.png, {folder}/pareto.png")
