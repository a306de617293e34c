"""Writes the tests of one test program to a list that ctest includes. A suite is named FOLDER/SUITE, where FOLDER is
the folder of its source.

    python3 register_tests.py PROGRAM LIST.cmake plain|sanitized

The tests of a suite run in one process. Starting a process for each test would take longer than most tests, because the
program links hundreds of libraries. Long suites are split into parts (FOLDER/SUITE:2 and so on), which run in parallel.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

MAX_TESTS = 12
# Processor seconds of the expensive suites. ctest starts the most expensive suites first, so that no long suite is left
# when all others have ended. Only the order matters. `tools/test_costs` writes the file.
COSTS = json.loads(pathlib.Path(__file__).with_name("costs.json").read_text(encoding="utf-8"))
# Suites whose parameters are registered separately, as FOLDER/SUITE/PARAMETER. The parameters are documents, which take
# a minute or more.
SPLIT_BY_PARAMETER = {"app/Docs/Pages", "app/Docs/Tutorials"}
# Names of tests that get the label `slow`: tests that run under MPI, tests of an installation, and the tutorial on
# clusters.
SLOW = re.compile(r"/\w*ByMpi(:\d+)?$|/Installed\w*(:\d+)?$|^app/Docs/Tutorials/cluster$")
# Timeouts of a suite in seconds. Sanitizers make suites about ten times slower.
TIMEOUTS = {"plain": 1200, "sanitized": 12000}
# A fixed seed makes property tests draw the same cases in every run. Set RC_PARAMS by hand to try other cases.
PROPERTIES = 'ENVIRONMENT "RC_PARAMS=seed=1"'


def suites_of(program):
    """Returns the folder, the name and the names of the tests of every suite."""
    with tempfile.TemporaryDirectory() as folder:
        listed = pathlib.Path(folder, "tests.json")
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{listed}"], check=True, timeout=60,
                       stdout=subprocess.DEVNULL)
        suites = json.loads(listed.read_text())["testsuites"]
    return [(pathlib.Path(suite["testsuite"][0]["file"]).parent.name, suite["name"],
             [test["name"] for test in suite["testsuite"]]) for suite in suites]


def parts_of(suite, tests):
    """Yields the name and the tests of every part of a suite. ctest runs each part in a separate process."""
    if suite in SPLIT_BY_PARAMETER:
        for test in tests:
            yield f"{suite}/{test.rpartition('/')[2]}", [test]
        return
    for first in range(0, len(tests), MAX_TESTS):
        yield suite + (f":{first // MAX_TESTS + 1}" if first else ""), tests[first:first + MAX_TESTS]


def entries(program, timeout, folder, suite, tests):
    for name, chosen in parts_of(f"{folder}/{suite}", tests):
        wanted = ":".join(f"{suite}.{test}" for test in chosen)
        labels = " LABELS slow" if SLOW.search(name) else ""
        yield (f'add_test([==[{name}]==] [==[{program}]==] [==[--gtest_filter={wanted}]==])\n'
               f'set_tests_properties([==[{name}]==] PROPERTIES {PROPERTIES} TIMEOUT {timeout} '
               f'COST {COSTS.get(name, 0)}{labels} WORKING_DIRECTORY [==[{pathlib.Path.cwd()}]==])\n')


def main():
    program, out, build = sys.argv[1:]
    pathlib.Path(out).write_text("".join(text for suite in sorted(suites_of(program))
                                         for text in entries(program, TIMEOUTS[build], *suite)))


main()
