"""Updates tests/costs.json with the run times of test suites, which tools/test has recorded.

    tools/test_costs [RECORD.xml]

RECORD.xml is a JUnit file of ctest, by default build/release/test_times.xml. Suites that took 5 s or more are written
to costs.json with their time in seconds. A suite that failed keeps its earlier entry. A suite that is not in RECORD.xml
is removed. Therefore, use the record of a complete run: tools/test without arguments.
"""

import json
import pathlib
import sys
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
COSTS = ROOT / "tests/costs.json"
MIN_SECONDS = 5.0
# Minimum number of suites in the record of a complete run. Records with fewer suites are refused.
MIN_SUITES = 300


def give_up(message):
    sys.exit(f"test_costs: {message}")


def cases_of(record):
    """Returns the test cases of a JUnit file of ctest as (name, status, seconds)."""
    try:
        suite = xml.etree.ElementTree.parse(record).getroot()
        return [(case.attrib["name"], case.attrib["status"], float(case.attrib["time"])) for case in suite.iter("testcase")]
    except OSError as error:
        give_up(f"{record}: cannot be read: {error.strerror}; run tools/test first")
    except (xml.etree.ElementTree.ParseError, KeyError, ValueError) as error:
        give_up(f"{record}: is not a JUnit file of ctest: {error}")


def costs_of(cases, before):
    """Returns a dictionary from suites to their run times in seconds.

    \\param cases test cases as returned by cases_of()
    \\param before previous content of costs.json, whose entries are kept for suites that failed
    """
    costs = {}
    for name, status, seconds in cases:
        if status == "run" and seconds >= MIN_SECONDS:
            costs[name] = round(seconds)
        elif status != "run" and name in before:
            costs[name] = before[name]
    return costs


def main():
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return
    record = pathlib.Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build/release/test_times.xml"
    cases = cases_of(record)
    if len(cases) < MIN_SUITES:
        give_up(f"{record}: must hold the {MIN_SUITES} or more suites of a complete run, got {len(cases)}; "
                "run tools/test without arguments")
    costs = costs_of(cases, json.loads(COSTS.read_text(encoding="utf-8")))
    COSTS.write_text(json.dumps(costs, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    print(f"wrote {COSTS.relative_to(ROOT)}: {len(costs)} of {len(cases)} suites")


if __name__ == "__main__":
    main()
