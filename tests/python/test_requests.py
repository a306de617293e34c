"""Tests that program, library and package refuse a wrong request with the same message: the field,
the allowed values and the given value."""

import pathlib
import random
import tempfile
import unittest
from functools import partial

import program
import retrace as rt
from retrace import _core
from retrace._fields import FIELDS

BRICK = str(program.EXAMPLES / "rtp_brick_2mm.toml")
CUBE = str(program.EXAMPLES / "round_cube.toml")
RAYS = ["rays", BRICK, "--emitter=lambertian"]
HEIGHTS = str(program.EXAMPLES / "facet_height_map.txt")
STUDY = str(program.EXAMPLES / "studies/element_base.toml")
FOLDER = tempfile.TemporaryDirectory()
JOB = FOLDER.name + "/job.toml"
WIDTH = {"tool_width_mm": 0.4}
rt.job(BRICK, **WIDTH).save(JOB)
rt.fabricate(JOB).save(FOLDER.name)
PROGRAM = str(next(pathlib.Path(FOLDER.name).glob("*.ngc")))
STANDARD = {"standard": "r150", "class_": "IA", "colour": "red", "area_cm2": 30}
#: Contains three items for each request: a function of the package that takes only the fields of
#: the request, the request's type in the module _core, and the command-line arguments of the same
#: request, or None if the program does not support it.
CALLS = {
    "detector": (
        partial(rt.image.detector, BRICK),
        _core.DetectorRequest,
        ["image", BRICK, "--detector"],
    ),
    "camera": (partial(rt.image.camera, BRICK), _core.CameraRequest, ["image", BRICK, "--camera"]),
    "road": (
        partial(rt.image.road, BRICK, mount="sign"),
        _core.RoadRequest,
        ["image", BRICK, "--road", "--mount=sign"],
    ),
    "metrology": (partial(rt.metrology, HEIGHTS), _core.MetrologyRequest, ["metrology", HEIGHTS]),
    "inspect": (
        partial(rt.inspect, BRICK, min_draft_deg=1.0),
        _core.InspectRequest,
        ["inspect", BRICK, "--min-draft-deg=1"],
    ),
    "solid": (
        partial(rt.mesh, BRICK, what="mould"),
        _core.SolidRequest,
        ["export", BRICK, "-o", "part.stl", "--what=mould"],
    ),
    "material": (
        partial(rt.export_material, BRICK, "part.json"),
        _core.MaterialRequest,
        ["export", BRICK, "-o", "part.json"],
    ),
    "photometry": (
        partial(rt.photometry, BRICK, **STANDARD),
        _core.PhotometryRequest,
        ["photometry", BRICK, "--standard=r150", "--class=IA", "--colour=red", "--area-cm2=30"],
    ),
    "rre": (partial(rt.rre, BRICK), _core.RreRequest, ["rre", BRICK]),
    "job": (
        partial(rt.job, BRICK, **WIDTH),
        _core.JobRequest,
        ["job", BRICK, "--tool-width-mm=0.4"],
    ),
    "fabrication": (partial(rt.fabricate, JOB), _core.FabricationRequest, ["fabricate", JOB]),
    "verification": (
        partial(rt.verify, JOB, PROGRAM),
        _core.VerificationRequest,
        ["verify", JOB, PROGRAM],
    ),
    "study": (partial(rt.sweep, STUDY), _core.StudyRequest, None),
    "ranging": (
        partial(rt.ranging, CUBE, polarisation="linear"),
        _core.RangingRequest,
        ["ranging", CUBE, "--polarisation=linear"],
    ),
    "rays": (partial(rt.rays, BRICK, emitter="lambertian"), _core.RaysRequest, RAYS),
    "trace": (partial(rt.trace, BRICK, [[0, 0, 5]], [[0, 0, -1]]), _core.TraceRequest, None),
}


def wrong_value(chance, field):
    """Returns a random number, list or word that the field does not allow, or None."""
    signs = [sign for sign, bound in ((-1.0, ">"), (1.0, "<")) if bound in field["allowed"]]
    far = chance.choice(signs or [1.0]) * 10 ** chance.uniform(11, 300)
    if field["kind"] == "number":
        return far if signs else None
    if field["kind"] == "whole":
        return chance.choice((int(-(10 ** chance.uniform(0, 9))), 2**53 - chance.randrange(1000)))
    if field["kind"] == "numbers":
        return [abs(far)] * field["count"]
    if field["kind"] == "word":
        return "".join(chance.choice("abcxyz") for _ in range(chance.randrange(2, 9)))
    if field["kind"] == "number_or_numbers":
        return [-abs(far)]
    return None


def on_command_line(value, field):
    if isinstance(value, list):
        return ("x" if "x" in field["value"] else ",").join(map(repr, value))
    return str(value)


class Requests(unittest.TestCase):
    maxDiff = 2000

    def test_every_request_is_tested(self):
        names = {request["name"] for request in program.requests()}
        self.assertEqual(set(CALLS), names - {"roughness"})  # roughness exists only in the program
        self.assertEqual(names, set(FIELDS))

    def test_an_empty_list_is_a_default(self):
        empty = rt.rre(BRICK, incidence_spans_deg=[], engine="exact")
        self.assertEqual(empty.rre, rt.rre(BRICK, engine="exact").rre)

    def test_wrong_requests_get_the_same_answer(self):
        chance = random.Random(61)
        fields = [
            (request["name"], field)
            for request in program.requests()
            for field in request["fields"]
            if request["name"] in CALLS
            and "keyword" in field
            and all(one.get("is") != "given" for need in field.get("needs", []) for one in need)
            and wrong_value(chance, field) is not None
        ]
        for _ in range(200):
            name, field = chance.choice(fields)
            value = wrong_value(chance, field)
            call, request, arguments = CALLS[name]
            keyword = field["keyword"]
            with self.subTest(request=name, field=field["name"], value=value):
                with self.assertRaises(rt.InputError) as of_package:
                    call(**{keyword: tuple(value) if isinstance(value, list) else value})
                with self.assertRaises(rt.InputError) as of_library:
                    request().assign(field["name"], value)
                error = of_package.exception
                self.assertEqual(error.key, keyword)
                self.assertEqual(str(of_library.exception), str(error))
                if arguments is None or "option" not in field:
                    continue
                option = f"{field['option']}={on_command_line(value, field)}"
                others = [one for one in arguments if not one.startswith(field["option"] + "=")]
                code, _, err = program.run(*others, option)
                self.assertEqual(code, 2)
                self.assertEqual(err, f"retrace: {field['option']}: {error.message}\n")


if __name__ == "__main__":
    unittest.main()
