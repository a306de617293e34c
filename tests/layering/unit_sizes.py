"""Names the translation units for which the compiler reads most lines, and fails if one reads more than LIMIT.

Reading headers is two thirds of the time that a build takes. Lines are those of all files that a unit was made of, each
counted once, as the compiler itself listed them for Ninja: what `g++ -E` prints without blank lines and comments is
about half of it. Usage: unit_sizes.py BUILD_FOLDER
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
    except FileNotFoundError:  # of an older build
        return 0


def units(build_folder):
    """Yields (object file, files it was made of)."""
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
