"""Results of ray tracing: efficiency, footprints, photometry."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._arguments import Numbers, number_list, thread_count
from ._design import AnyDesign, design_of, designs_of
from ._errors import InputError
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given
from ._results import Array, Columns, Result, dataset_of, frozen, html_table

__all__ = [
    "CoefficientMap",
    "Footprint",
    "PhotometryResult",
    "PolarMap",
    "RreResult",
    "footprint",
    "photometry",
    "rre",
]


class RreResult(Result):
    """Retroreflective efficiency (RRE) for several directions. Arrays have one value per point. The
    points are ordered by design, azimuth, incidence and acceptance cone."""

    _rows = "points"
    _told = ("title", "rre", "engine")

    rre: Array  #: retroreflected fraction of the incident power, 0 to 1
    std_error: Array
    incidence_deg: Array
    azimuth_deg: Array
    acceptance_half_angle_deg: Array
    ledger: Columns  #: fractions of the incident power by account; the sum is 1
    points: Columns
    engine: str
    complete: bool

    def __init__(self, core: Any) -> None:
        super().__init__(
            core,
            drawings={
                "rre": core.curve,
                "map": core.map,
                "map_difference": core.map_difference,
                "footprint": core.footprint_map,
            },
        )
        self._footprint: str = core.footprint
        self._far_field: str = core.far_field

    def __setstate__(self, state: dict[str, Any]) -> None:
        super().__setstate__(state)
        self._footprint = _core.current_document(self._footprint)

    @property
    def title(self) -> str:
        """Titles of the designs, or names of their files."""
        return ", ".join(
            str(design.get("title") or design.get("source", ""))
            for design in self.document["designs"]
        )

    @property
    def footprint(self) -> Footprint | None:
        """Regions of the entrance face that return light, or None if not requested."""
        return Footprint(self) if self._footprint else None

    @property
    def far_field(self) -> dict[str, Any] | None:
        """Far field as a dict: the directions in which light leaves. None if not requested."""
        return json.loads(self._far_field) if self._far_field else None

    def polar(self, design: int = 0, acceptance_half_angle_deg: float | None = None) -> PolarMap:
        """Returns the polar map of a design, if rre() was called with map=True.

        design: index in the list of designs. acceptance_half_angle_deg: acceptance cone; None: the
        narrowest one. Raises InputError if there is no such map."""
        maps = self.document.get("maps", [])
        if not maps:
            raise InputError("there are no maps; call rre() with map=True", key="design")
        keys = [(one["design"], one["acceptance_half_angle_deg"]) for one in maps]
        for one, (index, angle_deg) in zip(maps, keys):
            if index == design and acceptance_half_angle_deg in (None, angle_deg):
                return PolarMap(one)
        raise InputError(
            f"there is no such map; the maps have the designs and acceptance angles {keys}",
            key="design",
        )

    @property
    def engines(self) -> Any:
        """Engine that computed each point."""
        return self.points["engine"]

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset over design, azimuth, incidence and acceptance, with units.
        Values are NaN where a design has no point. This occurs if angles of incidence were chosen
        automatically, because they differ between designs. attrs contains the seed and the
        version."""
        dims = ["design", "azimuth_deg", "incidence_deg", "acceptance_half_angle_deg"]
        dataset = dataset_of(self.points, dims, {**self._attributes(), "title": self.title})
        return dataset.sortby("incidence_deg")

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("map" if "map" in self.drawings else "rre")


class PolarMap:
    """Retroreflective efficiency (RRE) of one design over incidence and azimuth."""

    design: int  #: index in the list of designs
    acceptance_half_angle_deg: float
    incidence_deg: Array  #: angles of incidence, ascending
    azimuth_deg: Array  #: azimuths from 0 to 360 degrees, ascending
    rre: Array  #: RRE as a fraction, with the shape (azimuths, incidences)
    std_error: Array  #: standard errors, in the same shape
    mean_rre: float  #: mean over the directions of the map, by solid angle

    def __init__(self, map: Mapping[str, Any]) -> None:
        """map: an element of the list `maps` of the document."""
        self.design = map["design"]
        self.acceptance_half_angle_deg = map["acceptance_half_angle_deg"]
        self.incidence_deg = frozen(map["incidence_deg"])
        self.azimuth_deg = frozen(map["azimuth_deg"])
        self.rre = frozen(map["rre"])
        self.std_error = frozen(map["std_error"])
        self.mean_rre = map["mean_rre"]

    def __repr__(self) -> str:
        return (
            f"<PolarMap: {len(self.azimuth_deg)} azimuths, {len(self.incidence_deg)} incidences, "
            f"mean_rre {self.mean_rre:.6g}>"
        )


class Footprint(Result):
    """Regions of the entrance face that return light, for all directions of a result."""

    _told = ("regions",)

    def __init__(self, rre: RreResult) -> None:
        super().__init__(json=rre._footprint, table=rre.table, warnings=rre.warnings)
        self.drawings = {
            name: drawing for name, drawing in rre.drawings.items() if name == "footprint"
        }
        #: Retroreflective efficiency (RRE) for the incident directions of this footprint.
        self.rre = rre

    @property
    def _features(self) -> list[dict[str, Any]]:
        features: list[dict[str, Any]] = self.document["features"]
        return features

    @property
    def regions(self) -> int:
        """Returns the number of regions."""
        return len(self._features)

    @property
    def polygons(self) -> list[Array]:
        """Outlines of the regions: (n, 2) arrays of x and y in mm. The first point is repeated at
        the end."""
        return [frozen(feature["geometry"]["coordinates"][0]) for feature in self._features]

    @property
    def holes(self) -> list[list[Array]]:
        """Holes in each region: (n, 2) arrays of x and y in mm. The first point is repeated at
        the end."""
        return [
            [frozen(ring) for ring in feature["geometry"]["coordinates"][1:]]
            for feature in self._features
        ]

    @property
    def efficiency(self) -> Array:
        """For each region, the fraction of its incident power that returns."""
        return frozen([feature["properties"]["efficiency"] for feature in self._features])

    @property
    def properties(self) -> Columns:
        """Direction of the incident light and design, for each region."""
        return Columns([feature["properties"] for feature in self._features])

    @property
    def geojson(self) -> dict[str, Any]:
        """The regions as a GeoJSON feature collection, in mm."""
        return self.document

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame with one row per region."""
        return self.properties.to_pandas()

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("footprint")


@described(FIELDS["rre"])
def rre(
    designs: AnyDesign | Sequence[AnyDesign],
    *,
    # generated: keywords of the request rre
    threads: int | None = None,
    progress: Progress = None,
) -> RreResult:
    """Computes the retroreflective efficiency (RRE) over angles of incidence and azimuths, with its
    standard error and a ledger of all other light, like the command `retrace rre`.

    designs: one or more designs or names of their files. incidence_spans_deg: ranges (from, to) in
    which additional angles of incidence are chosen automatically. Their number and values depend on
    the curve of each design. threads: maximum number of threads [all cores]."""
    taken = designs_of(designs)
    request = _core.RreRequest()  # generated: sets the fields of the request rre
    if incidence_deg is not None and len(incidence_spans_deg) == 0:
        number_list("incidence_deg", incidence_deg)  # refuses an empty list
    count = thread_count(threads)
    with teller(progress, "tracing") as tell:
        return RreResult(_core.rre([design._core for design in taken], request, tell, count))


@described(FIELDS["rre"])
def footprint(
    design: AnyDesign,
    *,
    incidence_deg: Numbers = 0.0,
    azimuth_deg: Numbers = 0.0,
    target_error: float | None = None,
    cutoff: float | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Footprint:
    """Computes the regions of the entrance face that return light, like the command `retrace rre
    --footprint`."""
    result = rre(
        design_of(design),
        incidence_deg=incidence_deg,
        azimuth_deg=azimuth_deg,
        footprint=True,
        target_error=target_error,
        cutoff=cutoff,
        threads=threads,
        progress=progress,
    )
    return Footprint(result)


class PhotometryResult(Result):
    """Coefficients of retroreflection at the test points of a standard. Arrays have one value per
    point."""

    _rows = "points"
    _told = ("verdict", "margin")

    verdict: str  #: pass, unconfirmed, undetermined or fail
    passes: bool  #: true if all points and the area pass, and the colour does not fail
    points: Columns
    complete: bool

    def __init__(self, core: Any) -> None:
        super().__init__(
            core,
            drawings={
                "far_field": core.far_field,
                "r_a": core.observation,
                "map": core.map,
                "map_ratio": core.map_ratio,
            },
        )
        self.passes = core.passes

    def coefficient_map(
        self,
        rotation_deg: float | None = None,
        presentation_deg: float | None = None,
        *,
        design: int = 0,
    ) -> CoefficientMap:
        """Returns the map of R_A over entrance and observation angle, if photometry() was called
        with map=True.

        rotation_deg, presentation_deg: angles of the map; None: any angle. design: 0 for the
        design, 1 for the compared design. The first map that satisfies these conditions is
        returned. Raises InputError if there is no such map."""
        maps = self.document.get("maps", [])
        if not maps:
            raise InputError("there are no maps; call photometry() with map=True", key="design")
        keys = [(one["design"], one["rotation_deg"], one["presentation_deg"]) for one in maps]
        for one, (index, rotation, presentation) in zip(maps, keys):
            is_asked = rotation_deg in (None, rotation) and presentation_deg in (None, presentation)
            if index == design and is_asked:
                return CoefficientMap(one, self.document["area_cm2"])
        raise InputError(
            f"there is no such map; the maps have the designs, rotations and presentation angles "
            f"{keys}",
            key="design",
        )

    def _repr_html_(self) -> str | None:
        names = (
            "observation_deg",
            "v_deg",
            "h_deg",
            "rotation_deg",
            "value_mcd_per_lx",
            "limit_mcd_per_lx",
            "margin",
            "verdict",
        )
        rows = [{name: row[name] for name in names if name in row} for row in self.points.rows]
        return html_table(rows) + f"<p>{self.verdict}</p>"


class CoefficientMap:
    """Coefficient of retroreflection R_A of one design over entrance and observation angle, at one
    rotation of the part and one presentation angle."""

    rotation_deg: float
    presentation_deg: float
    entrance_deg: Array  #: entrance angles, ascending
    observation_deg: Array  #: observation angles, ascending
    r_a: Array  #: R_A in cd/(lx m2), with the shape (entrance angles, observation angles)
    std_error: Array  #: standard errors of r_a, in the same shape
    r_i: Array  #: R_I of the part in mcd/lx, in the same shape
    lacks_diffraction: bool  #: true if diffraction is significant but not included

    def __init__(self, map: Mapping[str, Any], area_cm2: float) -> None:
        """map: element of the list `maps` of the JSON document. area_cm2: area of the part."""
        self.rotation_deg = map["rotation_deg"]
        self.presentation_deg = map["presentation_deg"]
        self.entrance_deg = frozen(map["entrance_deg"])
        self.observation_deg = frozen(map["observation_deg"])
        self.r_a = frozen(map["r_a_cd_per_lx_m2"])
        self.std_error = frozen(map["std_error_cd_per_lx_m2"])
        self.r_i = frozen(0.1 * area_cm2 * self.r_a)
        self.lacks_diffraction = map["lacks_diffraction"]

    def _check_grid(self, other: CoefficientMap) -> None:
        for name in ("entrance_deg", "observation_deg"):
            if not np.array_equal(getattr(self, name), getattr(other, name)):
                raise InputError(f"the maps must have the same {name}", key="other")

    def ratio(self, other: CoefficientMap) -> Array:
        """Returns R_A of this map divided by R_A of another map. Values are NaN where the other R_A
        is 0. Raises InputError if the maps have different angles."""
        self._check_grid(other)
        is_defined = other.r_a > 0
        return frozen(
            np.where(is_defined, self.r_a / np.where(is_defined, other.r_a, 1.0), np.nan)
        )

    def difference(self, other: CoefficientMap) -> Array:
        """Returns R_A of this map minus R_A of another map, in cd/(lx m2). Raises InputError if the
        maps have different angles."""
        self._check_grid(other)
        return frozen(self.r_a - other.r_a)

    def __repr__(self) -> str:
        return (
            f"<CoefficientMap: {len(self.entrance_deg)} entrance angles, "
            f"{len(self.observation_deg)} observation angles, r_a {self.r_a.min():.6g} to "
            f"{self.r_a.max():.6g}>"
        )


@described(FIELDS["photometry"])
def photometry(
    design: AnyDesign,
    *,
    compare: AnyDesign | None = None,
    # generated: keywords of the request photometry
    threads: int | None = None,
    progress: Progress = None,
) -> PhotometryResult:
    """Computes the coefficients of retroreflection at the test points of a standard, with limits
    and a verdict, like the command `retrace photometry`.

    compare: a second design, for maps of both designs and the drawing "map_ratio"; needs map=True.
    diffraction: False for the far field of geometrical optics, without diffraction. advice: True to
    suggest changes of the design if a point fails. pictures: True to make the drawings "far_field"
    and "r_a", which takes time."""
    taken = design_of(design)
    compared = None if compare is None else design_of(compare)._core
    request = _core.PhotometryRequest()  # generated: sets the fields of the request photometry
    count = thread_count(threads)
    with teller(progress, "tracing") as tell:
        return PhotometryResult(_core.photometry(taken._core, compared, request, tell, count))
