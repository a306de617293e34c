"""Reports: several results on one HTML page."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Union

from . import _core
from ._arguments import PathLike, path, refuse
from ._light import RreResult
from ._results import Result, write_file

__all__ = ["Page", "report"]


class Page:
    """A self-contained HTML page."""

    def __init__(self, html: str, warnings: Sequence[str]) -> None:
        self.html = html
        self.warnings = tuple(warnings)

    def save(self, file: PathLike) -> None:
        write_file(path("file", file), self.html.encode())

    def __repr__(self) -> str:
        return f"<Page: {len(self.html) // 1024} KiB>"


def _parts(result: Result, number: int) -> list[tuple[str, Union[str, bytes]]]:
    """Returns the names and contents of the files in which a result would be saved."""
    behind = "" if number == 1 else f"_{number}"
    kind = str(result.document.get("schema", "")).removeprefix("retrace.").partition("/")[0]
    parts: list[tuple[str, Union[str, bytes]]] = [(f"{kind}{behind}.json", result.json)]
    for name, drawing in result.drawings.items():
        if drawing.is_there and (drawing.is_made or name not in result._costly):
            content: Union[str, bytes] = drawing.svg or drawing.png
            parts.append((f"{name}{behind}.{'svg' if drawing.svg else 'png'}", content))
    if isinstance(result, RreResult) and result.footprint is not None:
        parts.append((f"footprint{behind}.json", result.footprint.json))
    return [part for part in parts if part[1]]


def report(
    results: Union[Result, Sequence[Result]],
    file: PathLike | None = None,
    *,
    title: str = "",
    read: Sequence[PathLike] = (),
) -> Page:
    """Makes one self-contained HTML page of results, like the command `retrace report`. Writes the
    page if a file is given.

    title: title of the page [title of the design]
    read: files and folders that may be read, such as the mesh of a design; other files are not
    read"""
    listed = [results] if isinstance(results, Result) else results
    if not isinstance(listed, (list, tuple)) or not all(isinstance(one, Result) for one in listed):
        raise refuse("results", "a result or a list of results", results)
    if not isinstance(title, str):
        raise refuse("title", "a text", title)
    parts: list[tuple[str, Union[str, bytes]]] = []
    taken: set[str] = set()
    for result in listed:
        number = 1
        while any(os.path.splitext(name)[0] in taken for name, _ in _parts(result, number)[:1]):
            number += 1
        parts += [
            part for part in _parts(result, number) if part[0] not in {name for name, _ in parts}
        ]
        taken.update(os.path.splitext(name)[0] for name, _ in parts)
    if not isinstance(read, (list, tuple)):
        raise refuse("read", "a list of paths", read)
    page = Page(*_core.report_page(parts, title, [path("read", one) for one in read]))
    if file is not None:
        page.save(file)
    return page
