"""Lists the translation units for which the compiler reads the most lines. Fails if a unit has more than LIMIT lines.

    unit_sizes.py BUILD_FOLDER

Reading headers takes two thirds of the time of a build. The size of a unit is the total number of lines of all source
files and headers from which it was built. Each file is counted once. The compiler reports these files to Ninja, which
stores their names. The output of `g++ -E` without blank lines and comments has about half as many lines.
"""
import functools
import os
import re
import subprocess
import sys

LIMIT = 700_000
SHOWN = 10


@functools.cache
def lines_in(path):
    try:
        with open(path, "rb") as file:
            return sum(1 for _ in file)
    except FileNotFoundError:  # a file of an older build, which no longer exists
        return 0


def units(build_folder):
    """Yields each object file with the list of the source files and headers from which it was built."""
    listed = subprocess.run(["ninja", "-C", build_folder, "-t", "deps"], capture_output=True, text=True, check=True)
    for block in listed.stdout.split("\n\n"):
        head, *files = block.strip().split("\n")
        found = re.match(r"(.*\.o): #deps .*\(VALID\)", head)
        if found:
            yield found[1], [os.path.join(build_folder, file.strip()) for file in files]


def main():
    sizes = sorted(((sum(map(lines_in, files)), name) for name, files in units(sys.argv[1])), reverse=True)
    if not sizes:
        sys.exit("no units in " + sys.argv[1])
    for lines, name in sizes[:SHOWN]:
        print(f"{lines:>9,} lines  {name}")
    print(f"{len(sizes)} units, {sum(lines for lines, _ in sizes):,} lines in all; at most {LIMIT:,} a unit")
    sys.exit(sizes[0][0] > LIMIT)


main()
