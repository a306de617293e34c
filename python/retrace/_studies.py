"""Studies: parameter sweeps, manufacturing tolerances, and optimization of designs."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np

from . import _core
from ._arguments import (
    PathLike,
    checked,
    flag,
    number,
    path,
    refuse,
    shown,
    thread_count,
    whole,
    word,
)
from ._design import AnyDesign, Design, design_of, overrides_of, toml_text
from ._errors import InputError
from ._fields import FIELDS
from ._light import rre
from ._progress import Progress, teller
from ._request import given
from ._results import Columns, Result, dataset_of, html_table
from ._search import FoundOptimum, number_of, search

__all__ = [
    "FoundOptimum",
    "Optimum",
    "SweepResult",
    "ToleranceResult",
    "optimize",
    "sweep",
    "tolerance",
]

#: Quantity that is computed for each design: its kind, a table [[quantity]] of a study file, or a
#: function of a result.
Quantity = Union[str, Mapping[str, Any], Callable[[Any], Any]]
#: Values of a parameter, or a dict with keys of a table [[parameter]], such as {"from": 0.1, "to":
#: 5}.
Values = Any

_MOST_SEED = 2**32 - 1
_MEANINGS = {
    "seed": FIELDS["study"]["seed"].meaning,
    "store": "SQLite file in which finished points are kept",
    "resume": "continue with the store: finished points are not computed again",
    "overwrite": "replace the store and compute all points again",
}
_KEY = '{"element.base_mm": [0.5, 1, 2]}'


class SweepResult(Result):
    """Result of a parameter sweep. Arrays such as `result["element.base_mm"]` and `result["rre"]`
    have one value per point."""

    _rows = "points"
    _told = ("points_in_all", "failed")

    parameters: list[str]
    quantities: list[str]
    points: Columns
    complete: bool

    def __getitem__(self, name: str) -> Any:
        return self.points[name]

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset. Its dimensions are the parameters if their values form a grid,
        otherwise the points."""
        sizes = [len(dict.fromkeys(map(str, self.points[name]))) for name in self.parameters]
        is_grid = math.prod(sizes) == len(self.points.rows) > 0
        dims = self.parameters if is_grid else ["point"]
        return dataset_of(
            self.points, dims, self._attributes(), lambda name: is_grid and name == "point"
        )

    def _repr_html_(self) -> str | None:
        return html_table(self.points.rows)


class ToleranceResult(Result):
    """Result of a tolerance study, with one row per quantity."""

    _rows = "quantities"
    _told = ("title", "parts", "failed")

    is_enough: bool  #: true if the yield is at least the required yield

    def __init__(self, core: Any) -> None:
        super().__init__(core, drawings={"tolerance": core.drawing})
        self.is_enough = core.is_yes

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("tolerance")


class Optimum(Result):
    """Best design that satisfies all constraints. `pareto` contains the designs of the Pareto
    front. `designs` contains all evaluated designs, which the plot shows."""

    _rows = "pareto"
    _told = ("title", "objective_at_best")

    is_feasible: bool  #: true if a design satisfies the constraints
    #: The design that was varied, or None if a study file was given.
    design: Design | None

    def __init__(self, core: Any, design: Design | None = None) -> None:
        super().__init__(core, drawings={"optimum": core.drawing})
        self.is_feasible = core.is_yes
        self.design = design

    @property
    def designs(self) -> Columns:
        """All evaluated designs: parameters, quantities with standard errors, and the objective.
        `feasible` is true if a design satisfies all constraints."""
        return Columns(self.document["designs"])

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("optimum")

    @property
    def objective_at_best(self) -> float:
        """Objective of the best design, or NaN if no design is feasible."""
        return float(self.document.get("best", {}).get("objective", math.nan))

    @property
    def best_design(self) -> Design:
        """The best design: the original design with the best values of the varied keys."""
        if self.design is None or not self.is_feasible:
            raise InputError(
                "exists only if the study has a design and a feasible design was found",
                key="best_design",
            )
        best = self.document["best"]
        return self.design.replace({key: value for key, value in best.items() if "." in key})


def _parameter(key: object, values: Values) -> dict[str, Any]:
    """Returns a table [[parameter]] of a study file."""
    if not isinstance(key, str) or not key:
        raise refuse("parameters", f"a dict such as {_KEY}", key)
    if isinstance(values, Mapping):
        return {"key": key, **values}
    listed = values.tolist() if isinstance(values, np.ndarray) else values
    if isinstance(listed, (str, bytes)) or not isinstance(listed, (list, tuple, range)):
        raise InputError(
            f"{key}: must be a list of values, or a dict such as "
            f'{{"from": 0.1, "to": 5}}, got {shown(values)}',
            key="parameters",
        )
    if not listed:
        raise InputError(f"{key}: must be one value or more, got none", key="parameters")
    return {"key": key, "values": list(listed)}


def _name_of(function: Callable[..., Any]) -> str:
    name = getattr(function, "__name__", type(function).__name__)
    return "value" if name == "<lambda>" else name


def _split(quantities: object) -> tuple[list[dict[str, Any]], dict[str, Callable[[Any], Any]]]:
    """Returns the tables [[quantity]], and the functions by name."""
    if isinstance(quantities, str) or callable(quantities):
        quantities = [quantities]
    if isinstance(quantities, Mapping) and all(map(callable, quantities.values())):
        return [], dict(quantities)
    if not isinstance(quantities, (list, tuple)) or not quantities:
        raise refuse(
            "quantities",
            'a list of names such as "rre", tables, or functions of a result',
            quantities,
        )
    tables: list[dict[str, Any]] = []
    functions: dict[str, Callable[[Any], Any]] = {}
    for quantity in quantities:
        if isinstance(quantity, str):
            tables.append({"kind": quantity})
        elif isinstance(quantity, Mapping):
            tables.append(dict(quantity))
        elif callable(quantity):
            functions[_name_of(quantity)] = quantity
        else:
            raise refuse(
                "quantities", 'names such as "rre", tables, or functions of a result', quantity
            )
    return tables, functions


def _constraints(constraints: object) -> list[dict[str, Any]]:
    """Converts {"quantity": (minimum, maximum)} to tables [[constraint]]."""
    if not isinstance(constraints, Mapping):
        raise refuse("constraints", 'a dict such as {"machining_time_h": (None, 5)}', constraints)
    tables = []
    for name, ends in constraints.items():
        if not isinstance(ends, (tuple, list)) or len(ends) != 2:
            raise InputError(
                f"{name}: must be (minimum, maximum) with None for no limit, got {shown(ends)}",
                key="constraints",
            )
        limits = {
            end: number("constraints", limit)
            for end, limit in zip(("min", "max"), ends)
            if limit is not None
        }
        tables.append({"quantity": name, **limits})
    return tables


def _settings(**tables: object) -> dict[str, Any]:
    """Returns the tables of a study that are not None."""
    given: dict[str, Any] = {}
    for name, table in tables.items():
        if table is None:
            continue
        if not isinstance(table, Mapping):
            raise refuse(name, f"a dict: the table [{name}] of a study file", table)
        given[name] = dict(table)
    return given


def _study_of(
    design: Design, parameters: object, quantities: list[dict[str, Any]], tables: Mapping[str, Any]
) -> tuple[_core.Study, list[str]]:
    """Returns a study of a design in memory, and the overrides of keys that are not varied."""
    if not isinstance(parameters, Mapping) or not parameters:
        raise refuse("parameters", f"a dict such as {_KEY}", parameters)
    rows = [_parameter(key, values) for key, values in parameters.items()]
    text = toml_text(
        {
            "schema": "retrace.study/1",
            "title": design.title or design.source,
            "design": design.source,
            **tables,
            "parameter": rows,
            "quantity": quantities,
        }
    )
    varied = {row["key"] for row in rows}
    changes = [
        change for change in design._core.overrides if change.partition("=")[0] not in varied
    ]
    return _core.Study(text, "study", {design.source: design.text}), changes


def _request(
    changes: list[str], seed: int, store: PathLike | None, resume: bool, overwrite: bool
) -> Any:
    if flag("resume", resume) and flag("overwrite", overwrite):
        raise InputError("not allowed together with overwrite", key="resume")
    request = given(_core.StudyRequest(), FIELDS["study"], seed=seed)
    request.overrides = changes
    if store is not None:
        request.store = path("store", store)
    elif resume or overwrite:
        raise InputError("needs a store", key="resume" if resume else "overwrite")
    request.if_exists = "resume" if resume else "overwrite" if overwrite else "refuse"
    return request


def _from_file(study: object, parameters: object) -> bool:
    """Returns true if the argument is a study file; otherwise it is a design."""
    is_name = isinstance(study, str) or hasattr(study, "__fspath__")
    if parameters is None and not is_name:
        raise InputError(f"are required with a design, a dict such as {_KEY}", key="parameters")
    return parameters is None


def _grid(parameters: object) -> list[dict[str, Any]]:
    """Returns all combinations of values. The last parameter varies fastest."""
    if not isinstance(parameters, Mapping) or not parameters:
        raise refuse("parameters", f"a dict such as {_KEY}", parameters)
    lists = []
    for key, values in parameters.items():
        row = _parameter(key, values)
        if "values" not in row:
            raise InputError(
                f"{key}: must be a list of values if quantities are functions", key="parameters"
            )
        lists.append([(key, value) for value in row["values"]])
    return [dict(point) for point in itertools.product(*lists)]


def _with_functions(
    design: Design,
    points: list[dict[str, Any]],
    keys: Sequence[str],
    functions: Mapping[str, Callable[[Any], Any]],
    of: Callable[[Design], Any],
    tell: Any,
) -> None:
    """Evaluates functions of the result at each point and adds their values to the point."""
    for k, point in enumerate(points):
        if point["status"] == "done":
            try:
                result = of(design.replace({key: point[key] for key in keys}))
            except InputError as error:
                point.update(status="failed", reason=str(error))
            else:
                for name, function in functions.items():
                    value = number_of(name, function(result))
                    if math.isfinite(value):
                        point[name] = value
        if tell is not None:
            tell((k + 1) / len(points))


def _swept(study: Any, seed: int) -> dict[str, Any]:
    """Returns the document, without points, of a sweep with only Python functions as quantities."""
    return {
        "schema": "retrace.sweep/1",
        "study": "study",
        "parameters": list(study),
        "quantities": [],
        "seed": seed,
        "version": _core.version(),
        "warnings": [],
        "complete": True,
    }


@checked(_MEANINGS)
def sweep(
    study: AnyDesign,
    parameters: Mapping[str, Values] | None = None,
    *,
    quantities: Any = ("rre",),
    of: Callable[[Design], Any] = rre,
    combine: str = "grid",
    samples: int | None = None,
    analysis: Mapping[str, Any] | None = None,
    machining: Mapping[str, Any] | None = None,
    changes: Mapping[str, object] | None = None,
    store: PathLike | None = None,
    resume: bool = False,
    overwrite: bool = False,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> SweepResult:
    """Runs a parameter sweep, like the command `retrace sweep`. The sweep is given by a study file,
    or by a design and parameters.

        sweep("study.toml", store="s.sqlite", resume=True)
        sweep(design, {"element.base_mm": [0.5, 1, 2]}, quantities=["rre", "machining_time_h"])
        sweep(design, {"element.base_mm": [0.5, 1, 2]}, quantities={"worst": lambda r: r.rre.min()},
              of=lambda d: rre(d, incidence_deg=[0, 10, 20]))

    quantities: kinds of [[quantity]] as in a study file, tables [[quantity]], or functions of a
    result. of: function of a design that computes the result for these functions [rre at normal
    incidence]. combine: grid, zip, sobol, latin_hypercube or monte_carlo, as in [sweep] of a study
    file. samples: number of points for sobol, latin_hypercube and monte_carlo. analysis, machining:
    tables of these names in a study file. changes: only for study files; values that replace keys
    of the design and of these tables. store: SQLite file for finished points."""
    count = thread_count(threads)
    if _from_file(study, parameters):
        request = _request(overrides_of(changes or {}), seed, store, resume, overwrite)
        read = _core.Study.load(path("study", study))
        with teller(progress, "sweeping") as tell:
            return SweepResult(_core.sweep(read, request, tell, count))
    design = design_of(study)
    if changes is not None:
        raise InputError("are only for study files; use replace() of the design", key="changes")
    tables, functions = _split(quantities)
    if functions and store is not None:
        raise InputError("can contain only quantities of retrace, not functions", key="store")
    if not callable(of):
        raise refuse("of", "a function of a design", of)
    assert parameters is not None
    result: SweepResult
    if tables:
        how: dict[str, Any] = {"combine": word("combine", combine)}
        if samples is not None:
            how["samples"] = whole("samples", samples, 1)
        settings = _settings(sweep=how, analysis=analysis, machining=machining)
        read, given = _study_of(design, parameters, tables, settings)
        request = _request(given, seed, store, resume, overwrite)
        with teller(None if functions else progress, "sweeping") as tell:
            result = SweepResult(_core.sweep(read, request, tell, count))
        if not functions:
            return result
        document = result.document
    else:
        points = [
            {"point": k, "status": "done", **point} for k, point in enumerate(_grid(parameters))
        ]
        document = {**_swept(parameters, whole("seed", seed, 0, _MOST_SEED)), "points": points}
    taken = {*document["parameters"], *document["quantities"]}
    for name in functions:
        if name in taken:
            raise InputError(
                f"{name} is already used: give the function another name", key="quantities"
            )
    with teller(progress, "sweeping") as tell:
        _with_functions(design, document["points"], document["parameters"], functions, of, tell)
    document["quantities"] += list(functions)
    document["points_in_all"] = len(document["points"])
    document["failed"] = sum(point["status"] != "done" for point in document["points"])
    table = Columns(document["points"])
    return SweepResult(
        json=json.dumps(document, indent=2) + "\n",
        table=_text_table(table),
        warnings=document["warnings"],
    )


def _text_table(columns: Columns) -> str:
    """Returns the points as a text table."""
    names = [name for name in columns if name not in ("point", "status")]
    rows = [names] + [
        [
            f"{row[name]:.6g}" if isinstance(row.get(name), float) else str(row.get(name, ""))
            for name in names
        ]
        for row in columns.rows
    ]
    widths = [max(len(row[k]) for row in rows) for k in range(len(names))]
    return "".join(
        "  ".join(cell.rjust(width) for cell, width in zip(row, widths)) + "\n" for row in rows
    )


@checked(_MEANINGS)
def tolerance(
    study: AnyDesign,
    parameters: Mapping[str, Values] | None = None,
    *,
    quantities: Any = ("rre",),
    constraints: Mapping[str, tuple[float | None, float | None]] | None = None,
    tolerance: Mapping[str, Any] | None = None,
    analysis: Mapping[str, Any] | None = None,
    machining: Mapping[str, Any] | None = None,
    changes: Mapping[str, object] | None = None,
    store: PathLike | None = None,
    resume: bool = False,
    overwrite: bool = False,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> ToleranceResult:
    """Computes the effect of manufacturing tolerances on a design, like the command
    `retrace tolerance`. The input is a study file, or a design and the distributions of its keys.

        tolerance(design, {"surface.dihedral_error_arcmin": {"distribution": "normal", "mean": 0,
        "sigma": 3}},
                  constraints={"rre": (0.96, None)})

    constraints: minimum and maximum of each quantity for a good part. tolerance, analysis,
    machining: tables of these names in a study file. Other arguments are those of sweep()."""
    count = thread_count(threads)
    if _from_file(study, parameters):
        read, given = _core.Study.load(path("study", study)), overrides_of(changes or {})
    else:
        tables, functions = _split(quantities)
        if functions:
            raise InputError(
                "must be quantities of retrace; functions are for sweep() and optimize()",
                key="quantities",
            )
        settings = _settings(tolerance=tolerance, analysis=analysis, machining=machining)
        read, given = _study_of(
            design_of(study),
            parameters,
            tables,
            {**settings, "constraint": _constraints(constraints or {})},
        )
    request = _request(given, seed, store, resume, overwrite)
    with teller(progress, "making parts") as tell:
        return ToleranceResult(_core.tolerance(read, request, tell, count))


@checked(_MEANINGS)
def optimize(
    study: AnyDesign,
    parameters: Mapping[str, Values] | None = None,
    *,
    objective: Any = "rre",
    minimize: bool = False,
    of: Callable[[Design], Any] = rre,
    quantities: Any = (),
    constraints: Mapping[str, tuple[float | None, float | None]] | None = None,
    optimize: Mapping[str, Any] | None = None,
    analysis: Mapping[str, Any] | None = None,
    machining: Mapping[str, Any] | None = None,
    changes: Mapping[str, object] | None = None,
    scan: int = 17,
    evaluations: int = 200,
    store: PathLike | None = None,
    resume: bool = False,
    overwrite: bool = False,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> Union[Optimum, FoundOptimum]:
    """Finds the best design within constraints, like the command `retrace optimize`. The input is a
    study file, or a design and parameters.

        optimize("study.toml")
        optimize(design, {"element.base_mm": {"from": 0.1, "to": 5}},
        constraints={"machining_time_h": (None, 10)})
        optimize(design, {"element.base_mm": (0.1, 5)}, objective=lambda r: r.rre.min(),
                 of=lambda d: rre(d, incidence_deg=[0, 10, 20]))

    objective: a quantity of retrace, or a function of a result. With a function, parameters must be
    pairs (minimum, maximum). The search then starts at the best of `scan` designs and uses at most
    `evaluations` designs (Nelder-Mead of scipy, or a compass search without scipy). of: function
    of a design that computes the result for the objective. quantities: additional quantities to
    compute. optimize, analysis, machining: tables of these names in a study file. Other arguments
    are those of sweep() and tolerance()."""
    count = thread_count(threads)
    flag("minimize", minimize)
    if _from_file(study, parameters):
        read, given = _core.Study.load(path("study", study)), overrides_of(changes or {})
        request = _request(given, seed, store, resume, overwrite)
        with teller(progress, "looking") as tell:
            return Optimum(_core.optimize(read, request, tell, count))
    design = design_of(study)
    if not isinstance(parameters, Mapping) or not parameters:
        raise refuse("parameters", 'a dict such as {"element.base_mm": (0.1, 5)}', parameters)
    if callable(objective):
        if not callable(of):
            raise refuse("of", "a function of a design", of)
        overrides_of({key: 0 for key in parameters})
        with teller(progress, "looking") as tell:
            return search(
                design,
                parameters,
                objective,
                of,
                minimize,
                whole("scan", scan, 2, 10000),
                whole("evaluations", evaluations, 1),
                tell,
            )
    limits = _constraints(constraints or {})
    wanted = [word("objective", objective), *(limit["quantity"] for limit in limits)]
    tables = _split(quantities)[0] if quantities else []
    named = {table.get("name", table.get("kind")) for table in tables}
    tables += [{"kind": kind} for kind in dict.fromkeys(wanted) if kind not in named]
    settings = _settings(
        optimize={("minimize" if minimize else "maximize"): objective, **(optimize or {})},
        analysis=analysis,
        machining=machining,
    )
    ranges = {
        key: {"from": float(values[0]), "to": float(values[1])}
        if isinstance(values, tuple) and len(values) == 2
        else values
        for key, values in parameters.items()
    }
    read, given = _study_of(design, ranges, tables, {**settings, "constraint": limits})
    request = _request(given, seed, store, resume, overwrite)
    with teller(progress, "looking") as tell:
        return Optimum(_core.optimize(read, request, tell, count), design)
