"""Progress of long computations."""

from __future__ import annotations

import contextlib
import importlib
import sys
from collections.abc import Callable, Iterator
from typing import Any, Union

from ._errors import InputError

#: None: no progress is shown. True: a progress bar, by tqdm if it is installed. Otherwise a
#: function, which is called with the completed fraction, 0 to 1.
Progress = Union[None, bool, Callable[[float], object]]


def _line(doing: str) -> Callable[[float], None]:
    """Shows the progress in one line of a terminal. Without a terminal, nothing is shown."""

    def tell(share: float) -> None:
        if sys.stderr.isatty():
            sys.stderr.write(f"\r{doing} {100 * share:3.0f} %" + ("\n" if share >= 1 else ""))
            sys.stderr.flush()

    return tell


@contextlib.contextmanager
def teller(progress: Progress, doing: str) -> Iterator[Callable[[float], object] | None]:
    """Yields the function to call with the completed fraction, or None."""
    if progress is None or progress is False:
        yield None
    elif callable(progress):
        yield progress
    elif progress is True:
        try:
            tqdm = importlib.import_module("tqdm.auto").tqdm
        except ImportError:
            yield _line(doing)
            return
        with tqdm(
            total=100,
            desc=doing,
            unit="%",
            leave=False,
            bar_format="{l_bar}{bar}| {elapsed}<{remaining}",
        ) as bar:

            def tell(share: float) -> Any:
                bar.update(100 * share - bar.n)

            yield tell
    else:
        raise InputError(
            "must be None, True or a function of the fraction that is done, got "
            f"a {type(progress).__name__}",
            key="progress",
        )
