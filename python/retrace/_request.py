"""Converts the keywords of a function to the fields of a request of the library."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, ParamSpec, TypeVar

from ._arguments import checked, flag, number, number_list, pairs, path, refuse, whole, word

_P = ParamSpec("_P")
_R = TypeVar("_R")
_MOST = 2**53  # largest whole number below which a double represents all whole numbers


class Field(NamedTuple):
    """A field of a request, as the library describes it."""

    name: str  #: name in the library
    kind: str  #: kind of the value, such as "number" or "word"
    allowed: str  #: allowed values
    default: object
    meaning: str


#: Dict from the keywords of a Python function to the fields of a request.
Fields = dict[str, Field]


def _whole(keyword: str, value: object, field: Field) -> int:
    if isinstance(value, str):
        raise refuse(keyword, field.allowed, value)
    return whole(keyword, value, -_MOST, _MOST)


def _converted(keyword: str, value: object, field: Field) -> object:
    """Converts a value to the type that the library requires. The library checks the range."""
    if field.kind == "number":
        return number(keyword, value)
    if field.kind == "whole":
        return _whole(keyword, value, field)
    if field.kind == "flag":
        return flag(keyword, value)
    if field.kind in ("file", "word_or_file"):
        return path(keyword, value)
    if field.kind in ("number_or_numbers", "numbers"):
        return number_list(keyword, value, may_be_empty=True)
    if field.kind == "number_rows":
        return [list(pair) for pair in pairs(keyword, value)]
    if field.kind == "texts":
        if isinstance(value, (list, tuple)) and all(isinstance(text, str) for text in value):
            return list(value)
        raise refuse(keyword, field.allowed, value)
    return word(keyword, value)


def given(request: Any, fields: Fields, **values: object) -> Any:
    """Sets the fields of a request whose values differ from their defaults."""
    for keyword, value in values.items():
        field = fields[keyword]
        if value is field.default or (
            type(value) is type(field.default) and value == field.default
        ):
            continue
        request.assign(field.name, _converted(keyword, value, field))
    return request


def with_values(
    request: Any, fields: Fields, name: str, lists: Mapping[str, object] | None
) -> list[Any]:
    """Returns a copy of a request for each value of a list, or only the request if `lists` is None.

    name: name of the argument `lists` in messages
    lists: a dict with one item: a keyword whose field is a number, and the list of its values"""
    if lists is None:
        return [request]
    numeric = [keyword for keyword, field in fields.items() if field.kind == "number"]
    allowed = f"a dict of one keyword with its values, such as {{{numeric[0]!r}: [1, 2]}}"
    if not isinstance(lists, Mapping) or len(lists) != 1 or next(iter(lists)) not in numeric:
        raise refuse(name, allowed, lists)
    keyword, values = next(iter(lists.items()))
    requests = []
    for value in number_list(keyword, values):
        requests.append(request.copy())
        requests[-1].assign(fields[keyword].name, value)
    return requests


def described(fields: Fields) -> Callable[[Callable[_P, _R]], Callable[_P, _R]]:
    """Decorates a function whose keywords are the fields of a request, see checked()."""
    return checked({keyword: field.meaning for keyword, field in fields.items()})
