"""`aolab compare`: from words to a sheet."""

import json
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import FileError, ParameterError
from ..loading import load
from ..measures.turning_light import relighting_error
from ..modules import MODULES, Module
from ..output import check_writable, replacing
from ..studies.ranking import Entry, compare_modules, label, sheet, with_their_truth
from .job import parse_size, typed


def compare_command(
    scene: str,
    modules: str | None,
    size: str,
    rays: int,
    radius: float | None,
    buffer: str,
    output: Path | None,
    as_json: bool,
) -> str:
    """Compare, write the sheet to `output`, and return what is to be printed."""
    if output is not None:
        if output.suffix.lower() != ".png":
            raise FileError(f"cannot write {output}: the sheet is written as .png")
        check_writable(output)
    entries = compare_modules(scene, _chosen(modules), size=parse_size(size), rays=rays, radius=radius, buffer=buffer)
    if output is not None:
        with replacing(output) as file:
            sheet(entries).save(file, "PNG")
    if as_json:
        return json.dumps([entry.to_dict() for entry in entries], indent=2, allow_nan=False)
    return table(entries)


def relight_command(
    scene: str, modules: str | None, size: str, rays: int, radius: float | None, turns: int, as_json: bool
) -> str:
    """The error of each module's ambient light as the environment turns around the scene, best first, to be printed."""
    loaded = load(scene)
    found = [
        (label(one, loaded), relighting_error(loaded, one, turns, size=parse_size(size), rays=rays, like=like))
        for one, like in with_their_truth(loaded, _chosen(modules), radius)
    ]
    found.sort(key=lambda item: item[1].rmse)
    if as_json:
        return json.dumps([{"module": name, **json.loads(one.to_json())} for name, one in found], indent=2)
    width = max(len(name) for name, _ in found)
    lines = [f"{'':<{width}}{'rmse':>10}{'relative':>10}{'worst':>10}{'at':>7}   ambient, {turns} turns"]
    for name, one in found:
        mean, worst = float(np.mean(one.relative)), one.measures[one.worst].rmse
        lines.append(f"{name:<{width}}{one.rmse:>10.4f}{mean:>10.3f}{worst:>10.4f}{one.degrees[one.worst]:>6.0f}°")
    return "\n".join(lines)


def _chosen(modules: str | None) -> list[Module]:
    if modules is None:
        return [module() for module in MODULES.values()]
    return [parse_module(text) for text in modules.split(",")]


def parse_module(text: str) -> Module:
    """'ssao?directions=32&steps=4' as a module, parameters written as those of scenes are. Raises `ParameterError`."""
    name, _, rest = text.strip().partition("?")
    parameters: dict[str, Any] = {}
    for pair in filter(None, rest.split("&")):
        key, separator, value = pair.partition("=")
        if not separator:
            raise ParameterError(f"--modules {text}: write NAME?KEY=VALUE&KEY=VALUE, as in ssao?directions=32")
        parameters[key.strip().replace("-", "_")] = value.strip()
    return typed(name, parameters)


def table(entries: list[Entry]) -> str:
    """A line a module, best first."""
    width = max(len(entry.label) for entry in entries)
    columns = ("rmse", "bias", "p99", "ssim", "flip")
    lines = [f"{'':<{width}}" + "".join(f"{name:>10}" for name in (*columns, "frame ms"))]
    for entry in entries:
        one = next(iter(entry.comparison.buffers.values()))
        cells = [*(f"{getattr(one, name):>10.4f}" for name in columns), f"{entry.milliseconds:>10.1f}"]
        lines.append(f"{entry.label:<{width}}" + "".join(cells))
    return "\n".join(lines)
