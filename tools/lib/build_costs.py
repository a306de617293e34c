"""Prints the compile and link times of the last build, by target and by translation unit, as Markdown tables.

    tools/build_costs [BUILD]

BUILD is a build folder of CMake with Ninja, by default build/release. Times are wall-clock times of compilers and
linkers from .ninja_log. Other work on the machine makes them longer.
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MAX_ROWS = 10


def give_up(message):
    sys.exit(f"build_costs: {message}")


def seconds_of(log):
    """Returns a dictionary from output files to the time in seconds of their last build.

    \param log path of .ninja_log
    """
    seconds = {}
    try:
        for line in log.read_text(encoding="utf-8").splitlines():
            if not line.startswith("#"):
                start, end, _, output, _ = line.split("\t")
                seconds[output] = (int(end) - int(start)) / 1000
    except (OSError, ValueError) as error:
        give_up(f"{log}: is not the record of a build by Ninja: {error}")
    return seconds


def sources_of(build, unit):
    """Returns the source files of a unit of a unity build, in which several source files are compiled as one unit.

    Returns an empty list if the unit is a single source file.
    """
    text = build / unit.removesuffix(".o")
    return re.findall(r'^#include "(.*)"', text.read_text(encoding="utf-8"), re.MULTILINE) if text.exists() else []


def table(head, rows):
    print(f"| {' | '.join(head)} |\n|{'---|' * len(head)}")
    for row in rows:
        print(f"| {' | '.join(map(str, row))} |")
    print()


def main():
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__.strip())
        return
    build = pathlib.Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build/release"
    units, targets, links = {}, {}, 0.0
    for output, seconds in seconds_of(build / ".ninja_log").items():
        target = re.search(r"CMakeFiles/([^/]+)\.dir/.*\.o$", output)
        if target:
            units[output] = seconds
            targets[target[1]] = targets.get(target[1], 0.0) + seconds
        elif output.startswith("bin/"):
            links += seconds
    dearest = sorted(targets.items(), key=lambda item: -item[1])
    rest = sum(seconds for _, seconds in dearest[MAX_ROWS:])
    table(("target", "compiled in s"),
          [(name, round(seconds)) for name, seconds in dearest[:MAX_ROWS]] +
          [(f"{max(0, len(dearest) - MAX_ROWS)} others", round(rest)), ("links of programs", round(links)),
           ("all", round(sum(targets.values()) + links))])
    table(("unit", "s", "sources"),
          [(re.sub(r"^.*CMakeFiles/([^/]+)\.dir/(Unity/)?|_cxx\.cxx\.o|\.o$", r"\1 ", unit).strip(), round(seconds),
            ", ".join(pathlib.Path(source).name for source in sources_of(build, unit)))
           for unit, seconds in sorted(units.items(), key=lambda item: -item[1])[:MAX_ROWS]])


if __name__ == "__main__":
    main()
