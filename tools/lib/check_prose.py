#!/usr/bin/env python3
"""Checks the language of comments and documents.

    check_prose.py FILES...

Prints each fault as FILE:LINE: TEXT and exits with 1 if there are faults. A fault is
- a phrase of prose_phrases.txt (one regular expression per line; case is ignored),
- a comment that begins with a word that leaves open what is described, such as "Of" or "By which",
- a sentence of more than 40 words.
Code in backticks, formulas, tables and code blocks of documents are not checked.
"""

import pathlib
import re
import sys

MOST_WORDS = 40
OPENINGS = re.compile(r"(Of|By which|What|As far as|Whether|Where|How)\b(?! +(is|are|does|do) )")
LINE_COMMENTS = {
    ".h": "//", ".cpp": "//", ".js": "//", ".mjs": "//", ".py": "#", ".sh": "#", ".cmake": "#", ".txt": "#", "": "#",
}  # fmt: skip
PHRASES = [
    re.compile(line, re.IGNORECASE)
    for line in pathlib.Path(__file__).with_name("prose_phrases.txt").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
]


def comments(text: str, mark: str):
    """Yields (line, text) for each comment. Comments on consecutive lines form one comment, but an entry of a list, a
    Doxygen command or an indented line begins a new one."""
    first, words = 0, ""
    for number, line in enumerate(text.splitlines(), 1):
        found = re.match(rf"(.*?){re.escape(mark)}+[/!<]*( ?)(.*)$", line)
        is_whole_line = found is not None and not found[1].strip()
        comment = found[3] if found else ""
        begins = re.match(r"\\\w+|[-*] | |\d+\. |$", comment) is not None
        if words and (not is_whole_line or begins):
            yield first, words
            words = ""
        if found and is_whole_line and comment:
            first = first if words else number
            words = f"{words} {comment}".strip()
        elif found and mark == "//" and re.match(r".*[;,{(] *///<", line):
            yield number, comment
    if words:
        yield first, words


def docstrings(text: str):
    for found in re.finditer(r'"""(.*?)"""', text, re.DOTALL):
        line = text.count("\n", 0, found.start()) + 1
        for paragraph in found[1].split("\n\n"):
            if not re.search(r"\n {4,}\S|\n- ", "\n" + paragraph.lstrip("\n")):
                yield line, " ".join(paragraph.split())
            line += paragraph.count("\n") + 2


def paragraphs(text: str):
    """Yields (line, text) for each paragraph of a Markdown document, without code, tables and headings."""
    text = re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.DOTALL)
    text = re.sub(r"\$\$.*?\$\$", lambda m: "\n" * m[0].count("\n"), text, flags=re.DOTALL)
    first, words = 0, ""
    for number, line in enumerate([*text.splitlines(), ""], 1):
        is_text = bool(line.strip()) and not re.match(r" {4}|\||#|<|!\[", line)
        begins = re.match(r"\s*([-*]|\d+\.) ", line) is not None
        if words and (not is_text or begins):
            yield first, words
            words = ""
        if is_text:
            first = first if words else number
            words = f"{words} {line.strip()}".strip()


def faults(path: pathlib.Path):
    text = path.read_text(encoding="utf-8", errors="replace")
    is_document = path.suffix == ".md"
    parts = list(paragraphs(text)) if is_document else list(comments(text, LINE_COMMENTS.get(path.suffix, "//")))
    if path.suffix == ".py":
        parts += docstrings(text)
    for line, part in parts:
        plain = re.sub(r"`[^`]*`|\$[^$]*\$|\]\([^)]*\)|https?://\S+", "x", part)
        if not is_document and (opening := OPENINGS.match(plain)):
            yield line, f'comment begins with "{opening[0]}"'
        for phrase in PHRASES:
            if found := phrase.search(plain):
                yield line, f'"{found[0]}"'
        for sentence in re.split(r"(?<=[.:;?!]) +", plain):
            if (count := len(re.findall(r"[^\W\d_]{2,}", sentence))) > MOST_WORDS:
                yield line, f"sentence of {count} words: {sentence[:60]}..."


def main() -> int:
    count = 0
    for name in sys.argv[1:]:
        for line, fault in faults(pathlib.Path(name)):
            print(f"{name}:{line}: {fault}")
            count += 1
    return 1 if count else 0


sys.exit(main())
