"""Runs what users run, and writes the table of times between the marks in benchmarks/README.md.

    python3 benchmarks/user_commands.py build/release/bin/retrace --csv times.csv --write
    python3 benchmarks/user_commands.py build/release/bin/retrace --only verify

The script needs an idle machine with two cores for wall times. It takes less than ten minutes. Each command ends after a limit of time, as
if a user pressed Ctrl-C. A first answer is the first line that a command prints and that is neither a note nor a warning.

Options:
    --csv FILE      also writes the times as a table, for --before of a later run. With --only, the other rows of the file are kept
    --before FILE   times of an earlier program; the default is benchmarks/user_commands_before.csv
    --only WORD     runs only the rows whose names contain the word
    --limit-s S     time after which a command is interrupted, in s; on a busy machine, give more than the default of 45
    --no-plain      does not compare with plain Monte Carlo sampling
    --write         replaces the tables in benchmarks/README.md; otherwise, the tables are printed
"""

import argparse
import csv
import json
import os
import pathlib
import re
import selectors
import signal
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
README = SOURCE / "benchmarks/README.md"
BEFORE = SOURCE / "benchmarks/user_commands_before.csv"
TARGET_S = 10.0
LIMIT_S = 45.0
R150 = ["--standard", "r150", "--class", "IA", "--colour", "red", "--area-cm2", "30"]
NO_ANSWER = re.compile(r"^\s*$|^(note|warning|retrace):|^wrote ")


class Row:
    """Commands that are timed together. All paths are relative to a new folder that contains `examples`.

    files: contents of the files that the commands need. prepare: commands that are not timed."""

    def __init__(self, name, *commands, files=None, prepare=()):
        self.name = name
        self.commands = [command if isinstance(command, list) else command.split() for command in commands]
        self.files = files or {}
        self.prepare = [command.split() for command in prepare]


def examples(folder, schema="retrace.design/1"):
    """Returns the files of a folder of examples/ that have the given schema."""
    paths = sorted((SOURCE / "examples" / folder).glob("*.toml"))
    return [str(path.relative_to(SOURCE)) for path in paths if f'schema = "{schema}"' in path.read_text()]


def tutorial_file(page, name):
    """Returns the contents of the block of a tutorial that begins with the comment `# NAME`."""
    text = (SOURCE / "docs/tutorials" / page).read_text()
    for block in re.findall(r"^```\w+\n(.*?)^```", text, re.S | re.M):
        if block.startswith(f"# {name}\n"):
            return block
    raise SystemExit(f"docs/tutorials/{page} has no block {name}")


def prisms(size_mm, extent):
    return f'''schema = "retrace.design/1"
[element]
kind = "rtp"
base_mm = {size_mm}
width_mm = {size_mm}
[array]
{extent}
[body]
thickness_mm = 2.0
'''


def cubes(aperture_mm, size_mm, more=""):
    return f'''schema = "retrace.design/1"
[element]
kind = "hexagonal_icc"
aperture_mm = {aperture_mm}
[array]
arrangement = "honeycomb"
x_length_mm = {size_mm}
y_length_mm = {size_mm}
partial_elements = "omit"
[body]
thickness_mm = 2.0
{more}'''


SIZE_STUDY = '''schema = "retrace.study/1"
design = "bricks.toml"
[[parameter]]
key = ["element.base_mm", "element.width_mm"]
name = "size_mm"
from = 0.3
to = 2.0
[[quantity]]
kind = "rre"
[[quantity]]
kind = "machining_time_h"
[[constraint]]
quantity = "machining_time_h"
max = 24
[optimize]
maximize = "rre"
[machining]
tool_width_mm = 0.5
'''
BRICKS = '''schema = "retrace.design/1"
[element]
kind = "rtp"
base_mm = 0.5
width_mm = 0.5
[array]
arrangement = "offset"
x_length_mm = 30
y_length_mm = 20
[body]
thickness_mm = 2.0
[surface]
root_radius_um = 5
roughness_sq_nm = 10
correlation_length_um = 5
'''


def programs_of(*designs, tool_width_mm, machine="ideal", options=""):
    """Returns the commands that make a job and an NC program of each design file."""
    commands = []
    for design in designs:
        commands.append(f"job {design}.toml --machine {machine} --tool-width-mm {tool_width_mm} {options} -o {design}_job.toml")
        commands.append(f"fabricate {design}_job.toml --dialect rs274ngc -o {design}_nc")
    return commands


def rows():
    """Returns what users do. Each thing is listed once, with the files that it needs."""
    designs = examples("") + examples("fronts") + examples("fabrication")
    slow = ["pin_bundle", "cats_eye_lenslets"]
    quick = [design for design in designs if not any(name in design for name in slow)]
    eight = [design for design in quick if "infinite" in design or "brick" in design][:8]
    finite = [design for design in quick if "infinite" not in (SOURCE / design).read_text() and "beads" not in design]
    layers = prisms(2.1, 'arrangement = "single"')
    sixteen = prisms(2.1, 'arrangement = "aligned"\nx_length_mm = 8.4\ny_length_mm = 8.4')
    return [
        Row("`rre` of each example", *[f"rre {design}" for design in quick]),
        Row("`rre` of the pin bundle", "rre examples/pin_bundle.toml"),
        Row("`rre` of lenslets with a curved face", "rre examples/fronts/cats_eye_lenslets.toml"),
        Row("`rre` of the lamp", "rre examples/lamp/lamp.toml"),
        Row("`rre` of prisms of the luminance fixture", "rre examples/luminance_fixture/uspic_rtp.toml"),
        Row("`rre` of pins of the luminance fixture", "rre examples/luminance_fixture/pin_bundle_icc.toml"),
        Row("`rre` of eight designs, angles chosen by `auto`", ["rre", *eight, "--incidence=-40:40:auto"]),
        Row("`rre` of cubes with rounded edges", "rre examples/reflex_reflector.toml "
            "--set surface.root_radius_um=5 --set surface.rim_radius_um=5"),
        Row("`rre --map`", "rre examples/honeycomb_infinite.toml --map"),
        Row("`rre --derivatives`, `--footprint`", "rre examples/reflex_reflector.toml --derivatives",
            "rre examples/honeycomb_infinite.toml --engine exact --cutoff 1e-6 --incidence=0,10,20 --footprint -o footprint"),
        Row("`inspect` of each example", *[f"inspect {design}" for design in designs + ["examples/lamp/lamp.toml"]]),
        Row("`export` of each example", *[f"export {design} part.stl" for design in finite]),
        Row("`photometry` with advice", ["photometry", "examples/reflex_reflector.toml", *R150],
            ["photometry", "examples/sunk_reflector.toml", *R150], ["photometry", "examples/zoned_reflector.toml", *R150]),
        Row("`photometry` of a finite honeycomb with advice", ["photometry", "cubes.toml", *R150],
            files={"cubes.toml": cubes(2.5, 20, "[surface]\ndihedral_error_arcmin = 0.75\n")}),
        Row("`photometry` behind a curved lens", ["photometry", "examples/lamp/lamp.toml", *R150[:-1], "17.4"]),
        Row("`roughness`", "roughness examples/rtp_brick_1mm.toml"),
        Row("`image --camera` of the tail lamp", "image examples/tail_lamp_100cm2.toml --camera"),
        Row("`image --road`", "image examples/reflex_reflector.toml --road --dye red"),
        Row("`image --detector`", "image examples/rtp_brick_0p5mm.toml --detector"),
        Row("`ranging`", "ranging examples/round_cube.toml",
            "ranging examples/round_cube.toml --cubes examples/ranging/sphere.toml --orbit-km 5860 --incidence 40 --pulse-ps 50 --shots 1000"),
        Row("`rays`", "rays examples/reflex_reflector.toml --emitter lambertian --disc-mm 1 --half-angle-deg 20 "
            "--distance-mm 30 -o returned.tm25ray"),
        Row("`forces`", "forces one_job.toml --configuration orthogonal", files={"one.toml": layers},
            prepare=programs_of("one", tool_width_mm=1.2, machine="thesis")[:1]),
        Row("`sweep` of the array size and of cells", "sweep examples/studies/table1.toml",
            *[f"sweep examples/studies/cells_{kind}.toml" for kind in ("hexagonal", "rtp", "triangular")]),
        Row("`sweep` of the incline", "sweep examples/studies/incline.toml"),
        Row("`sweep` of photometry", "sweep examples/studies/sink_reflector.toml", "sweep margins.toml",
            files={"margins.toml": tutorial_file("regulation.md", "my_margins.toml"),
                   "my_reflector.toml": tutorial_file("regulation.md", "my_reflector.toml")}),
        Row("`sweep` of photometry and incline", "sweep examples/studies/incline_photometry.toml"),
        Row("`optimize` of the examples", "optimize examples/studies/element_size.toml", "optimize examples/studies/element_base.toml"),
        Row("`optimize` with noise", "optimize size.toml", files={"size.toml": SIZE_STUDY, "bricks.toml": BRICKS}),
        Row("`compose`", "compose examples/studies/compose_reflector.toml"),
        Row("`compose` with the edges of tools", "compose examples/studies/compose_reflector.toml "
            "--set surface.root_chamfer_um=5 --set surface.rim_chamfer_um=5"),
        Row("`tolerance` of a prism", "tolerance examples/studies/tolerance_prism.toml"),
        Row("`tolerance` of a reflector", "tolerance examples/studies/tolerance_reflector.toml"),
        Row("`job` and `fabricate` of prisms", *programs_of("bricks", tool_width_mm=0.5), files={"bricks.toml": BRICKS.split("[surface]")[0]}),
        Row("`fabricate` of seven hexagons", "fabricate cubes_job.toml --dialect rs274ngc -o cubes_nc",
            files={"cubes.toml": cubes(2.0, 6)}, prepare=programs_of("cubes", tool_width_mm=1.7, machine="ideal-dmc", options="--strategy dmc")[:1]),
        Row("`verify` of one prism, 99 layers in 2 passes", "verify one_job.toml one_nc/program.ngc",
            files={"one.toml": layers}, prepare=programs_of("one", tool_width_mm=1.2, machine="thesis")),
        Row("`verify` of 16 prisms, 99 layers in 2 passes", "verify many_job.toml many_nc/program.ngc",
            files={"many.toml": sixteen}, prepare=programs_of("many", tool_width_mm=1.2, machine="thesis")),
        Row("`calibrate`", "calibrate examples/calibration/measurements.csv -o machine"),
        Row("`metrology`", "metrology examples/facet_height_map.txt --feed-mm-per-min 10",
            "metrology examples/edge_profile.txt --edge --cutoff-um 20"),
        Row("`turn`, `plane` of each example", *[f"turn {part}" for part in examples("turning", "retrace.turned_part/1")],
            *[f"plane {part}" for part in examples("planing", "retrace.planed_part/1")]),
        Row("`explore`, `validate`", "explore examples/honeycomb_infinite.toml -o page.html", "validate"),
    ]


class Run:
    """Times of one run of a program."""

    def __init__(self, processor_s, wall_s, first_s, is_cut_off, code):
        self.processor_s = processor_s
        self.wall_s = wall_s
        self.first_s = first_s
        self.is_cut_off = is_cut_off
        self.code = code


def run(program, arguments, folder, limit_s):
    """Runs a command. After limit_s, the command is interrupted as by Ctrl-C, and later killed."""
    start = time.monotonic()
    child = subprocess.Popen([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    ends = [(limit_s, signal.SIGINT), (limit_s + 5.0, signal.SIGKILL)]
    is_cut_off = False
    first_s = None
    streams = selectors.DefaultSelector()
    for stream in (child.stdout, child.stderr):
        os.set_blocking(stream.fileno(), False)
        streams.register(stream, selectors.EVENT_READ)
    while streams.get_map():
        for key, _ in streams.select(0.05):
            text = key.fileobj.read()
            if not text:
                streams.unregister(key.fileobj)
            elif first_s is None and any(not NO_ANSWER.match(line) for line in text.decode(errors="replace").splitlines()):
                first_s = time.monotonic() - start
        if ends and time.monotonic() - start > ends[0][0]:
            is_cut_off = True
            child.send_signal(ends.pop(0)[1])
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return Run(usage.ru_utime + usage.ru_stime, time.monotonic() - start, first_s, is_cut_off, child.returncode)


def measured(program, row, limit_s):
    """Runs the commands of a row. Returns the record of the row, with the times of the slowest command."""
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(SOURCE / "examples", pathlib.Path(folder) / "examples")
        for name, text in row.files.items():
            (pathlib.Path(folder) / name).write_text(text)
        for command in row.prepare:
            run(program, command, folder, limit_s)
        runs = [run(program, command, folder, limit_s) for command in row.commands]
    slowest = max(runs, key=lambda r: r.wall_s)
    for command, one in zip(row.commands, runs):
        if one.code not in (0, 1, 130):
            print(f"exit code {one.code}: {' '.join(command)}", file=sys.stderr)
    return {"name": row.name, "commands": len(runs), "processor_s": f"{sum(r.processor_s for r in runs):.2f}",
            "slowest_processor_s": f"{slowest.processor_s:.2f}", "slowest_wall_s": f"{slowest.wall_s:.2f}",
            "first_answer_s": "" if slowest.first_s is None else f"{slowest.first_s:.2f}", "is_cut_off": "yes" if slowest.is_cut_off else ""}


def time_text(record):
    """Returns the processor time of an earlier record. The mark `>` means that the command was interrupted."""
    is_cut_off = record.get("is_cut_off") or "interrupted" in record.get("source", "")
    return f"{'> ' if is_cut_off else ''}{float(record['processor_s']):.3g} s"


def table(records, before):
    """Returns the table of times in Markdown."""
    lines = ["| what | commands | processor, before | processor, all | processor, slowest | wall, slowest | first answer |",
             "|---|---|---|---|---|---|---|"]
    for record in records:
        more = "> " if record["is_cut_off"] else ""
        is_long = record["is_cut_off"] or float(record["slowest_wall_s"]) > TARGET_S
        first = f"{float(record['first_answer_s']):.1f} s" if is_long and record["first_answer_s"] else ""
        lines.append(f"| {record['name']} | {record['commands']} | {before.get(record['name'], '')} | {more}{float(record['processor_s']):.2f} s | "
                     f"{more}{float(record['slowest_processor_s']):.2f} s | {more}{float(record['slowest_wall_s']):.2f} s | {first} |")
    return "\n".join(lines)


def rre_of(program, folder, design, *options):
    """Returns the processor time of a run at one direction, and its standard error."""
    arguments = ["rre", design, "--incidence", "10", "--azimuth", "10", "--threads", "1", "--json", "rre.json", *options]
    one = run(program, arguments, folder, LIMIT_S)
    path = pathlib.Path(folder) / "rre.json"
    if one.code != 0:
        return None
    point = json.loads(path.read_text())["points"][0]
    return one.processor_s, point["std_error"], point["engine"]


def plain_table(program):
    """Returns the table that compares the default with plain Monte Carlo sampling.

    Both run at 10 degrees, azimuth 10. The error of plain sampling is taken from a fixed number of rays, and its time is
    scaled by the square of the ratio of both errors. The time that the program needs to start is subtracted."""
    lines = ["| design | engine | default | error | plain, to the same error | ratio |", "|---|---|---|---|---|---|"]
    ratios = []
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(SOURCE / "examples", pathlib.Path(folder) / "examples")
        starts_s = min(run(program, ["--version"], folder, LIMIT_S).processor_s for _ in range(5))
        for design in ("rtp_brick_0p5mm", "rtp_brick_1mm", "rtp_gaps", "honeycomb_infinite", "honeycomb_daylight", "triangular_infinite",
                       "reflex_reflector", "coated_bricks", "facet_quality", "soiled_bricks"):
            usual = rre_of(program, folder, f"examples/{design}.toml")
            plain = rre_of(program, folder, f"examples/{design}.toml", "--sampling", "plain", "--samples", "262144")
            if usual is None or plain is None or plain[1] == 0.0:
                lines.append(f"| `{design}` | | | | not comparable | |")
                continue
            usual_s = max(usual[0] - starts_s, 0.001)
            error = usual[1] or 1e-4
            plain_s = (plain[0] - starts_s) * (plain[1] / error) ** 2
            ratios.append(plain_s / usual_s)
            lines.append(f"| `{design}` | {usual[2]} | {1e3 * usual_s:.0f} ms | {error:.1e} | {plain_s:.2f} s | {plain_s / usual_s:.0f} |")
    ratios.sort()
    if ratios:
        lines.append("")
        lines.append(f"The median of the ratios is {ratios[len(ratios) // 2]:.0f}.")
    return "\n".join(lines)


def replace_between(text, mark, content):
    begin, end = f"<!-- {mark} -->\n", "<!-- end -->"
    first = text.index(begin) + len(begin)
    return text[:first] + "\n" + content + "\n\n" + text[text.index(end, first):]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--csv")
    parser.add_argument("--before", default=BEFORE)
    parser.add_argument("--only", default="")
    parser.add_argument("--limit-s", type=float, default=LIMIT_S)
    parser.add_argument("--no-plain", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    program = str(pathlib.Path(options.program).resolve())
    with open(options.before, newline="", encoding="utf-8") as file:
        before = {record["name"]: time_text(record) for record in csv.DictReader(file)}
    known = {}
    if options.only and options.csv and pathlib.Path(options.csv).exists():
        with open(options.csv, newline="", encoding="utf-8") as file:
            known = {record["name"]: record for record in csv.DictReader(file)}
    records = []
    for row in rows():
        if options.only in row.name:
            records.append(measured(program, row, options.limit_s))
            print(" ".join(str(value) for value in records[-1].values()), file=sys.stderr, flush=True)
        elif row.name in known:
            records.append(known[row.name])
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, records[0].keys())
            writer.writeheader()
            writer.writerows(records)
    times = table(records, before)
    plain = "" if options.no_plain else plain_table(program)
    if not options.write:
        print(times)
        print(plain)
        return
    text = replace_between(README.read_text(), "times of user commands", times)
    if plain:
        text = replace_between(text, "times of plain sampling", plain)
    README.write_text(text)


main()
