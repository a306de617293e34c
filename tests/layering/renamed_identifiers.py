"""Tests that former identifiers of C++ do not come back.

tests/data/renamed_identifiers.csv contains the former and the current names. A former name that no
declaration has any more must not occur in the code of any C++ file. Comments and strings are not
checked.
"""

import csv
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[2]
TABLE = ROOT / "tests/data/renamed_identifiers.csv"
TOKEN = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'|#include[^\n]*|[A-Za-z_]\w*',
    re.DOTALL,
)


def former_names() -> dict[str, str]:
    with TABLE.open(encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        return {row["former"].split("::")[-1]: row["current"] for row in rows if row["gone"] == "yes"}


def main() -> int:
    names = former_names()
    assert len(names) > 500, "the table is not complete"
    folders = [folder for folder in ROOT.iterdir() if folder.is_dir() and folder.name[0] != "." and folder.name != "build"]
    faults = 0
    for folder in folders:
        for path in sorted([*folder.rglob("*.h"), *folder.rglob("*.cpp")]):
            if "node_modules" in path.parts:
                continue
            text = path.read_text(encoding="utf-8")
            for found in TOKEN.finditer(text):
                if found[0] in names:
                    line = text.count("\n", 0, found.start()) + 1
                    print(f"{path.relative_to(ROOT)}:{line}: {found[0]} is the former name of {names[found[0]]}")
                    faults += 1
    return 1 if faults else 0


sys.exit(main())
