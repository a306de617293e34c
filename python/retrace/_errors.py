"""Errors. Each has one line of text."""

from __future__ import annotations

__all__ = ["BudgetError", "Error", "InputError", "OutputError"]


class Error(Exception):
    """Base class of the errors that retrace raises intentionally."""


class InputError(Error, ValueError):
    """An invalid input: a file or an argument. In the latter case, key is the argument."""

    def __init__(
        self, message: str, file: str | None = None, line: int | None = None, key: str | None = None
    ) -> None:
        #: What is wrong and what is allowed, without file and line.
        self.message = message
        # The library reports an error in a dict of changes as an error in the file "--set". In
        # Python there is no such file.
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
    """A file that cannot be written."""


class BudgetError(Error, RuntimeError):
    """A limit on time, memory or accuracy was reached before the result was complete."""
