"""Errors. Each has one line of text."""

from __future__ import annotations

import re

__all__ = ["BudgetError", "Error", "InputError", "OutputError"]

# Keywords whose option of the command line has a different name.
_KEYWORDS = {
    "incidence": "incidence_deg",
    "azimuth": "azimuth_deg",
    "class": "class_",
    "rotation": "rotation_deg",
    "pixel-um": "pixel_um",
    "road-distance-m": "distance_m",
    "no-diffraction": "diffraction",
    "no-advice": "advice",
}

# Keywords whose field of the library has a different name.
_FIELDS = {"part_class": "class_"}


def _keyword(option: str) -> str:
    """Returns the keyword of an option, such as target_error for --target-error."""
    name = option.removeprefix("--")
    return _KEYWORDS.get(name, name.replace("-", "_"))


class Error(Exception):
    """Base class of the errors that retrace raises intentionally."""


class InputError(Error, ValueError):
    """An invalid input: a file or an argument. In the latter case, key is the argument."""

    def __init__(
        self, message: str, file: str | None = None, line: int | None = None, key: str | None = None
    ) -> None:
        #: What is wrong and what is allowed, without file and line.
        self.message = re.sub(r"--[a-z][a-z-]+", lambda option: _keyword(option[0]), message)
        # The library reports an error in a dict of changes as an error in the file "--set". In
        # Python there is no such file.
        changed = (file or "").startswith("--set ")
        self.file = None if changed else file or None  #: file that contains the error, or None
        self.line = line or None  #: line of this file, counted from 1
        #: Key of the file, such as "element.base_mm", or name of the argument.
        self.key = None
        if key:
            self.key = _keyword(key) if key.startswith("--") else _FIELDS.get(key, key)
        place = ":".join(str(part) for part in (self.file, self.line) if part is not None)
        super().__init__(": ".join(part for part in (place, self.key, self.message) if part))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str | None, int | None, str | None]]:
        return type(self), (self.message, self.file, self.line, self.key)


class OutputError(Error, OSError):
    """A file that cannot be written."""


class BudgetError(Error, RuntimeError):
    """A limit on time, memory or accuracy was reached before the result was complete."""
