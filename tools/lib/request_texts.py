"""Writes texts that repeat the descriptions of requests: the comments on the members in requests/*.h, and the tables of
options in docs/commands/*.md between the marks `<!-- fields of NAME -->` and `<!-- end -->`.

    python3 request_texts.py PROGRAM [--check]

PROGRAM prints the descriptions (`retrace list requests`). With --check, no file is written: the names of files whose
texts would change are printed, and the exit code is 1 if there are any.
"""

import json
import re
import subprocess
import sys
import textwrap

from written_texts import ROOT, write_or_check

WIDTH = 120


def descriptions(program: str) -> dict[str, list[dict]]:
    said = subprocess.run(
        [program, "list", "requests", "--json", "-"], check=True, capture_output=True, text=True, timeout=60
    ).stdout
    return {request["name"]: request["fields"] for request in json.loads(said)["requests"]}


def type_name(request: str) -> str:
    """Returns the C++ type of a request, such as CameraRequest for "camera"."""
    return "".join(word.title() for word in request.split("_")) + "Request"


def range_of(field: dict) -> str:
    """Returns the allowed numbers or words, or an empty text if they follow from the type or the meaning."""
    if field["kind"] not in ("number", "whole", "word") or field["allowed"] == "any number":
        return ""
    if all(word in field["meaning"] for word in field.get("words", [""])):
        return "" if field["kind"] == "word" else field["allowed"]
    return field["allowed"]


def meaning(field: dict) -> str:
    """Returns the meaning of a field with its unit. If the meaning has a semicolon, the unit is inserted before it."""
    first, *rest = field["meaning"].split("; ")
    return "; ".join([first + (f", in {field['unit']}" if "unit" in field else ""), *rest])


def sentence(field: dict) -> str:
    """Returns the description of a field in a comment."""
    parts = [meaning(field), range_of(field)]
    otherwise = field.get("usual") or field.get("otherwise")
    text = "; ".join(part for part in parts if part) + "."
    if otherwise and otherwise.startswith("required "):
        text += f" {otherwise[0].upper()}{otherwise[1:]}."
    elif otherwise:
        text += f" Default: {otherwise}."
    if field.get("required"):
        text += " Required."
    return text[0].upper() + text[1:]


def with_comments(header: str, request: str, fields: list[dict]) -> str:
    """Replaces the comments on the members of a request."""
    found = re.search(rf"struct {type_name(request)} {{\n(.*?)^}};\n", header, re.DOTALL | re.MULTILINE)
    if not found:
        return header
    by_name = {field["name"]: field for field in fields}
    # The field `pixels` sets the two members `columns` and `rows`.
    by_name |= {"columns": by_name.get("pixels"), "rows": by_name.get("pixels")} if "pixels" in by_name else {}
    lines: list[str] = []
    for line in found[1].splitlines():
        if line.startswith("  ///"):
            continue
        member = re.match(r"  [^(]*?(\w+)(?: =|;|{)", line)
        field = by_name.get(member[1]) if member else None
        if field:
            lines += textwrap.wrap(sentence(field), WIDTH, initial_indent="  /// ", subsequent_indent="  /// ")
        lines.append(line)
    return header[: found.start(1)] + "\n".join(lines) + "\n" + header[found.end(1) :]


def any_of(words: list[str]) -> str:
    """Returns the words as a list in a sentence: "auto, exact or montecarlo"."""
    return " or ".join(filter(None, [", ".join(words[:-1]), *words[-1:]]))


def needs_text(field: dict, fields: list[dict]) -> str:
    """Returns the conditions of a field as sentences: "Not with `--lamp`."."""
    options = {other["name"]: other["option"] for other in fields if "option" in other}
    sentences = []
    for need in field.get("needs", []):
        names = [f"`{options.get(one['field'], '--' + one['field'])}`" for one in need]
        if all(one.get("is") == "absent" for one in need):
            together = " and ".join(names)
            sentences.append(f"Not with {together}{' together' if len(names) > 1 else ''}.")
        elif all(one.get("is") == "given" for one in need):
            sentences.append(f"Only with {' or '.join(names)}.")
        else:
            parts = []
            for name, one in zip(names, need):
                words = any_of(one.get("one_of", []))
                parts.append(f"without {name}" if one.get("is") == "absent" else f"with {name} {words}".strip())
            sentences.append(f"Only {', or '.join(parts)}.")
    return " ".join(sentences)


def table(fields: list[dict]) -> str:
    lines = ["| option | default | does |", "|---|---|---|"]
    for field in fields:
        if "option" not in field:
            continue
        option = f"{field['option']} {field['value']}".strip().replace("|", "\\|")
        does = [meaning(field), range_of(field)]
        text = "; ".join(part for part in does if part) + ". " + needs_text(field, fields)
        default = field["default_text"].replace("|", "\\|")
        lines.append(f"| `{option}` | {default} | {text.strip()} |")
    return "\n".join(lines) + "\n"


def with_tables(page: str, requests: dict[str, list[dict]]) -> str:
    """Replaces the tables of options in a page."""

    def replaced(found: re.Match) -> str:
        return f"{found[1]}\n{table(requests[found[2]])}\n{found[3]}"

    return re.sub(r"(<!-- fields of (\w+) -->\n)(?:.*?)(<!-- end -->)", replaced, page, flags=re.DOTALL)


def main() -> int:
    requests = descriptions(sys.argv[1])
    texts = {}
    for path in [*sorted((ROOT / "requests").glob("*.h")), *sorted((ROOT / "docs/commands").glob("*.md"))]:
        text = path.read_text(encoding="utf-8")
        new = with_tables(text, requests) if path.suffix == ".md" else text
        if path.suffix == ".h":
            for request, fields in requests.items():
                new = with_comments(new, request, fields)
        texts[path] = new
    return write_or_check(texts, "the descriptions of requests", "--check" in sys.argv[2:])


sys.exit(main())
