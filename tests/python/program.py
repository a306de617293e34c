"""Functions that run the program on its examples. Tests compare the results with the package."""

import functools
import json
import os
import pathlib
import re
import subprocess

import retrace as rt

PROGRAM = os.environ["RETRACE_PROGRAM"]
SOURCE = pathlib.Path(os.environ["RETRACE_SOURCE_DIR"])
EXAMPLES = SOURCE / "examples"
IS_LONG_RUN = os.environ.get("RETRACE_LONG_TESTS") == "1"

# Keywords of a short photometry of a red part by R150.
RED_R150 = {
    "standard": "r150",
    "class_": "IA",
    "colour": "red",
    "area_cm2": 30,
    "engine": "montecarlo",
    "samples": 64,
    "advice": False,
}


def example(name):
    return str(EXAMPLES / name)


def files_of(schema, folder=""):
    """Returns every TOML file below examples/ with this schema."""
    found = [
        file
        for file in sorted((EXAMPLES / folder).rglob("*.toml"))
        if re.search(rf'^schema = "{schema}"', file.read_text(), re.MULTILINE)
    ]
    assert found, schema
    return [str(file) for file in found]


def designs():
    """Returns every design below examples/."""
    return files_of("retrace.design/1")


def some_designs(first):
    """Returns every third design below examples/, from number `first` on.

    A long run returns all designs.
    """
    return designs() if IS_LONG_RUN else designs()[first::3]


def least(of_all):
    """Returns the minimum number of results for some_designs() if all designs have `of_all` results."""
    return of_all if IS_LONG_RUN else of_all // 4


def same(text):
    """Returns a document with the run times set to 0, because they differ from run to run."""
    return re.sub(r'"elapsed_s": [-+.e0-9]+', '"elapsed_s": 0', text)


def run(*arguments, folder=None):
    """Runs the program and returns its exit code, standard output and standard error."""
    ended = subprocess.run(
        [PROGRAM, *map(str, arguments), "--quiet"], capture_output=True, cwd=folder, timeout=600
    )
    return ended.returncode, ended.stdout.decode(), ended.stderr.decode()


@functools.cache
def requests():
    """Returns the descriptions of all requests, for which the program runs only one time."""
    return json.loads(run("list", "requests", "--json", "-")[1])["requests"]


def in_python(message):
    """Replaces the names of options in a message by the package's keywords."""
    keywords = {
        field["option"]: field["keyword"]
        for request in requests()
        for field in request["fields"]
        if "option" in field and "keyword" in field
    }

    def keyword(option):
        return keywords.get(option[0], option[0].removeprefix("--").replace("-", "_"))

    return re.sub(r"--[a-z][a-z-]+", keyword, message)


def document(*arguments, folder=None):
    """Returns the document of a command, or None and the message that the package must raise."""
    code, out, err = run(*arguments, "--json", "-", folder=folder)
    if code in (0, 1) and out:
        return same(out), ""
    return None, in_python(err.strip().removeprefix("retrace: "))


def answer(call, *arguments, **keywords):
    """Returns the document of a call of the package, or None and the message that it raises."""
    try:
        return same(call(*arguments, **keywords).json), ""
    except rt.Error as error:
        return None, str(error)
