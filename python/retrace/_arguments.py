"""Checks arguments. Every message names the argument and the allowed values."""

from __future__ import annotations

import difflib
import functools
import inspect
import math
import numbers
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import ParamSpec, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike

from ._errors import InputError

PathLike = Union[str, "os.PathLike[str]"]
Numbers = ArrayLike  #: a number, or a list or an array of numbers

_P = ParamSpec("_P")
_R = TypeVar("_R")
_SHOWN = 60  # maximum number of characters of a value in messages


def shown(value: object) -> str:
    """Returns a value as text for messages."""
    try:
        text = repr(value).replace("\n", " ")
    except Exception:  # repr() of a foreign class may raise anything
        text = f"a {type(value).__name__}"
    return text if len(text) <= _SHOWN else text[:_SHOWN] + "..."


def refuse(name: str, allowed: str, value: object) -> InputError:
    return InputError(f"must be {allowed}, got {shown(value)}", key=name)


def nearest(word: object, words: Iterable[str]) -> str:
    """Returns a suggestion for a misspelt word, as the end of a message."""
    close = difflib.get_close_matches(str(word), list(words), n=1, cutoff=0.6)
    return f"; did you mean {close[0]}?" if close else ""


def real(name: str, allowed: str, value: object) -> numbers.Real:
    """Checks that a value is a real number."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Real):
        raise refuse(name, allowed, value)
    return value


def number(
    name: str,
    value: object,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    low_included: bool = True,
    high_included: bool = True,
) -> float:
    """Checks that a value is a finite number in a range."""
    allowed = "a number"
    if low > -math.inf:
        allowed += f" {'>=' if low_included else '>'} {low:g}"
    if high < math.inf:
        allowed += f"{' and' if low > -math.inf else ''} {'<=' if high_included else '<'} {high:g}"
    value = real(name, allowed, value)
    try:
        result = float(value)
    except OverflowError:
        raise refuse(name, allowed, value) from None
    inside = (result > low or (low_included and result == low)) and (
        result < high or (high_included and result == high)
    )
    if not math.isfinite(result) or not inside:
        raise refuse(name, allowed, value)
    return result


def whole(name: str, value: object, low: int = 0, high: int = 2**36) -> int:
    """Checks that a value is a whole number in a range."""
    allowed = f"a whole number from {low} to {high}"
    value = real(name, allowed, value)
    if not math.isfinite(value) or value != int(value) or not low <= int(value) <= high:
        raise refuse(name, allowed, value)
    return int(value)


def number_list(
    name: str,
    values: object,
    low: float = -math.inf,
    high: float = math.inf,
    *,
    included: bool = True,
    may_be_empty: bool = False,
) -> list[float]:
    """Converts one number, a list of numbers or a one-dimensional array to a list."""
    allowed = "a number or a list of numbers"
    if isinstance(values, (str, bytes, Mapping)):
        raise refuse(name, allowed, values)
    try:
        array = np.asarray(values)
    except Exception:  # __array__() of a foreign class may raise anything
        raise refuse(name, allowed, values) from None
    if array.dtype == object and array.ndim <= 1:
        items = array.tolist() if array.ndim else [array.item()]
        return [
            number(name, item, low, high, low_included=included, high_included=included)
            for item in items
        ]
    if array.dtype.kind not in "iuf" and array.size:
        raise refuse(name, allowed, values)
    if array.ndim > 1:
        raise InputError(f"must be {allowed}, got an array of shape {array.shape}", key=name)
    result: list[float] = array.astype(float).reshape(-1).tolist()
    if not result and not may_be_empty:
        raise InputError("must be one number or more, got none", key=name)
    for value in result:
        number(name, value, low, high, low_included=included, high_included=included)
    return result


def pairs(name: str, values: object) -> list[tuple[float, float]]:
    """Checks pairs of numbers. In each pair, the smaller number must be first."""
    if isinstance(values, (str, bytes, Mapping)) or not isinstance(values, Iterable):
        raise refuse(name, "a list of pairs (from, to)", values)
    result = []
    for pair in values:
        ends = number_list(name, pair)
        if len(ends) != 2 or not ends[0] < ends[1]:
            raise refuse(name, "a list of pairs (from, to)", pair)
        result.append((ends[0], ends[1]))
    return result


def word(name: str, value: object, words: Sequence[str] = ()) -> str:
    """Checks that a value is a non-empty text. If words are given, the value must be one of
    them."""
    allowed = ", ".join(words) if words else "a text"
    if not isinstance(value, str) or not value:
        raise refuse(name, allowed, value)
    if words and value not in words:
        raise InputError(f"must be {allowed}, got {shown(value)}{nearest(value, words)}", key=name)
    return value


def flag(name: str, value: object) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise refuse(name, "True or False", value)
    return bool(value)


def path(name: str, value: object) -> str:
    """Converts the name of a file (str or os.PathLike) to a str."""
    if not isinstance(value, (str, os.PathLike)):
        raise refuse(name, "the name of a file", value)
    text = os.fspath(value)
    if not isinstance(text, str) or not text or "\0" in text:
        raise refuse(name, "the name of a file", value)
    return text


def thread_count(value: object) -> int:
    """Converts the argument `threads`. None becomes 0, which means one thread per core."""
    return 0 if value is None else whole("threads", value, 1, 4096)


def former_keywords() -> Mapping[str, str]:
    """Returns a dict from keywords of former versions to the keywords that replace them."""
    from ._fields import FORMER  # imported here, because _fields imports this module

    return FORMER


def checked(meanings: Mapping[str, str]) -> Callable[[Callable[_P, _R]], Callable[_P, _R]]:
    """Returns a decorator for functions with keywords.

    The meanings of the keywords are appended to the docstring. If the function is called with a
    former keyword, the current keyword is used and a warning is given. If it is called with an
    unknown keyword, the error message suggests the most similar keyword."""

    def wrap(function: Callable[_P, _R]) -> Callable[_P, _R]:
        keywords = list(inspect.signature(function).parameters)
        lines = [f"    {word}: {meanings[word]}" for word in keywords if word in meanings]
        if lines:
            function.__doc__ = (function.__doc__ or "").rstrip() + "\n\n" + "\n".join(lines) + "\n"

        @functools.wraps(function)
        def call(*args: _P.args, **kwargs: _P.kwargs) -> _R:
            for keyword in list(kwargs):
                if keyword not in keywords:
                    current = former_keywords().get(keyword)
                    if current in keywords and current not in kwargs:
                        warnings.warn(
                            f"{function.__name__}(): {keyword} is the former name of {current}",
                            FutureWarning,
                            stacklevel=2,
                        )
                        kwargs[current] = kwargs.pop(keyword)
                        continue
                    raise TypeError(
                        f"{function.__name__}() has no keyword {keyword}"
                        f"{nearest(keyword, keywords)}"
                    )
            return function(*args, **kwargs)

        return call

    return wrap
