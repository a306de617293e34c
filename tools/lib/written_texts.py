"""Writes or checks files whose texts are made from other files."""

import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def write_or_check(texts: dict[pathlib.Path, str], source: str, is_check: bool) -> int:
    """Writes the texts into their files and prints the names of the files that have changed. With `is_check`, no file is
    written. Returns the exit code: 1 if `is_check` is true and a file has another text.
    """
    stale = [path for path, text in texts.items() if path.read_text(encoding="utf-8") != text]
    for path in stale:
        if not is_check:
            path.write_text(texts[path], encoding="utf-8")
        print(f"{path.relative_to(ROOT)}: {'differs from' if is_check else 'written from'} {source}")
    return 1 if is_check and stale else 0
