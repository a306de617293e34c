"""Records the sources of the checked-in engine of the live page, and checks whether the engine is up to date.

    python3 live_sources.py record SOURCE BUILD    after a build by emscripten: writes data/live_page/engine.*
    python3 live_sources.py check SOURCE           exit code 1 and a line for each file that has changed

The record contains every file that the compiler read and every file that controls the build. For the CMakeLists.txt of
the root, only the version is compared. For C++ files, only the code is compared: comments and white space may change
without a new engine.
"""

import hashlib
import json
import pathlib
import re
import subprocess
import sys

LISTS = ["cmake/RetraceLivePage.cmake", "cmake/RetraceTargets.cmake", "live/engine/bundle.js", "live/engine/LICENCES.txt"]


def hash_of(content):
    return hashlib.sha256(content).hexdigest()


# Matches a comment or a literal of C++. Literals are matched because // and /* do not begin a comment in them.
LITERAL_OR_COMMENT = re.compile(
    r'R"(?P<delimiter>[^\s()\\]*)\(.*?\)(?P=delimiter)"'  # raw string
    r'|"(?:[^"\\\n]|\\.)*"'  # string
    r"|(?<!\w)'(?:[^'\\\n]|\\.)+'"  # character, but no separator of digits
    r"|(?P<comment>//[^\n]*|/\*.*?\*/)",
    re.DOTALL,
)


def code_of(text):
    """Returns the words, signs and literals of a C++ file, without comments."""
    code = []
    end = 0
    for found in LITERAL_OR_COMMENT.finditer(text):
        code += re.findall(r"\w+|[^\w\s]", text[end : found.start()])
        if not found["comment"]:
            code.append(found[0])
        end = found.end()
    code += re.findall(r"\w+|[^\w\s]", text[end:])
    return " ".join(code)


def hash_of_source(path):
    content = path.read_bytes()
    return hash_of(code_of(content.decode()).encode() if path.suffix in {".h", ".cpp"} else content)


def version_of(source):
    return re.search(r"project\(retrace VERSION (\S+)", (source / "CMakeLists.txt").read_text())[1]


def compiled(source, build):
    """Returns the files of the repository that the compiler read, according to ninja's record of dependencies."""
    told = subprocess.run(["ninja", "-C", build, "-t", "deps"], check=True, capture_output=True, text=True).stdout
    files = set()
    for line in told.splitlines():
        path = pathlib.Path(build, line.strip())
        if not line.startswith("    ") or not path.resolve().is_relative_to(source):
            continue
        name = path.resolve().relative_to(source).as_posix()
        if not name.startswith("build/"):
            files.add(name)
    return files


def list_of(source, file):
    """Returns the CMakeLists.txt that controls how a file is compiled: in its folder or in the nearest folder above
    it."""
    folder = next(folder for folder in file.parents if (source / folder / "CMakeLists.txt").is_file())
    return (folder / "CMakeLists.txt").as_posix()


def sources_of(source, build):
    files = compiled(source, build)
    files |= {list_of(source, pathlib.PurePath(name)) for name in files}
    embedded = re.findall(r"foreach\(file IN ITEMS ([^)]*)\)", (source / "live/engine/CMakeLists.txt").read_text())
    return sorted((files - {"CMakeLists.txt"}) | set(LISTS) | {f"data/{name}" for name in embedded[0].split()})


def record(source, build):
    data = source / "data/live_page"
    wasm = (build / "live/engine/engine.wasm").read_bytes()
    # Every page contains this file. Saving 5 % compared with gzip is therefore worth the ten seconds that zopfli takes.
    packed = subprocess.run(["zopfli", "-c", build / "live/engine/engine.wasm"], check=True, capture_output=True).stdout
    files = {name: hash_of_source(source / name) for name in sources_of(source, build)}
    script = (build / "live/engine/engine.js").read_text().replace("</script", "<\\/script")
    data.mkdir(parents=True, exist_ok=True)
    (data / "engine.wasm.gz").write_bytes(packed)
    (data / "ENGINE_LICENCES.txt").write_bytes((source / "live/engine/LICENCES.txt").read_bytes())
    (data / "engine.js").write_text(
        f"/* made by tools/live_page; engine.wasm.gz {hash_of(packed)} */\n{script}")
    (data / "engine.sources.json").write_text(json.dumps(
        {"version": version_of(source), "engine.wasm.gz": hash_of(packed), "sources": files}, indent=1) + "\n")
    print(f"engine: {len(wasm)} bytes, {len(packed)} packed, {len(script)} of script, {len(files)} sources")


def changes(source):
    """Yields a sentence for each difference between the sources and the record of the engine."""
    data = source / "data/live_page"
    made = json.loads((data / "engine.sources.json").read_text())
    packed = hash_of((data / "engine.wasm.gz").read_bytes())
    if packed != made["engine.wasm.gz"] or packed not in (data / "engine.js").read_text()[:200]:
        yield "engine.wasm.gz, engine.js and engine.sources.json are not of one build"
    if made["version"] != version_of(source):
        yield f"the version is {version_of(source)}, the engine's {made['version']}"
    for name, wanted in made["sources"].items():
        if not (source / name).is_file():
            yield f"{name} is gone"
        elif hash_of_source(source / name) != wanted:
            yield f"{name} has changed"


if __name__ == "__main__":
    if sys.argv[1] == "record":
        record(pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3]).resolve())
    else:
        stale = list(changes(pathlib.Path(sys.argv[2]).resolve()))
        for change in stale:
            print(f"live_page: {change}: run tools/live_page", file=sys.stderr)
        sys.exit(1 if stale else 0)
