"""Progress of long computations."""

from __future__ import annotations

import contextlib
import importlib
import sys
from collections.abc import Callable, Iterator
from typing import Any, Union

from ._errors import InputError

#: Display of the progress. None or False: nothing is shown. True: a progress bar is shown, with
#: tqdm if it is installed. Function: it is called with the completed fraction, 0 to 1.
Progress = Union[None, bool, Callable[[float], object]]


def _line(doing: str) -> Callable[[float], None]:
    """Returns a function that shows the progress in one line. Without a terminal, it does
    nothing."""

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
