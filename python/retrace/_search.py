"""Searches for the best design, using a Python function of a result as the objective."""

from __future__ import annotations

import importlib
import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ._arguments import number_list, shown
from ._design import Design
from ._errors import InputError
from ._results import Columns, html_table


def number_of(name: str, value: object) -> float:
    """Checks that a value returned by a function of a result is one number."""
    array = np.asarray(value)
    if array.size != 1 or array.dtype.kind not in "iufb":
        raise InputError(f"must return one number, but returned {shown(value)}", key=name)
    return float(array.reshape(-1)[0])


class FoundOptimum:
    """Result of a search with a Python function as the objective."""

    def __init__(
        self,
        design: Design,
        values: dict[str, float],
        objective: float,
        points: Columns,
        method: str,
    ) -> None:
        self.design = design  #: best design
        self.values = values  #: values of its parameters
        self.objective = objective
        self.points = points  #: all designs that were evaluated
        self.method = method

    def __repr__(self) -> str:
        values = ", ".join(f"{key} {value:.6g}" for key, value in self.values.items())
        looked = len(self.points.rows)
        return f"<FoundOptimum: {self.objective:.6g} at {values}, {looked} designs evaluated>"

    def _repr_html_(self) -> str:
        return html_table(self.points.rows)


def _compass(
    function: Callable[[list[float]], float], start: list[float], step: float, evaluations: int
) -> None:
    """Searches for the minimum in the unit cube by steps along the axes. If no step improves the
    value, the step size is halved (compass search; Kolda, Lewis and Torczon 2003)."""
    best, at = function(start), start
    left = evaluations - 1
    while step > 1e-4 and left > 0:
        moved = False
        for axis, side in itertools.product(range(len(at)), (1, -1)):
            there = [*at]
            there[axis] = min(1.0, max(0.0, at[axis] + side * step))
            if there == at or left <= 0:
                continue
            left -= 1
            value = function(there)
            if value < best:
                best, at, moved = value, there, True
        if not moved:
            step /= 2


def _first_look(dimensions: int, scan: int) -> Iterator[list[float]]:
    """Yields the centres of about `scan` equal cells of the unit cube."""
    side = max(2, round(scan ** (1 / dimensions)))
    for point in itertools.product(range(side), repeat=dimensions):
        yield [(k + 0.5) / side for k in point]


def search(
    design: Design,
    parameters: Mapping[str, Any],
    objective: Callable[[Any], Any],
    of: Callable[[Design], Any],
    minimize: bool,
    scan: int,
    evaluations: int,
    tell: Any,
) -> FoundOptimum:
    ends: dict[str, tuple[float, float]] = {}
    for key, interval in parameters.items():
        low_high = number_list("parameters", interval)
        if len(low_high) != 2 or not low_high[0] < low_high[1]:
            raise InputError(
                f"{key}: must be a pair (minimum, maximum), got {shown(interval)}", key="parameters"
            )
        ends[key] = (low_high[0], low_high[1])
    rows: list[dict[str, Any]] = []

    def loss(fractions: Sequence[float]) -> float:
        values = {
            key: low + min(1.0, max(0.0, float(fraction))) * (high - low)
            for fraction, (key, (low, high)) in zip(fractions, ends.items())
        }
        row: dict[str, Any] = dict(values)
        rows.append(row)
        if tell is not None:
            tell(min(0.999, len(rows) / evaluations))
        try:
            value = number_of("objective", objective(of(design.replace(values))))
        except InputError as error:
            if error.key == "objective":
                raise
            row["reason"] = str(error)
            return math.inf
        row["objective"] = value
        return math.inf if math.isnan(value) else value if minimize else -value

    looked = [(loss(fractions), fractions) for fractions in _first_look(len(ends), scan)]
    start = min(looked, key=lambda one: one[0])[1]
    step = 0.5 / max(2, round(scan ** (1 / len(ends))))
    left = max(1, evaluations - len(rows))
    try:
        of_scipy = importlib.import_module("scipy.optimize").minimize
    except ImportError:
        method = "compass search"
        _compass(loss, start, step, left)
    else:
        method = "Nelder-Mead (scipy)"
        simplex = [start] + [
            [
                fraction + (step if fraction < 0.5 else -step) * (k == axis)
                for k, fraction in enumerate(start)
            ]
            for axis in range(len(start))
        ]
        of_scipy(
            loss,
            start,
            method=method.split()[0],
            bounds=[(0.0, 1.0)] * len(start),
            options={"maxfev": left, "initial_simplex": simplex, "xatol": 1e-4, "fatol": 1e-9},
        )
    good = [row for row in rows if math.isfinite(row.get("objective", math.nan))]
    if not good:
        raise InputError(
            f"none of {len(rows)} designs could be computed, the first error: "
            f"{rows[0].get('reason', 'no number')}",
            key="parameters",
        )
    sign = 1.0 if minimize else -1.0
    best = min(good, key=lambda row: sign * float(row["objective"]))
    values = {key: best[key] for key in ends}
    return FoundOptimum(design.replace(values), values, best["objective"], Columns(rows), method)
