"""Exceptions of retrace. Each message consists of one line."""

from __future__ import annotations

__all__ = ["BudgetError", "Error", "InputError", "OutputError"]


class Error(Exception):
    """Base class of the errors that retrace raises intentionally."""


class InputError(Error, ValueError):
    """Raised for an invalid file or argument. For an argument, `key` is its name."""

    def __init__(
        self, message: str, file: str | None = None, line: int | None = None, key: str | None = None
    ) -> None:
        #: Description of the error and the allowed values, without file and line.
        self.message = message
        # For an error in a dict of changes, the library reports a file name that begins with
        # "--set ". There is no such file, so the name is removed.
        changed = (file or "").startswith("--set ")
        self.file = None if changed else file or None  #: file that contains the error, or None
        self.line = line or None  #: line of this file, counted from 1
        #: Key of the file, such as "element.base_mm", or name of the argument.
        self.key = key or None
        place = ":".join(str(part) for part in (self.file, self.line) if part is not None)
        super().__init__(": ".join(part for part in (place, self.key, self.message) if part))

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str | None, int | None, str | None]]:
        return type(self), (self.message, self.file, self.line, self.key)


class OutputError(Error, OSError):
    """Raised if a file cannot be written."""


class BudgetError(Error, RuntimeError):
    """Raised if a limit on time, memory or accuracy is reached before the result is complete."""
