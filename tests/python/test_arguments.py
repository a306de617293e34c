"""Tests of wrong inputs. The message names the argument, or the file, line and key, and gives the
allowed values. The package never crashes."""

import math
import os
import random
import re
import unittest

import numpy as np

import program
import retrace as rt

PRISM = program.example("rtp_single_0p45mm.toml")
BRICK = program.example("rtp_brick_5mm.toml")
R150 = {"standard": "r150", "class_": "IA", "colour": "red", "area_cm2": 30}

# Function, arguments, keywords, and the key of the error.
TABLE = [
    (rt.rre, [PRISM], {"incidence_deg": "ten"}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": [1, "2"]}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": {"a": 1}}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": 90}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": math.nan}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": [0, math.inf]}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": np.zeros((2, 2))}, "incidence_deg"),
    (
        rt.rre,
        [PRISM],
        {"incidence_deg": np.array([1j])},
        "incidence_deg",
    ),
    (
        rt.rre,
        [PRISM],
        {"incidence_deg": np.array([True])},
        "incidence_deg",
    ),
    (
        rt.rre,
        [PRISM],
        {"incidence_deg": np.array(["2026-01-01"], "M8")},
        "incidence_deg",
    ),
    (rt.rre, [PRISM], {"incidence_deg": []}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": [[1], [2, 3]]}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": object()}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_deg": [10**400]}, "incidence_deg"),
    (rt.rre, [PRISM], {"incidence_spans_deg": [(3, 1)]}, "incidence_spans_deg"),
    (rt.rre, [PRISM], {"incidence_spans_deg": 3}, "incidence_spans_deg"),
    (rt.rre, [PRISM], {"azimuth_deg": "north"}, "azimuth_deg"),
    (rt.rre, [PRISM], {"engine": "exakt"}, "engine"),
    (rt.rre, [PRISM], {"engine": 3}, "engine"),
    (rt.rre, [PRISM], {"sampling": "random"}, "sampling"),
    (rt.rre, [PRISM], {"target_error": 2}, "target_error"),
    (rt.rre, [PRISM], {"target_error": True}, "target_error"),
    (
        rt.rre,
        [PRISM],
        {"target_error": 0.1, "samples": 10},
        "target_error",
    ),
    (rt.rre, [PRISM], {"samples": 0}, "samples"),
    (rt.rre, [PRISM], {"samples": 1.5}, "samples"),
    (rt.rre, [PRISM], {"samples": "100"}, "samples"),
    (rt.rre, [PRISM], {"cutoff": -1}, "cutoff"),
    (rt.rre, [PRISM], {"seed": -1}, "seed"),
    (rt.rre, [PRISM], {"seed": 2**32}, "seed"),
    (rt.rre, [PRISM], {"threads": 0}, "threads"),
    (rt.rre, [PRISM], {"footprint": 1}, "footprint"),
    (rt.rre, [PRISM], {"progress": 3}, "progress"),
    (rt.rre, [3], {}, "design"),
    (rt.rre, [[]], {}, "designs"),
    (rt.rre, ["none.toml"], {}, None),
    (rt.rre, [os.path.dirname(PRISM)], {}, None),
    (rt.rre, ["a\0b"], {}, "design"),
    (rt.rre, [b"design.toml"], {}, "design"),
    (rt.footprint, [program.example("rtp_brick_1mm.toml")], {"cutoff": 1}, "cutoff"),
    (rt.photometry, [PRISM], {**R150, "area_cm2": 0}, "area_cm2"),
    (rt.photometry, [PRISM], {**R150, "class_": "XX"}, "class_"),
    (rt.photometry, [PRISM], {**R150, "colour": 3}, "colour"),
    (rt.photometry, [PRISM], {**R150, "standard": "r151"}, "standard"),
    (rt.photometry, [PRISM], {**R150, "light": "b"}, "light"),
    (rt.photometry, [PRISM], {**R150, "rotation_deg": range(721)}, "rotation_deg"),
    (rt.mesh, [PRISM], {"what": "arrays"}, "what"),
    (rt.mesh, [BRICK], {"what": "mould", "block_mm": 0}, "block_mm"),
    (rt.mesh, [program.example("honeycomb_infinite.toml")], {}, None),
    (rt.export, [BRICK, "part.xyz"], {}, None),
    (rt.export, [BRICK, 3], {}, "file"),
    (rt.job, [BRICK], {"tool_width_mm": 0}, "tool_width_mm"),
    (rt.job, [BRICK], {"tool_width_mm": 1, "machine": "thesys"}, "machine"),
    (
        rt.job,
        [BRICK],
        {"tool_width_mm": 1, "workpiece": "mold"},
        "workpiece",
    ),
    (rt.job, [BRICK], {"tool_width_mm": 1, "strategy": "three-step"}, "strategy"),
    (rt.fabricate, ["none.toml"], {}, None),
    (rt.fabricate, [3], {}, "job"),
    (rt.fabricate, ["none.toml"], {"dialect": "fanux"}, "dialect"),
    (rt.verify, ["none.toml", []], {}, "programs"),
    (rt.verify, ["none.toml", {"a": 3}], {}, "programs"),
    (rt.verify, ["none.toml", 3], {}, "programs"),
    (rt.verify, ["none.toml", "a.ngc"], {"tolerance_nm": -1}, "tolerance_nm"),
    (rt.Design.load, [3], {}, "file"),
    (rt.Design.load, [PRISM, {"element.base_mm": -1}], {}, "element.base_mm"),
    (rt.Design.load, [PRISM, {"element.basemm": 1}], {}, "element.basemm"),
    (rt.Design.load, [PRISM, [1]], {}, "changes"),
    (rt.Design.load, [PRISM, {3: 1}], {}, None),
    (rt.Design.load, [PRISM, {"element.base_mm": math.nan}], {}, "element.base_mm"),
    (
        rt.Design.load,
        [PRISM, {"element.base_mm": object()}],
        {},
        "element.base_mm",
    ),
    (rt.Design.load, [PRISM, {"element.base_mm": 2**70}], {}, "element.base_mm"),
    (rt.Design.load, [PRISM, {"title": "\ud800"}], {}, None),
    (rt.Design.parse, [3], {}, "text"),
    (rt.Design.parse, ["element = ["], {}, None),
    (rt.Design.from_dict, [3], {}, "tables"),
    (rt.Design, [], {"element": {"kind": "prism"}}, "element.kind"),
    (rt.Design, [], {"element": 3}, "element"),
    (rt.Design, [], {"elements": {}}, "elements"),
]


class Arguments(unittest.TestCase):
    def test_bad_input(self):
        for function, arguments, keywords, key in TABLE:
            with self.subTest(function=function.__name__, arguments=arguments, keywords=keywords):
                with self.assertRaises(rt.InputError) as caught:
                    function(*arguments, **keywords)
                error = caught.exception
                self.assertIsInstance(error, ValueError)
                self.assertNotIn("\n", str(error))
                self.assertNotIn("--", str(error).replace("a--b", ""))
                if key is not None:
                    self.assertEqual(error.key, key)

    def test_unknown_keywords_say_the_nearest(self):
        for function, keyword, near in (
            (rt.rre, "incidence", "incidence_deg"),
            (rt.photometry, "class", "class_"),
            (rt.photometry, "color", "colour"),
            (rt.job, "tool_width", "tool_width_mm"),
        ):
            with self.assertRaisesRegex(TypeError, rf"\b{keyword}\b.*\b{near}\b"):
                function(PRISM, **{keyword: 1})

    def test_place_of_what_is_wrong_in_a_file(self):
        with self.assertRaises(rt.InputError) as caught:
            rt.Design.parse('schema = "retrace.design/1"\n[element]\nkind = "prism"\n', "my.toml")
        error = caught.exception
        self.assertEqual((error.file, error.line, error.key), ("my.toml", 3, "element.kind"))
        self.assertEqual(str(error), f"my.toml:3: element.kind: {error.message}")

    def test_numbers_of_any_kind(self):
        expected = rt.rre(PRISM, incidence_deg=[10]).rre
        for value in (
            10,
            10.0,
            np.float32(10),
            np.int8(10),
            np.array(10),
            np.array([10], np.uint16),
            (10,),
            range(10, 11),
            np.array([10, 0], np.float64)[::2],
        ):
            with self.subTest(value=repr(value)):
                np.testing.assert_array_equal(rt.rre(PRISM, incidence_deg=value).rre, expected)

    def test_errors(self):
        self.assertTrue(issubclass(rt.OutputError, OSError))
        self.assertTrue(issubclass(rt.BudgetError, RuntimeError))
        for error in (rt.InputError, rt.OutputError, rt.BudgetError):
            self.assertTrue(issubclass(error, rt.Error))
        with self.assertRaises(rt.OutputError):
            rt.export(BRICK, "no/such/folder/part.stl")

    def test_defaults_are_those_of_the_command_line(self):
        import inspect

        from retrace._arguments import thread_count

        self.assertEqual(thread_count(None), 0)
        for function in (rt.rre, rt.photometry, rt.mesh, rt.job, rt.fabricate, rt.verify):
            command = {"mesh": "export"}.get(function.__name__, function.__name__)
            shown = program.run(command, "--help")[1]
            options = dict(re.findall(r"^  --([a-z-]+) [^ =]+=(\S+)", shown, re.MULTILINE))
            compared = 0
            for name, parameter in inspect.signature(function).parameters.items():
                for option in (
                    name.replace("_", "-"),
                    name.removesuffix("_deg"),
                    name.removesuffix("_"),
                ):
                    if default := options.get(option):
                        compared += 1
                        self.assertEqual(str(parameter.default).removesuffix(".0"), default, name)
                        break
            self.assertGreater(compared, 0, function.__name__)


def anything(random_, depth=0):
    """Returns a random value, as it may occur in a dictionary."""
    kinds = [
        lambda: random_.choice(
            [
                None,
                True,
                False,
                0,
                1,
                -1,
                2**63,
                -(2**63),
                10**400,
                math.nan,
                math.inf,
                1e-320,
            ]
        ),
        lambda: random_.uniform(-10, 10),
        lambda: random_.choice(
            [
                "",
                "rtp",
                "offset",
                "\0",
                "\n",
                "\x7f",
                '"',
                "'''",
                "\\",
                "é",
                "\ud800",
                "[a]",
                "=" * 300,
            ]
        ),
        lambda: random_.choice(
            [object(), b"", {1}, 1j, np.float32(1), np.arange(3), np.array(["a"]), np.zeros((2, 2))]
        ),
    ]
    if depth < 4:
        kinds += [
            lambda: [anything(random_, depth + 1) for _ in range(random_.randrange(4))],
            lambda: {
                key(random_): anything(random_, depth + 1) for _ in range(random_.randrange(4))
            },
        ]
    return random_.choice(kinds)()


def key(random_):
    return random_.choice(
        ["kind", "base_mm", "width_mm", "", "a.b", "a b", "é", "]", "material", "thickness_mm", 3]
    )


class Fuzz(unittest.TestCase):
    def test_reader_of_dicts(self):
        """Every dictionary gives either a design or an InputError."""
        random_ = random.Random(1)
        tables = [
            "element",
            "array",
            "body",
            "light",
            "detector",
            "surface",
            "part",
            "entrance_surface",
            "substrate",
            "title",
            "schema",
        ]
        made = {"design": 0, "error": 0}
        for _ in range(3000):
            wanted = {
                "element": {"kind": "rtp", "base_mm": 2, "width_mm": 2},
                "array": {"arrangement": "single"},
                "body": {"thickness_mm": 1},
            }
            for _ in range(random_.randrange(3)):
                table = random_.choice(tables)
                if random_.random() < 0.5 and isinstance(wanted.get(table), dict):
                    wanted[table][key(random_)] = anything(random_)
                else:
                    wanted[table] = anything(random_)
            try:
                rt.Design.from_dict(wanted)
                made["design"] += 1
            except rt.InputError as error:
                self.assertNotIn("\n", str(error))
                made["error"] += 1
        self.assertGreater(min(made.values()), 100, made)

    def test_changes(self):
        random_ = random.Random(2)
        design = rt.Design.load(PRISM)
        names = list(_keys(design.document)) + [
            "x",
            "",
            "element",
            "a=b",
            "a\nb",
            "element.base_mm.x",
            "[0]",
        ]
        for _ in range(2000):
            try:
                design.replace({random_.choice(names): anything(random_)})
            except rt.InputError:
                pass

    def test_a_dict_within_itself(self):
        within = {}
        within["a"] = within
        with self.assertRaises(rt.InputError):
            rt.Design(element=within)


def _keys(tables, before=""):
    for name, value in tables.items():
        yield before + name
        if isinstance(value, dict):
            yield from _keys(value, before + name + ".")


if __name__ == "__main__":
    unittest.main()
