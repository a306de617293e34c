"""Results of computations: JSON documents of the program, with their numbers as arrays."""

from __future__ import annotations

import functools
import html
import importlib
import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, ClassVar
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arguments import PathLike, nearest, path
from ._core import version
from ._errors import Error, InputError, OutputError

Array = NDArray[np.float64]

_VERDICTS = {
    "pass": "#dff0d8",
    "unconfirmed": "#fcf3cf",
    "undetermined": "#fcf3cf",
    "incomplete": "#fcf3cf",
    "fail": "#f8d7da",
}
_ELAPSED = re.compile(r'"elapsed_s": [^,\n]*')
_MOST_ROWS = 60  # maximum number of rows of a table in a notebook
_UNITS = {
    "deg": "degree",
    "arcmin": "arcmin",
    "mm": "mm",
    "um": "um",
    "nm": "nm",
    "m": "m",
    "mm2": "mm2",
    "cm2": "cm2",
    "mm3": "mm3",
    "h": "h",
    "s": "s",
    "percent": "percent",
    "lx": "lx",
    "cd": "cd",
}


# Current names of drawings, by their former names.
_FORMER_DRAWINGS = {"front": "entrance_surface"}


@functools.lru_cache(maxsize=None)
def former_names(kind: str) -> Mapping[str, str]:
    """Returns a dict from the former paths of renamed keys to their current names.

    kind: kind of the documents; "" for designs. In a path such as "regions[].active_share", only
    the last name ("active_share") is a former one. All names before it are current."""
    names = {}
    for of, former, current in _core.former_names():
        if of == kind and "=" not in current:
            parent, dot, name = current.rpartition(".")
            names[parent + dot + former.rpartition(".")[2]] = name
    return names


def names_within(names: Mapping[str, str], parent: str) -> Mapping[str, str]:
    """Selects the names whose paths begin with `parent`, such as "regions[].", and removes this
    beginning from the paths."""
    return {
        former[len(parent) :]: name for former, name in names.items() if former.startswith(parent)
    }


def warn_of_former(former: str, current: str) -> None:
    """Warns that a name has changed. The warning refers to the caller of the calling function."""
    warn(f"{former} is now called {current}", FutureWarning, stacklevel=3)


def needed(package: str, purpose: str) -> Any:
    """Imports an optional package."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise ImportError(
            f"{purpose} needs the package {package}, which is not installed "
            f"(Debian: python3-{package}; else: pip install {package})"
        ) from error


def unit_of(name: str) -> str:
    """Returns the unit at the end of a name, or "1" if there is none."""
    for most in (3, 2, 1):  # r_a_cd_per_lx_m2, psd_per_mm, base_mm
        tail = name.split("_")[-most:]
        if len(tail) == most > 1 and tail[0] == "per" and tail[1] in _UNITS:
            return "1/" + _UNITS[tail[1]]
        if most == 1 and tail[0] in _UNITS and tail[0] != name:
            if "_per_" in name:
                return name[name.rindex("_", 0, name.index("_per_")) + 1 :].replace("_per_", "/")
            return _UNITS[tail[0]]
    return "1"


def frozen(values: Any) -> Array:
    """Returns numbers as a read-only array."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def column_of(values: Sequence[Any], former: Mapping[str, str] | None = None) -> Any:
    """Converts the values of one key. Numbers become a float64 array in which missing values (None)
    are NaN. Tables become Columns. Other values are not changed.

    former: dict from former to current names of the keys of the tables"""
    there = [value for value in values if value is not None]
    if all(map(_is_number, there)):
        return frozen([np.nan if value is None else value for value in values])
    if all(isinstance(value, bool) for value in values):
        flags = np.array(values, dtype=np.bool_)
        flags.setflags(write=False)
        return flags
    if all(isinstance(value, dict) for value in there):
        return Columns([value or {} for value in values], former=former)
    if len(there) == len(values) and all(isinstance(value, list) for value in there):
        lengths = {len(value) for value in there}
        if len(lengths) == 1 and all(_is_number(one) for value in there for one in value):
            return frozen(there)
    column = np.empty(len(values), dtype=object)
    column[:] = [
        ("" if value is None else value) if all(isinstance(v, str) for v in there) else value
        for value in values
    ]
    column.setflags(write=False)
    return column


class Columns(Mapping[str, Any]):
    """Columns of a list of objects, one for each key. Columns of numbers are read-only float64
    arrays with NaN for missing values."""

    def __init__(
        self,
        rows: Sequence[Mapping[str, Any]],
        names: Sequence[str] = (),
        former: Mapping[str, str] | None = None,
    ) -> None:
        """names: columns that exist even if there are no rows. former: dict from former
        to current names."""
        #: Objects of the list, as in the JSON document.
        self.rows = rows
        self._names = list(dict.fromkeys([*names, *(name for row in rows for name in row)]))
        self._columns: dict[str, Any] = {}
        self._former = former or {}

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def _current(self, name: str) -> str:
        """Returns the current name of a column that has a former name, or an empty text."""
        current = self._former.get(name, "")
        return current if name not in self._names and current in self._names else ""

    def __getitem__(self, name: str) -> Any:
        if current := self._current(name):
            warn_of_former(name, current)
            name = current
        if name not in self._columns:
            if name not in self._names:
                raise KeyError(f"{name}{nearest(name, self._names)}")
            self._columns[name] = column_of(
                [row.get(name) for row in self.rows], names_within(self._former, name + ".")
            )
        return self._columns[name]

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        if current := self._current(name):
            warn_of_former(name, current)
            name = current
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(str(error.args[0])) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._names]

    def __repr__(self) -> str:
        return f"<{len(self.rows)} rows of {', '.join(self._names)}>"

    def _repr_html_(self) -> str:
        return html_table(self.rows)

    def flat(self, prefix: str = "") -> dict[str, Any]:
        """Returns all columns. The name of a column of an inner table is `table_key`, where
        `table` is the name of the inner table."""
        flat: dict[str, Any] = {}
        for name in self._names:
            column = self[name]
            if isinstance(column, Columns):
                flat.update(column.flat(f"{prefix}{name}_"))
            else:
                flat[prefix + name] = list(column) if column.ndim > 1 else column
        return flat

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with one row per object."""
        pandas = needed("pandas", "to_pandas()")
        return pandas.DataFrame(
            {
                name: np.array(column) if isinstance(column, np.ndarray) else column
                for name, column in self.flat().items()
            }
        )


def _cell(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def html_table(rows: Sequence[Mapping[str, Any]]) -> str:
    """Returns objects as an HTML table with coloured verdicts. Only numbers and texts are shown."""
    names = [
        name
        for name in dict.fromkeys(name for row in rows for name in row)
        if all(not isinstance(row.get(name), (dict, list)) for row in rows)
    ]
    lines = [
        "<table><thead><tr>",
        *(f"<th>{html.escape(name)}</th>" for name in names),
        "</tr></thead><tbody>",
    ]
    for row in rows[:_MOST_ROWS]:
        colour = _VERDICTS.get(str(row.get("verdict")), "")
        lines.append(f'<tr style="background:{colour};color:black">' if colour else "<tr>")
        lines += [
            f"<td>{html.escape(_cell(row[name])) if name in row else ''}</td>" for name in names
        ]
        lines.append("</tr>")
    lines.append("</tbody></table>")
    if len(rows) > _MOST_ROWS:
        lines.append(f"<p>{len(rows) - _MOST_ROWS} more rows</p>")
    return "".join(lines)


class Drawing:
    """A drawing of a result. It is drawn when it is first used."""

    def __init__(self, source: Any) -> None:
        self._source = source
        self._svg: str | None = None

    @property
    def svg(self) -> str:
        """The drawing as an SVG document; empty if it consists only of pixels."""
        if self._svg is None:
            self._svg = self._made().svg()
        return self._svg or ""

    def _made(self) -> Any:
        if self._source is None:
            raise Error(
                "this drawing is not available: it was not drawn before its result was pickled"
            )
        return self._source

    @property
    def png(self) -> bytes:
        """The drawing as a PNG file."""
        result: bytes = self._made().png()
        return result

    def save(self, file: PathLike) -> None:
        """Writes the drawing as SVG or PNG, depending on the ending of the file name."""
        name = path("file", file)
        write_file(name, self.png if name.lower().endswith(".png") else self.svg.encode())

    def __getstate__(self) -> dict[str, Any]:
        return {"_source": None, "_svg": self._svg}

    @property
    def is_there(self) -> bool:
        """True if the drawing is available. An unpickled result has only drawings made before."""
        return self._source is not None or self._svg is not None

    @property
    def is_made(self) -> bool:
        """True if the drawing was already made."""
        return self._svg is not None

    def _repr_svg_(self) -> str | None:
        return self.svg or None if self.is_there else None

    def _repr_png_(self) -> bytes | None:
        return self.png if self._source is not None and not self.svg else None

    def __repr__(self) -> str:
        return "<Drawing>"


class Drawings(dict[str, Drawing]):
    """Drawings by name. Former names give the same drawings, with a warning."""

    def __missing__(self, name: str) -> Drawing:
        current = _FORMER_DRAWINGS.get(name, "")
        if current not in self:
            raise KeyError(name)
        warn_of_former(name, current)
        return self[current]


def write_file(name: str, content: bytes) -> None:
    try:
        with open(name, "wb") as file:
            file.write(content)
    except OSError as error:
        raise OutputError(f"{name}: cannot be written: {error.strerror}") from error


class Result:
    """Base class of results. The keys of the JSON document are attributes of the result. If the
    document contains a list of objects, such as the points of a curve, the keys of these objects
    are also attributes. Such an attribute is a read-only array with one value per object, and NaN
    where the key is missing.
    """

    #: Key of a list of objects in the document. The keys of these objects are also attributes of
    #: the result.
    _rows: ClassVar[str] = ""
    #: Drawings that take long to make. Pages contain them only if they were made before.
    _costly: ClassVar[Sequence[str]] = ()
    #: Keys that the one-line description contains.
    _told: ClassVar[Sequence[str]] = ()

    json: str  #: JSON document, as the program prints it with --json
    table: str  #: text table, as the program prints it
    warnings: tuple[str, ...]  #: limitations of the result
    csv: str  #: one line per point; empty if there are no points
    drawings: dict[str, Drawing]  #: by name

    def __init__(
        self,
        core: Any = None,
        *,
        json: str = "",
        table: str = "",
        warnings: Sequence[str] = (),
        drawings: Mapping[str, Any] | None = None,
    ) -> None:
        self.json = core.json if core is not None else json
        self.table = core.table if core is not None else table
        self.warnings = tuple(core.warnings if core is not None else warnings)
        self.csv = getattr(core, "csv", "")
        self.drawings = Drawings(
            {name: Drawing(source) for name, source in (drawings or {}).items() if source}
        )

    @property
    def document(self) -> dict[str, Any]:
        """The JSON document as a dict."""
        document: dict[str, Any] | None = self.__dict__.get("_document")
        if document is None:
            document = self.__dict__["_document"] = json.loads(self.json)
        return document

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or "json" not in self.__dict__:
            raise AttributeError(name)
        document = self.document
        rows = self.__dict__.get("_columns")
        if rows is None and self._rows:
            rows = self.__dict__["_columns"] = Columns(
                document.get(self._rows, []),
                former=names_within(self._former_names(), self._rows + "[]."),
            )
        if name == self._rows:
            return rows
        if rows is not None and name in rows and name not in document:
            return rows[name]
        if name in document:
            return document[name]
        current = self._former_names().get(name, "")
        if current in document:
            warn_of_former(name, current)
            return document[current]
        if rows is not None and (current := rows._current(name)):
            warn_of_former(name, current)
            return rows[current]
        names = [*document, *(rows or ())]
        raise AttributeError(f"{type(self).__name__} has no {name}{nearest(name, names)}")

    def _former_names(self) -> Mapping[str, str]:
        """Returns the current names of renamed keys of the document."""
        schema = str(self.document.get("schema", ""))
        return former_names(schema.removeprefix("retrace.").partition("/")[0])

    def __dir__(self) -> list[str]:
        rows = getattr(self, self._rows) if self._rows else ()
        return sorted({*super().__dir__(), *self.document, *rows})

    def __getstate__(self) -> dict[str, Any]:
        return {
            name: value
            for name, value in self.__dict__.items()
            if name not in ("_document", "_columns")
        } | {"_version": version()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        made_by = str(state.pop("_version", "an unknown version"))
        # Before version 1.0, results of different minor versions may be incompatible.
        if made_by.split(".")[:2] != version().split(".")[:2]:
            raise InputError(
                f"was pickled by retrace {made_by}, but this is retrace {version()}; "
                "the document that save() writes can be read by every version",
                key=type(self).__name__,
            )
        self.__dict__.update(state)
        # The document may have the names of a former version.
        self.json = _core.current_document(self.json)
        self.drawings = Drawings(
            {_FORMER_DRAWINGS.get(name, name): one for name, one in self.drawings.items()}
        )

    def __eq__(self, other: object) -> bool:
        """Returns true if two results are equal, except for their computing times."""
        if not isinstance(other, type(self)):
            return NotImplemented
        return _ELAPSED.sub("", self.json) == _ELAPSED.sub("", other.json)

    __hash__ = None  # type: ignore[assignment]

    def save(self, file: PathLike) -> None:
        """Writes the JSON document."""
        write_file(path("file", file), self.json.encode())

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with one row per point. attrs contains seed, version, etc."""
        if not self._rows:
            raise Error(f"{type(self).__name__} has no list of points")
        frame = getattr(self, self._rows).to_pandas()
        frame.attrs.update(self._attributes())
        return frame

    def _attributes(self) -> dict[str, Any]:
        """Returns the texts and numbers that apply to the whole result."""
        return {
            name: value
            for name, value in self.document.items()
            if isinstance(value, (str, int, float)) and name not in ("elapsed_s",)
        }

    def _summary(self) -> str:
        """Returns the keys and values of the one-line description."""
        parts = []
        for name in self._told:
            value = getattr(self, name, None)
            if isinstance(value, np.ndarray):
                if value.size:
                    low, high = np.nanmin(value), np.nanmax(value)
                    parts.append(f"{name} {low:.6g}" + (f" to {high:.6g}" if high > low else ""))
            elif value is not None:
                parts.append(f"{name} {_cell(value)}")
        return ", ".join(parts)

    def __repr__(self) -> str:
        parts = [self._summary()]
        if self.warnings:
            parts.append(f"{len(self.warnings)} warning{'s' if len(self.warnings) > 1 else ''}")
        return f"<{type(self).__name__}: {', '.join(part for part in parts if part)}>"

    def _shown_drawing(self, *names: str) -> str | None:
        """Returns the first of these drawings that is available, as SVG."""
        for name in names:
            if name in self.drawings and self.drawings[name].is_there and self.drawings[name].svg:
                return self.drawings[name].svg
        return None

    def _repr_html_(self) -> str | None:
        return None if self._repr_svg_() else f"<pre>{html.escape(self.table)}</pre>"

    def _repr_svg_(self) -> str | None:
        return None


def dataset_of(
    columns: Columns,
    dims: Sequence[str],
    attributes: Mapping[str, Any],
    exclude: Callable[[str], bool] = lambda name: False,
) -> Any:
    """Returns an xarray.Dataset. Its dimensions are the columns `dims`, and its coordinates are the
    distinct values of these columns. A dimension with a single value is kept."""
    xarray = needed("xarray", "to_xarray()")
    flat = columns.flat()
    coordinates = {dim: list(dict.fromkeys(np.asarray(flat[dim]).tolist())) for dim in dims}
    places = tuple(
        np.array(
            [
                {value: k for k, value in enumerate(coordinates[dim])}[one]
                for one in np.asarray(flat[dim]).tolist()
            ],
            dtype=int,
        )
        for dim in dims
    )
    shape = tuple(len(coordinates[dim]) for dim in dims)
    dataset = xarray.Dataset(
        coords={dim: (dim, values, {"units": unit_of(dim)}) for dim, values in coordinates.items()},
        attrs=dict(attributes),
    )
    for name, column in flat.items():
        if name in dims or exclude(name) or not isinstance(column, np.ndarray):
            continue
        if column.dtype == np.float64:
            values = np.full(shape, np.nan)
        elif column.dtype == np.bool_:
            values = np.zeros(shape, dtype=np.bool_)
        else:
            values = np.full(shape, "", dtype=object)
        values[places] = column
        dataset[name] = (tuple(dims), values, {"units": unit_of(name)})
    return dataset
