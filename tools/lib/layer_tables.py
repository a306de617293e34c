"""Writes the order of folders and rooms (subfolders) into documents. The order is that of tests/layering/layers.json.

    python3 layer_tables.py [--check]

A table between the marks `<!-- order of NAME -->` and `<!-- end -->` gets a row for each folder (NAME: folders) or for
each room of the folder NAME, from the lowest to the highest. Its last column lists what the folder or room may include.
The columns between the first and the last are kept. Between the marks `<!-- picture of folders -->` and `<!-- end -->`,
the folders are listed by layer. With --check, no file is written: the names of files whose texts would change are
printed, and the exit code is 1 if there are any.
"""

import json
import re
import sys

from written_texts import ROOT, write_or_check

FOLDERS = ("geometry", "raytrace", "fabrication")
DOCUMENTS = ["CONVENTIONS.md", "docs/architecture.md", *(f"{folder}/README.md" for folder in FOLDERS)]
MARKED = re.compile(r"(<!-- (order|picture) of (\w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def table(text: str, order: dict[str, list[str]]) -> str:
    """Returns the table with its rows in the given order and its last column replaced."""
    head, rule, *rows = text.strip().splitlines()
    kept = {cells[1].strip(): cells[2:-2] for cells in (row.split("|") for row in rows)}
    empty = ["  "] * (head.count("|") - 3)
    lines = [head, rule]
    for name, lower in order.items():
        cells = [f" `{name}/` ", *kept.get(f"`{name}/`", empty), f" {', '.join(lower) or '-'} "]
        lines.append(f"|{'|'.join(cells)}|")
    return "\n".join(lines) + "\n"


def picture(folders: dict[str, list[str]]) -> str:
    """Returns a line for each folder, the highest layer first: number of the layer, name, and what it may include."""
    floors: dict[str, int] = {}
    for folder, lower in folders.items():
        floors[folder] = max((floors[other] + 1 for other in lower), default=0)
    width = max(map(len, folders)) + 2
    lines = [
        f"{floors[folder]}  {folder:{width}}{', '.join(folders[folder]) or '-'}"
        for folder in sorted(folders, key=lambda folder: (-floors[folder], folder))
    ]
    return "\n".join(["```text", *lines, "```", ""])


def with_order(page: str, layers: dict) -> str:
    def replaced(found: re.Match) -> str:
        is_picture, name, text = found[2] == "picture", found[3], found[4]
        order = layers["folders"] if name == "folders" else layers["rooms"][name]
        return found[1] + (picture(order) if is_picture else table(text, order)) + found[5]

    return MARKED.sub(replaced, page)


def main() -> int:
    layers = json.loads((ROOT / "tests/layering/layers.json").read_text(encoding="utf-8"))
    texts = {}
    for name in DOCUMENTS:
        text = (ROOT / name).read_text(encoding="utf-8")
        if not MARKED.search(text):
            sys.exit(f"{name}: no mark of a table")
        texts[ROOT / name] = with_order(text, layers)
    return write_or_check(texts, "tests/layering/layers.json", "--check" in sys.argv[1:])


sys.exit(main())
