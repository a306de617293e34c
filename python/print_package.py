"""Writes the generated files of the Python package, from the program's JSON Schemas and descriptions
of requests.

    python3 print_package.py PROGRAM FOLDER SOURCES...

FOLDER/files.py contains a TypedDict for each table of designs, jobs, studies and so on.
FOLDER/_fields.py contains the fields of each request of the library.
SOURCES are Python files that are copied to FOLDER. In the copies, three kinds of lines are replaced
by code for the request NAME:
    # generated: keywords of the request NAME
        Replaced by one keyword per field. The function also has other keywords.
    **fields: object,  # generated: keywords of the request NAME
        Replaced by one keyword per field. The function has no other keywords.
    request = _core.X()  # generated: sets the fields of the request NAME
        Replaced by code that creates a request and sets its fields to the values of the keywords.
"""

import json
import pathlib
import re
import subprocess
import sys

FORMATS = {
    "design": "Design",
    "job": "Job",
    "study": "Study",
    "machine": "Machine",
    "process": "Process",
}
LINE = 100


def said(program: str, *arguments: str) -> str:
    return subprocess.run(
        [program, *arguments], check=True, capture_output=True, text=True, timeout=60
    ).stdout


def schemas_in(schema, path: tuple[str, ...] = ()):
    """Yields (path, schema) for each key, including keys that exist only under conditions."""
    if isinstance(schema, list):
        for one in schema:
            yield from schemas_in(one, path)
    if not isinstance(schema, dict):
        return
    for key, inner in schema.get("properties", {}).items():
        if isinstance(inner, dict) and not inner.get("deprecated"):
            yield path + (key,), inner
            yield from schemas_in(inner, path + (key,))
    for word in ("allOf", "anyOf", "oneOf", "then", "else"):
        yield from schemas_in(schema.get(word, []), path)
    if isinstance(schema.get("items"), dict):
        yield from schemas_in(schema["items"], path)


def types_of(schema: dict) -> set[str]:
    """Returns the Python types that a schema allows for a value."""
    if "enum" in schema:
        return {f"Literal[{', '.join(map(repr, schema['enum']))}]"}
    if "const" in schema:
        return {f"Literal[{schema['const']!r}]"}
    types: set[str] = set()
    for word in ("anyOf", "oneOf"):
        for inner in schema.get(word, []):
            types |= types_of(inner)
    kinds = schema.get("type", [])
    for kind in [kinds] if isinstance(kinds, str) else kinds:
        types |= {
            "number": {"float"},
            "integer": {"int"},
            "string": {"str"},
            "boolean": {"bool"},
            "array": {"Sequence[Any]"},
            "object": {"Mapping[str, Any]"},
        }.get(kind, set())
    return types


def class_name(path: tuple[str, ...]) -> str:
    return "".join(part.title() for name in path for part in name.split("_"))


def tables_of(name: str, schema: dict):
    """Yields (class, path, {key: (type, description)}) for each table, inner tables first."""
    keys: dict[tuple[str, ...], list[dict]] = {}
    for path, inner in schemas_in(schema):
        keys.setdefault(path, []).append(inner)
    tables: dict[tuple[str, ...], dict[str, tuple[str, str]]] = {(): {}}
    lists = {
        path for path, all_of in keys.items() if any("array" in str(s.get("type")) for s in all_of)
    }
    for path in sorted(keys, key=len, reverse=True):
        tables.setdefault(path[:-1], {})
    for path, all_of in keys.items():
        described = next((s["description"] for s in all_of if "description" in s), "")
        types = set().union(*(types_of(s) for s in all_of))
        if path in tables:
            inner = class_name((name, *path))
            types = (types - {"Mapping[str, Any]", "Sequence[Any]"}) | {
                f"Sequence[{inner}]" if path in lists else inner
            }
        if "float" in types:
            types.discard("int")
        tables[path[:-1]][path[-1]] = (" | ".join(sorted(types)) or "Any", described)
    for path in sorted(tables, key=len, reverse=True):
        yield class_name((name, *path)), ".".join(path), tables[path]


def wrapped(text: str, indent: str, first: str) -> list[str]:
    lines, line = [], indent + first
    for word in text.split():
        if len(line) + 1 + len(word) > LINE:
            lines.append(line)
            line = indent + "#:"
        line += " " + word
    return [*lines, line]


def files_module(program: str) -> str:
    lines = [
        '"""Tables of files as dicts, for type checkers and editors: printed by the program.',
        "",
        "The ranges of keys and their allowed combinations are checked when a file is read.",
        '"""',
        "",
        "from __future__ import annotations",
        "",
        "from collections.abc import Mapping, Sequence",
        "from typing import Any, Literal, TypedDict",
        "",
    ]
    names = []
    for word, name in FORMATS.items():
        for class_, table, keys in tables_of(name, json.loads(said(program, "schema", word))):
            names.append(class_)
            what = f"[{table}] of a {word}" if table else f"A {word}"
            lines += ["", f"{class_} = TypedDict(  # {what}", f'    "{class_}",', "    {"]
            for key, (type_, described) in keys.items():
                if described:
                    lines += wrapped(described, "        ", "#:")
                lines.append(f'        "{key}": {type_!r},  # noqa: E501')
            lines += ["    },", "    total=False,", ")"]
    lines += ["", f"__all__ = {sorted(names)!r}"]
    return "\n".join(lines) + "\n"


def default_of(field: dict) -> object:
    """Returns the default of a keyword: a number instead of a list of one number, and None instead
    of an empty list of numbers."""
    if field.get("usual"):
        numbers = [float(text) for text in field["usual"].split("x")]
        return tuple(numbers) if field["kind"] == "numbers" else None
    default = field["default"]
    if default is None or (field["kind"] in ("file", "word") and default == ""):
        return None
    if field["kind"] == "whole":
        return int(default)
    if field["kind"] == "number":
        return float(default)
    if not isinstance(default, list):
        return default
    if field.get("is_whole"):
        return tuple(int(number) for number in default)
    if field["kind"] in ("numbers", "number_or_numbers"):
        default = [float(number) for number in default]
    if field["kind"] == "number_or_numbers" and not default:
        return None
    is_one = field["kind"] == "number_or_numbers" and len(default) == 1
    return default[0] if is_one else tuple(default)


def type_of(field: dict) -> str:
    """Returns the annotation of a keyword."""
    type_ = {
        "number": "float",
        "whole": "int",
        "flag": "bool",
        "word": "str",
        "text": "str",
        "file": "PathLike",
        "word_or_file": "str",
        "number_or_numbers": "Numbers",
        "numbers": "Numbers",
        "number_rows": "Sequence[tuple[float, float]]",
        "texts": "Sequence[str]",
    }[field["kind"]]
    if field.get("is_whole"):
        type_ = f"tuple[{', '.join(['int'] * field['count'])}]"
    is_optional = default_of(field) is None and not field.get("required")
    return f"{type_} | None" if is_optional else type_


def requests_of(program: str) -> dict[str, list[dict]]:
    document = json.loads(said(program, "list", "requests", "--json", "-"))
    return {
        request["name"]: [field for field in request["fields"] if "keyword" in field]
        for request in document["requests"]
    }


def fields_module(requests: dict[str, list[dict]]) -> str:
    former = {
        field["former"]: field["keyword"]
        for fields in requests.values()
        for field in fields
        if "former" in field
    }
    lines = [
        '"""Fields of the requests of the library: printed by the program."""',
        "",
        "from ._request import Field, Fields",
        "",
        f"FORMER = {former!r}  #: keywords of former versions",
        "",
        "FIELDS: dict[str, Fields] = {",
    ]
    for name, fields in requests.items():
        lines.append(f"    {name!r}: {{")
        for field in fields:
            otherwise = field.get("usual") or field.get("otherwise")
            meaning = field["meaning"] + (f" [{otherwise}]" if otherwise else "")
            values = (field["name"], field["kind"], field["allowed"], default_of(field), meaning)
            lines.append(f"        {field['keyword']!r}: Field{values!r},  # noqa: E501")
        lines.append("    },")
    return "\n".join([*lines, "}"]) + "\n"


def keywords(fields: list[dict]) -> list[str]:
    lines = []
    for field in fields:
        default = "" if field.get("required") else f" = {default_of(field)!r}".replace("'", '"')
        lines.append(f"    {field['keyword']}: {type_of(field)}{default},")
    return lines


def expanded(text: str, requests: dict[str, list[dict]]) -> str:
    """Replaces the marked lines of a Python file by the fields of a request."""
    lines = []
    for line in text.splitlines():
        in_signature = re.fullmatch(r"    (\*\*fields: object,  )?# generated: keywords of the request (\w+)", line)
        in_body = re.fullmatch(r"    request = (_core\.\w+\(\))  # generated: sets the fields of the request (\w+)", line)
        if in_signature:
            lines += ["    *,"] if in_signature[1] else []
            lines += keywords(requests[in_signature[2]])
        elif in_body:
            lines += ["    request = given(", f"        {in_body[1]},", f'        FIELDS["{in_body[2]}"],']
            words = (field["keyword"] for field in requests[in_body[2]])
            lines += [*(f"        {word}={word}," for word in words), "    )"]
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"


def main() -> None:
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    requests = requests_of(program)
    (folder / "files.py").write_text(files_module(program), encoding="utf-8")
    (folder / "_fields.py").write_text(fields_module(requests), encoding="utf-8")
    for source in map(pathlib.Path, sys.argv[3:]):
        text = expanded(source.read_text(encoding="utf-8"), requests)
        (folder / source.name).write_text(text, encoding="utf-8")


main()
