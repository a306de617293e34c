"""Designs: arrays of retroreflectors, described by design files (docs/design_file.md)."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _core
from ._arguments import PathLike, path, refuse, shown
from ._errors import InputError
from ._results import former_names, warn_of_former

if TYPE_CHECKING:
    from . import files

__all__ = ["Design"]

_DEEPEST = 16  # maximum depth of nested lists and dicts
_IN_MEMORY = "Design(...)"  # file name in messages about designs in memory


def _key(name: object) -> str:
    if not isinstance(name, str):
        raise InputError(f"keys must be texts, got {shown(name)}")
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else _text(name)


def _text(value: str) -> str:
    """Returns a text as a basic string of TOML."""
    if any(0xD800 <= ord(c) <= 0xDFFF for c in value):
        raise InputError(f"texts must be Unicode, got {shown(value)}")
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def toml_value(name: str, value: object, depth: int = 0) -> str:
    """Returns a value as TOML. name: name of the value for messages."""
    allowed = "a number, a text, True, False, or a list or dict of these"
    if depth > _DEEPEST:
        raise InputError(f"lists and dicts may be nested at most {_DEEPEST} deep", key=name)
    if isinstance(value, (np.generic, np.ndarray)):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        if not -(2**63) <= value < 2**63:
            raise refuse(name, "a number", value)
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise refuse(name, "a finite number", value)
        return repr(float(value))
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        items = (
            f"{_key(key)} = {toml_value(f'{name}.{key}', one, depth + 1)}"
            for key, one in value.items()
        )
        return "{" + ", ".join(items) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(name, one, depth + 1) for one in value) + "]"
    if hasattr(value, "__fspath__"):
        return _text(path(name, value))
    raise refuse(name, allowed, value)


def toml_text(tables: Mapping[str, object]) -> str:
    """Returns a TOML file with these keys and tables."""
    plain, sections = [], []
    for key, value in tables.items():
        if isinstance(value, Mapping):
            lines = [
                f"{_key(inner)} = {toml_value(f'{key}.{inner}', one)}"
                for inner, one in value.items()
            ]
            sections += ["", f"[{_key(key)}]", *lines]
        elif (
            isinstance(value, (list, tuple))
            and value
            and all(isinstance(v, Mapping) for v in value)
        ):
            for table in value:
                sections += ["", f"[[{_key(key)}]]"]
                sections += [
                    f"{_key(inner)} = {toml_value(f'{key}.{inner}', one)}"
                    for inner, one in table.items()
                ]
        else:
            plain.append(f"{_key(key)} = {toml_value(key, value)}")
    return "\n".join(plain + sections) + "\n"


def overrides_of(changes: Mapping[str, object]) -> list[str]:
    """Returns the changes as arguments of --set: "key=value", or "key=" if the value is None."""
    if not isinstance(changes, Mapping):
        raise refuse("changes", 'a dict such as {"element.base_mm": 0.5}', changes)
    for key in changes:
        if not isinstance(key, str) or not re.fullmatch(r"[A-Za-z0-9_.\[\]-]+", key):
            raise InputError(f'keys must be such as "element.base_mm", got {shown(key)}')
    return [
        f"{key}=" if value is None else f"{key}={toml_value(key, value)}"
        for key, value in changes.items()
    ]


class Design:
    """A design that was read and checked, with all defaults filled in. It is immutable.

        Design.load("honeycomb.toml").replace({"element.aperture_mm": 0.5})
        Design(element={"kind": "rtp", "base_mm": 2}, body={"thickness_mm": 2})

    The keys are those of design files (docs/design_file.md). The module retrace.files contains them
    as TypedDicts. If a design was loaded from a file, relative names of other files refer to the
    folder of this file. Otherwise, they refer to the working directory.
    """

    __slots__ = ("_core", "_keeps")

    def __init__(self, **tables: Any) -> None:
        text = toml_text({"schema": "retrace.design/1", **tables})
        try:
            self._core = _core.Design.parse(text, _IN_MEMORY, [])
        except InputError as error:
            raise _without_place(error) from None
        self._keeps: object = None  # object that must live as long as the design

    @classmethod
    def from_dict(cls, tables: files.Design) -> Design:
        """Makes a design from a dict. Type checkers can check the keys of this dict."""
        if not isinstance(tables, Mapping):
            raise refuse("tables", "a dict of tables", tables)
        for key in tables:
            _key(key)
        return cls(**tables)

    @classmethod
    def load(cls, file: PathLike, changes: Mapping[str, object] | None = None) -> Design:
        """Reads a design file. changes: values of keys that take precedence over the file."""
        return cls._of(_core.Design.load(path("file", file), overrides_of(changes or {})))

    @classmethod
    def parse(
        cls, text: str, source: str = "design", changes: Mapping[str, object] | None = None
    ) -> Design:
        """Reads the text of a design file. source: file name that is used in messages."""
        if not isinstance(text, str):
            raise refuse("text", "a text", text)
        return cls._of(
            _core.Design.parse(text, path("source", source), overrides_of(changes or {}))
        )

    def replace(self, changes: Mapping[str, object]) -> Design:
        """Returns a copy of the design with changed keys. The value None unsets a key."""
        try:
            return self._of(self._core.replaced(overrides_of(changes)), self._keeps)
        except InputError as error:
            raise (_without_place(error) if self.source == _IN_MEMORY else error) from None

    @classmethod
    def _of(cls, core: _core.Design, keeps: object = None) -> Design:
        design = cls.__new__(cls)
        design._core = core
        design._keeps = keeps
        return design

    @classmethod
    def _restored(cls, text: str, source: str, overrides: list[str]) -> Design:
        return cls._of(_core.Design.parse(text, source, overrides))

    def __reduce__(self) -> tuple[Any, tuple[str, str, list[str]]]:
        return Design._restored, (self.text, self.source, self._core.overrides)

    @property
    def title(self) -> str:
        """Title of the design, or an empty text."""
        return self._core.title

    @property
    def source(self) -> str:
        """Name of the design file. Without a file, the text that replaces the name in messages."""
        return self._core.source

    @property
    def text(self) -> str:
        """Text of the design file as it was read, without changes."""
        return self._core.text

    @property
    def files(self) -> list[str]:
        """All files to which the design refers."""
        return [str(file) for file in self._core.files]

    @property
    def warnings(self) -> list[str]:
        """One warning for each key that has no effect because another key takes precedence."""
        return self._core.warnings

    @property
    def json(self) -> str:
        """Keys and values of the design as JSON, in the form that is used in results."""
        return self._core.json()

    @property
    def document(self) -> dict[str, Any]:
        """Keys and values of the design as a dict."""
        result: dict[str, Any] = json.loads(self.json)
        return result

    def __getitem__(self, key: str) -> Any:
        """Returns the value of a key such as "element.base_mm", or its default."""
        value: Any = self.document
        parent = ""
        for part in key.split("."):
            if not isinstance(value, dict):
                raise KeyError(key)
            current = part if part in value else former_names("").get(parent + part, "")
            if current not in value:
                raise KeyError(key)
            if current != part:
                warn_of_former(parent + part, parent + current)
            value = value[current]
            parent += current + "."
        return value

    def _identity(self) -> tuple[str, str, tuple[str, ...]]:
        return self.text, self.source, tuple(self._core.overrides)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Design):
            return NotImplemented
        return self._identity() == other._identity()

    def __hash__(self) -> int:
        return hash(self._identity())

    def __repr__(self) -> str:
        quoted = self.document
        kind = quoted.get("element", {}).get("kind", "part")
        arrangement = quoted.get("array", {}).get("arrangement", "")
        return (
            f"<Design {shown(self.title or self.source)}: {' '.join((kind, arrangement)).strip()}>"
        )

    def _repr_svg_(self) -> str | None:
        """Returns the plan of the design as SVG, which notebooks display."""
        try:
            return _core.inspect(self._core, _core.InspectRequest()).plan.svg() or None
        except (InputError, OSError):
            return None


def _without_place(error: InputError) -> InputError:
    return InputError(error.message, key=error.key) if error.file == _IN_MEMORY else error


#: A design, or the name of its file.
AnyDesign = Union[Design, PathLike]


def design_of(value: object) -> Design:
    """Returns the given design, or reads it if the name of its file is given."""
    if isinstance(value, Design):
        return value
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return Design.load(path("design", value))
    raise refuse("design", "a Design or the name of its file", value)


def designs_of(value: object) -> Sequence[Design]:
    if isinstance(value, (list, tuple)):
        if not value:
            raise InputError("must be one or more, got none", key="designs")
        return [design_of(one) for one in value]
    return [design_of(value)]
