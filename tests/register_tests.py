"""Writes what ctest runs of one test program: every test by itself, as FOLDER/SUITE.TEST after its source's folder.

    python3 register_tests.py PROGRAM LIST.cmake
"""

import json
import pathlib
import subprocess
import sys
import tempfile

# A fixed seed: property tests draw the same cases in every run. RC_PARAMS set by hand tries others.
PROPERTIES = 'TIMEOUT 1200 ENVIRONMENT "RC_PARAMS=seed=1"'


def tests_of(program):
    """Folder and name of every test."""
    with tempfile.TemporaryDirectory() as folder:
        listed = pathlib.Path(folder, "tests.json")
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{listed}"], check=True, timeout=60,
                       stdout=subprocess.DEVNULL)
        suites = json.loads(listed.read_text())["testsuites"]
    return [(pathlib.Path(test["file"]).parent.name, f"{suite['name']}.{test['name']}")
            for suite in suites for test in suite["testsuite"]]


def entry(program, folder, test):
    return (f'add_test([==[{folder}/{test}]==] [==[{program}]==] [==[--gtest_filter={test}]==])\n'
            f'set_tests_properties([==[{folder}/{test}]==] PROPERTIES {PROPERTIES} WORKING_DIRECTORY [==[{pathlib.Path.cwd()}]==])\n')


def main():
    program, out = sys.argv[1:]
    pathlib.Path(out).write_text("".join(entry(program, *test) for test in sorted(tests_of(program))))


main()
