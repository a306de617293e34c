"""Makes a folder of results and its page with the program, for the tests of the page."""

import pathlib
import subprocess


def run(program, *arguments, codes=(0,)):
    """Runs retrace; its exit code must be one of `codes`."""
    done = subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in codes:
        raise AssertionError(f"retrace {' '.join(map(str, arguments))}: {done.returncode}: {done.stderr}")
    return done


def make_page(program, source, folder):
    """Makes results of optics, fabrication and verification in one folder, and writes their report.html."""
    folder = pathlib.Path(folder)
    results = folder / "study"
    design = pathlib.Path(source) / "examples" / "rtp_single_0p45mm.toml"
    run(program, "inspect", design, "-o", results, "--quiet")
    run(program, "rre", design, "--engine", "exact", "--incidence=-40:40:5", "--footprint", "--far-field",
        "-o", results, "--quiet")
    array = folder / "array.toml"
    array.write_text('[element]\nkind = "rtp"\nbase_mm = 1\nwidth_mm = 1\n[array]\nx_length_mm = 3\ny_length_mm = 2\n'
                     '[body]\nthickness_mm = 2\n')
    job = folder / "job.toml"
    run(program, "job", array, "--machine", "thesis", "--tool-width-mm", "1", "-o", job, "--quiet")
    run(program, "fabricate", job, "-o", results, "--quiet")
    program_text = next(results.glob("*.ngc"))
    run(program, "verify", job, program_text, "-o", results, "--quiet", codes=(0, 1))
    run(program, "report", results, "--title", "Study of a prism", "--quiet")
    return results / "report.html"


LONG_TITLE = "A_title_of_a_prism_without_a_blank_that_is_longer_than_a_narrow_screen_is_wide_and_longer_than_a_card"
PRISM = """title = "{}"
[element]
kind = "rtp"
base_mm = 0.45
width_mm = 0.45
[array]
arrangement = "single"
[body]
thickness_mm = 0.5
"""


def make_sheet_and_study(program, source, folder):
    """Makes a set-up sheet, and report.html of results of many kinds. One of the two designs has a long title."""
    folder = pathlib.Path(folder)
    make_page(program, source, folder)
    study = folder / "study"
    designs = [pathlib.Path(source) / "examples" / "rtp_single_0p45mm.toml", folder / "long.toml"]
    designs[1].write_text(PRISM.format(LONG_TITLE))
    run(program, "rre", *designs, "--engine", "exact", "--incidence=0,20", "--footprint", "--far-field", "-o",
        study / "both", "--quiet")
    run(program, "image", designs[1], "--detector", "--pixels", "40", "-o", study / "maps", "--quiet")
    run(program, "photometry", designs[1], "--standard", "r150", "--class", "IA", "--colour", "white", "--area-cm2", "30",
        "--no-advice", "-o", study / "test_points", "--quiet", codes=(0, 1))
    run(program, "forces", folder / "job.toml", "-o", study / "forces", "--quiet")
    run(program, "report", study, "--quiet")
    return study / "setup.html", study / "report.html"
