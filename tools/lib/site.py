"""Collects the pages of the website, builds them with mkdocs and checks the result. Called by tools/site.

    python3 site.py SOURCE PROGRAM BUILD

Pages have the same relative paths in BUILD/site_pages as in the repository, so that links between them stay valid. If
a page links to a file that is not a page (an example, data or a source), a page with the contents of this file is
created. Every example has a page with a picture, which PROGRAM draws. The site is written to BUILD/site.
"""

import html
import html.parser
import json
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys
import tomllib
import urllib.parse

SOURCE, PROGRAM, BUILD = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
PAGES, SITE, PICTURES = BUILD / "site_pages", BUILD / "site", BUILD / "site_pictures"
NOTEBOOKS = BUILD / "site_notebooks"
PICTURE_ENDINGS = (".png", ".svg")
LANGUAGES = {".toml": "toml", ".h": "cpp", ".cpp": "cpp", ".py": "python", ".slurm": "sh", ".cff": "yaml"}
MOST_LINES = 200  # maximum number of lines of a file that are shown

# Sections of the navigation, in order. Missing pages are omitted. A pattern such as docs/*.md matches only pages that
# are not named individually. A dictionary within a section is a second level of the navigation.
SECTIONS = {
    "Start": ["README.md", "docs/install.md"],
    "Tutorials": ["docs/tutorials/first_curve.md", "docs/tutorials/regulation.md", "docs/tutorials/sheeting.md", "docs/tutorials/lamp.md", "docs/tutorials/step_lens.md",
                  "docs/tutorials/ranging.md",
                  "docs/tutorials/nc_program.md", "docs/tutorials/test_cuts.md", "docs/tutorials/measured_facet.md", "docs/tutorials/cluster.md",
                  "docs/tutorials/*.md"],
    "Notebooks": ["examples/notebooks/*.md"],
    "How to": ["docs/nc_dialects.md", "docs/adding_a_dialect.md", "docs/python.md", "docs/library.md", "CONTRIBUTING.md", "docs/*.md"],
    "Reference": [{"Commands": ["docs/commands.md", "docs/commands/*.md"]}, "docs/design_file.md",
                  "docs/study_file.md", "docs/job_file.md", "docs/machine_file.md", "docs/turning_file.md",
                  "docs/planing_file.md", "docs/json_documents.md", "docs/former_names.md", "CONVENTIONS.md"],
    "Theory": ["docs/theory/README.md", "docs/theory/closed_forms.md", "docs/theory/monte_carlo.md",
               "docs/theory/beams.md", "docs/theory/photometry.md", "docs/theory/scatter.md", "docs/theory/*.md"],
    "Validation": ["docs/validation.md"],
    "Gallery": ["docs/gallery.md", "examples/README.md"],
    "Inside": ["docs/architecture.md", "docs/dependencies.md", "THIRD-PARTY-NOTICES.md", "SECURITY.md"],
    "Changelog": ["CHANGELOG.md"],
}

STYLE = """\
[data-md-color-scheme=slate] { --md-typeset-a-color: #9fb1ff }
.md-typeset table:not([class]) { font-size: .66rem }
.md-typeset img { background: #fff; border-radius: .1rem }
.md-typeset img[src$=".svg"] { color-scheme: light }
.md-typeset h1 code { overflow-wrap: anywhere }
.md-typeset td code { word-break: normal; overflow-wrap: break-word }
.md-typeset td:first-child code { white-space: nowrap }
.md-typeset table.dataframe { display: block; overflow-x: auto; border: 0; font-size: .66rem }
.md-grid { max-width: 72rem }
.formula { overflow-x: auto; overflow-y: hidden; margin: 1em 0 }
.live { width: 100%; height: 85vh; border: 1px solid var(--md-default-fg-color--lightest) }
.examples { display: grid; grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr)); gap: .8rem }
.examples a { display: block; font-size: .7rem }
.examples img { width: 100%; height: 8rem; object-fit: contain }
"""

KATEX = pathlib.Path("/usr/share/javascript/katex")
SET_FORMULAS = """\
for (const formula of document.querySelectorAll(".formula"))
  katex.render(formula.textContent, formula, {displayMode: true});
"""

# Pages that are opened from disk cannot read the search index or start the search worker from a file. Both are
# therefore contained in a script.
MAIN = """\
{% extends "base.html" %}
{% block extrahead %}
<script>if (location.protocol === "file:") document.write('<script src="{{ 'search/from_disk.js' | url }}"><\\/script>')</script>
{% endblock %}
"""
FROM_DISK = """\
var __search = {index: Promise.resolve(%s)};
window.Worker = class extends Worker {
  constructor() { super(URL.createObjectURL(new Blob([%s], {type: "text/javascript"}))) }
};
"""

faults = []


def run(*arguments):
    return subprocess.run([str(argument) for argument in arguments], check=False, text=True, capture_output=True)


def write(page, text):
    (PAGES / page).parent.mkdir(parents=True, exist_ok=True)
    (PAGES / page).write_text(text)


# --- Markdown ---------------------------------------------------------------------------------------------------------

FENCE = re.compile(r"^\s*```")
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.) ")
LINK = re.compile(r"(?<=\]\()([^()\s]+)(?=\))")
TEXT_OF_LINK = re.compile(r"\[([^\[\]]*)\]\(<nowhere>\)")


def outside_of_blocks(text, change):
    """Changes the lines of a page outside fenced blocks. `change` is called with the line and the previous line."""
    lines, in_block, before = [], False, ""
    for line in text.split("\n"):
        if FENCE.match(line):
            in_block = not in_block
        elif not in_block:
            line = change(line, before)
        before = line
        lines.append(line)
    return "\n".join(lines)


def pipes_in_tables(line, _):
    """Escapes bars in code within tables as HTML, because only some Markdown readers support the notation \\|."""
    if not line.startswith("|"):
        return line
    return re.sub(r"`([^`]*\\\|[^`]*)`", lambda found: "<code>" + html.escape(found.group(1).replace("\\|", "|")).replace(
        "|", "&#124;") + "</code>", line)


def set_formulas(page, text):
    """Replaces lines by KaTeX formulas, as listed in docs/theory/formulas.toml."""
    name = pathlib.PurePath(page)
    formulas = tomllib.loads((SOURCE / "docs/theory/formulas.toml").read_text()).get(name.stem, {})
    if str(name.parent) != "docs/theory":
        return text
    for plain, formula in formulas.items():
        line = "\n    " + plain + "\n"
        if text.count(line) != 1:
            faults.append(f"docs/theory/formulas.toml: {page} has no line of its own: {plain}")
        text = text.replace(line, f'\n<div class="formula">{html.escape(formula)}</div>\n', 1)
    return text


def copy_katex():
    (PAGES / "katex").mkdir()
    for name in ("katex.min.js", "katex.min.css"):
        shutil.copy(KATEX / name, PAGES / "katex")
    shutil.copytree(KATEX / "fonts", PAGES / "katex/fonts", ignore=shutil.ignore_patterns("*.ttf", "*.woff"))
    (PAGES / "katex/set.js").write_text(SET_FORMULAS)


def list_needs_blank():
    """Returns a function that inserts a blank line before each list, because some Markdown readers require one."""
    state = {"in_list": False}

    def change(line, before):
        starts = bool(ITEM.match(line))
        if starts and not state["in_list"] and before.strip() and not before.startswith("#"):
            line = "\n" + line
        if starts:
            state["in_list"] = True
        elif not before.strip() and line.strip() and not line.startswith(" "):
            state["in_list"] = False
        return line
    return change


def shown_file(path):
    """Returns a page with the contents of a file of the repository."""
    text = (SOURCE / path).read_text(errors="replace").rstrip("\n").split("\n")
    cut = f"\n\nThe first {MOST_LINES} of its {len(text)} lines." if len(text) > MOST_LINES else ""
    language = LANGUAGES.get(path.suffix, "text")
    return f"# `{path}`\n\n````{language}\n" + "\n".join(text[:MOST_LINES]) + f"\n````{cut}\n"


class Pages:
    """Collects the pages of the site by their path in the repository, and the files to which they link."""

    def __init__(self):
        self.waiting, self.known = [], set()

    def want(self, page):
        if page not in self.known:
            self.known.add(page)
            self.waiting.append(page)

    def target(self, page, link):
        """Returns the new target of a link, or None for a folder without a page."""
        if re.match(r"[a-z]+:|#", link):
            return link
        path, _, anchor = link.partition("#")
        goal = posixpath.normpath(posixpath.join(posixpath.dirname(page), path))
        place = SOURCE / goal
        if goal == "examples" or goal.startswith("examples/") and place.is_dir():
            goal = "examples/README.md"
        elif place.is_dir():
            if not (place / "README.md").exists():
                return None
            goal += "/README.md"
        elif not place.exists() and not (PAGES / goal).exists():
            faults.append(f"{page}: no such file: {link}")
            return None
        if goal.endswith(".md"):
            self.want(goal)
        elif goal.startswith("docs/") and goal.endswith(PICTURE_ENDINGS):
            (PAGES / goal).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(place, PAGES / goal)
        elif not goal.endswith(PICTURE_ENDINGS):
            if not goal.startswith("examples/"):
                write(goal + ".md", shown_file(pathlib.Path(goal)))
            goal += ".md"
        goal = "index.md" if goal == "README.md" else goal
        return posixpath.relpath(goal, posixpath.dirname(page) or ".") + ("#" + anchor if anchor else "")

    def links(self, page, line):
        changed = LINK.sub(lambda found: self.target(page, found.group(1)) or "<nowhere>", line)
        return TEXT_OF_LINK.sub(r"\1", changed)

    def gather(self):
        while self.waiting:
            page = self.waiting.pop()
            if not (SOURCE / page).exists():
                continue  # the page was generated, not copied
            text = outside_of_blocks((SOURCE / page).read_text(), list_needs_blank())
            text = outside_of_blocks(outside_of_blocks(text, pipes_in_tables), lambda line, _: self.links(page, line))
            text = set_formulas(page, text)
            if page == "README.md":
                title, rest = text.split("\n\n", 1)
                text = f"{title}\n\n{FRONT}{rest}"
            write("index.md" if page == "README.md" else page, text)


# --- Examples ---------------------------------------------------------------------------------------------------------

def value_of(text, key):
    found = re.search(rf'^{key} = "(.*)"', text, re.MULTILINE)
    return found.group(1) if found else ""


def question(file, text):
    """Returns the command that draws an example, and the preferred pictures of its output, the best first."""
    schema = value_of(text, "schema")
    if schema == "retrace.design/1":
        if 'kind = "ball"' in text:
            return ["rre", file, "--incidence=0:40:10", "--samples", 4096], ["rre.png"]
        return ["inspect", file], ["view.png", "entrance_surface.svg", "plan.svg"]
    if schema == "retrace.study/1":
        design = value_of(text, "design") or re.search(r'key = "design"\nvalues = \["([^"]*)"', text).group(1)
        return ["inspect", (file.parent / design).resolve()], ["view.png", "entrance_surface.svg", "plan.svg"]
    if schema == "retrace.cubes/1":
        cube = file.parent.parent / "round_cube.toml"
        return ["ranging", cube, "--cubes", file, "--map-points", 41], ["map.png"]
    if schema.startswith("retrace.turn"):
        return ["turn", file], ["maps.png", "profile.svg"]
    if schema.startswith("retrace.plan"):
        return ["plane", file], ["profile.svg"]
    if file.suffix == ".txt" and file.name != "CMakeLists.txt":
        return ["metrology", file] + (["--edge", "--cutoff-um", 20] if "edge" in file.name else []), ["metrology.png"]
    return None, []


def picture(file, text, name):
    """Draws an example unless its picture is newer than the example and the program. Returns the file of the
    picture."""
    command, liked = question(file, text)
    if command is None:
        return None
    folder = PICTURES / name.replace("/", "_")
    newest = max(file.stat().st_mtime, PROGRAM.stat().st_mtime)
    for attempt in (0, 1):
        for kind in liked:
            drawn = folder / kind
            if drawn.exists() and drawn.stat().st_mtime >= newest:
                return drawn
        if attempt == 0:
            run(PROGRAM, *command, "--quiet", "--out", folder)
    faults.append(f"{name}: no picture by: retrace {' '.join(map(str, command))}")
    return None


def example_pages():
    cards = []
    for file in sorted((SOURCE / "examples").rglob("*")):
        if not file.is_file() or file.suffix not in (".toml", ".txt", ".csv", ".slurm", ".pgm", ".ies"):
            continue
        path = file.relative_to(SOURCE)
        text = file.read_text(errors="replace")
        name = str(path.relative_to("examples").with_suffix(""))
        drawn = picture(file, text, name)
        title = value_of(text, "title") or f"`{path}`"
        page = [f"# {title}", "", f"`{path}`", ""]
        if drawn:
            kept = f"{path.name}{drawn.suffix}"
            (PAGES / path.parent).mkdir(parents=True, exist_ok=True)
            shutil.copy(drawn, PAGES / path.parent / kept)
            of = " of its design" if value_of(text, "schema") == "retrace.study/1" else ""
            page += [f"![{title.strip('`')}: picture{of}]({kept})", ""]
            card = posixpath.relpath(f"{path.parent}/{kept}", "examples")
            cards.append(f'[![]({card}){{ loading=lazy }} {title}]({path.relative_to("examples")}.md)\n')
        shown = shown_file(path) if file.suffix != ".pgm" else "\n\n"
        write(f"{path}.md", "\n".join(page) + "\n" + shown.split("\n", 2)[2])
    write("examples/README.md", "# Examples\n\nEvery design, study and part of the folder `examples/`, with a picture "
          "that retrace makes of it; of a study, that of its design. What the program does with them is in the "
          "[gallery](../docs/gallery.md).\n\n<div class=\"examples\" markdown>\n\n" + "\n".join(cards) + "\n</div>\n")


def notebook_pages():
    """Runs the notebooks and writes their pages. A notebook is run only if it or the package is newer than its page."""
    package = PROGRAM.parent.parent / "python"
    newest_of_package = max((file.stat().st_mtime for file in (package / "retrace").iterdir()), default=0)
    for file in sorted((SOURCE / "examples/notebooks").glob("*.ipynb")):
        page = NOTEBOOKS / f"{file.stem}.md"
        if not page.exists() or page.stat().st_mtime < max(file.stat().st_mtime, newest_of_package):
            made = subprocess.run(
                [sys.executable, "-m", "nbconvert", "--to", "markdown", "--execute", "--log-level", "ERROR",
                 "--output-dir", NOTEBOOKS, file], check=False, text=True, capture_output=True, cwd=file.parent,
                env={**os.environ, "PYTHONPATH": str(package), "PYDEVD_DISABLE_FILE_VALIDATION": "1"})
            if made.returncode != 0:
                faults.append(f"{file.relative_to(SOURCE)}: {made.stderr.strip().splitlines()[-1]}")
                continue
        path = file.relative_to(SOURCE)
        write(f"{path}.md", page.read_text() + f"\nThe notebook is `{path}`.\n")
        pictures = NOTEBOOKS / f"{file.stem}_files"
        if pictures.exists():
            shutil.copytree(pictures, PAGES / path.parent / pictures.name)


FRONT = """\
<iframe class="live" src="explore.html" title="A prism array with the exact engine: change it and watch its light"></iframe>

[The page by itself](explore.html); `retrace explore` writes it, with a design of yours in it.

"""


def front_page():
    """Creates the live page, which is the start of the site."""
    made = run(PROGRAM, "explore", "--quiet", "--out", PAGES / "explore.html")
    if made.returncode != 0:
        faults.append(f"explore.html: {made.stderr.strip()}")


def document_page():
    """Creates the page that lists all JSON documents, from the output of the program."""
    manual = json.loads(run(PROGRAM, "manual", "--json", "-").stdout)
    formats = json.loads(run(PROGRAM, "schema", "--json", "-").stdout)["formats"]
    lines = ["# JSON documents", "", "What commands write with `--json` and into their output folders. Each document names "
             "its `schema`; the keys stand with the command.", "", "| document | written by |", "|---|---|"]
    writers = {}
    for command in manual["commands"]:
        for schema in command["writes"]:
            writers.setdefault(schema, []).append(command["name"])
    for schema, names in sorted(writers.items()):
        links = ", ".join(f"[{name}](commands/{name}.md)" for name in names)
        lines.append(f"| `{schema}` | {links} |")
    lines += ["", "## File formats", "", "`retrace schema FORMAT` prints a JSON Schema of a file format, for editors and "
              "validators. FORMAT is one of:", ""]
    lines += [f"- `{entry if isinstance(entry, str) else entry.get('format', entry.get('name', ''))}`" for entry in formats]
    write("docs/json_documents.md", "\n".join(lines) + "\n")


# --- The site ---------------------------------------------------------------------------------------------------------

def named_pages(entries):
    """Returns the pages and patterns of a list of entries, including the entries of its second level."""
    named = set()
    for entry in entries:
        named |= {entry} if isinstance(entry, str) else {page for inner in entry.values() for page in named_pages(inner)}
    return named


def pages_of(entries, named):
    """Returns the entries of the navigation for a list of pages, patterns and dictionaries of these."""
    pages = []
    for entry in entries:
        if isinstance(entry, dict):
            pages += [{title: pages_of(inner, named)} for title, inner in entry.items()]
            continue
        found = [entry] if "*" not in entry else sorted(
            str(file.relative_to(PAGES)) for file in PAGES.glob(entry)
            if str(file.relative_to(PAGES)) not in named)
        pages += ["index.md" if page == "README.md" else page for page in found
                  if page == "README.md" or (PAGES / page).exists()]
    return pages


def navigation():
    named = {page for entries in SECTIONS.values() for page in named_pages(entries)}
    sections = []
    for title, entries in SECTIONS.items():
        pages = pages_of(entries, named)
        sections.append({title: pages if len(pages) > 1 else pages[0]})
    return sections


class Page(html.parser.HTMLParser):
    """Links, loaded files and anchors of an HTML page."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loads, self.anchors = [], [], set()
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors |= {values[key] for key in ("id", "name") if values.get(key)}
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        loaded = values.get("src") or (tag == "link" and values.get("rel") != "canonical" and values.get("href"))
        if loaded:
            self.loads.append(loaded)


def check():
    pages = {file: Page(file) for file in SITE.rglob("*.html")}
    for file, page in pages.items():
        name = file.relative_to(SITE)
        if name.name == "404.html":
            continue
        for loaded in page.loads:
            if re.match(r"(https?:)?//", loaded):
                faults.append(f"{name}: loads from a network: {loaded}")
        for link in page.links + page.loads:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or link.startswith("//"):
                continue
            goal = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            goal = goal / "index.html" if goal.is_dir() else goal
            if not goal.exists():
                faults.append(f"{name}: no such page: {link}")
            elif parts.fragment and goal in pages and urllib.parse.unquote(parts.fragment) not in pages[goal].anchors \
                    and parts.fragment != "__skip":
                faults.append(f"{name}: no such anchor: {link}")
    for file in SITE.rglob("*.css"):
        if re.search(r"url\(['\"]?(https?:)?//", file.read_text()):
            faults.append(f"{file.relative_to(SITE)}: loads from a network")
    return len(pages)


def main():
    shutil.rmtree(PAGES, ignore_errors=True)
    shutil.rmtree(SITE, ignore_errors=True)
    PAGES.mkdir(parents=True)
    (PAGES / "site.css").write_text(STYLE)
    copy_katex()
    example_pages()
    notebook_pages()
    document_page()
    front_page()
    pages = Pages()
    pages.want("README.md")
    for pattern in ("docs/**/*.md", "CONVENTIONS.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md",
                    "THIRD-PARTY-NOTICES.md"):
        for file in SOURCE.glob(pattern):
            pages.want(str(file.relative_to(SOURCE)))
    pages.gather()
    config = BUILD / "site.yml"
    (BUILD / "site_theme").mkdir(exist_ok=True)
    (BUILD / "site_theme/main.html").write_text(MAIN)
    config.write_text("INHERIT: " + json.dumps(str(SOURCE / "mkdocs.yml")) + "\n" +
                      "".join(f"{key}: {json.dumps(value)}\n" for key, value in (
                          ("docs_dir", str(PAGES)), ("site_dir", str(SITE)), ("nav", navigation()),
                          ("theme", {"custom_dir": str(BUILD / "site_theme")}))))
    built = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--config-file", str(config)], check=False)
    if built.returncode != 0:
        faults.append("mkdocs build --strict: see above")
    else:
        worker = next(SITE.glob("assets/javascripts/workers/search.*.js")).read_text()
        index = (SITE / "search/search_index.json").read_text()
        (SITE / "search/from_disk.js").write_text(FROM_DISK % (index, json.dumps(worker)))
    count = check()
    for fault in faults:
        print(f"site: {fault}", file=sys.stderr)
    print(f"{count} pages in {SITE}, {len(faults)} faults")
    return 1 if faults else 0


sys.exit(main())
