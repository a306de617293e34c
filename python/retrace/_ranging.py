"""Cross sections and range corrections of cube corners for laser ranging."""

from __future__ import annotations

import csv
import io
from typing import Any

import numpy as np

from . import _core
from ._arguments import Numbers, PathLike, thread_count
from ._design import AnyDesign, design_of
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given
from ._results import Array, Columns, Result, dataset_of, frozen

__all__ = ["CrossSectionMap", "RangingResult", "ranging"]


def _columns(text: str) -> dict[str, Array]:
    """Returns the columns of a CSV table of numbers. Empty values are NaN."""
    rows = list(csv.reader(io.StringIO(text)))
    values = np.array([[float(value or "nan") for value in row] for row in rows[1:]])
    return {name: frozen(values[:, k]) for k, name in enumerate(rows[0])} if len(values) else {}


class CrossSectionMap:
    """Cross section of the first point over the far field. Angles are seen from the source. Each
    row of a map has one angle up, and each column has one angle to the right."""

    right_arcsec: Array  #: angles to the right from the direction to the source, ascending
    up_arcsec: Array  #: angles up from the direction to the source, ascending
    total_m2: Array  #: cross section of all returned light
    parallel_m2: Array  #: component with the transmitted polarisation; NaN if unpolarised
    crossed_m2: Array  #: component with the orthogonal polarisation; NaN if unpolarised

    def __init__(self, text: str) -> None:
        """text: table of the map as CSV."""
        columns = _columns(text)
        size = round(np.sqrt(len(columns["total_m2"])))
        self.right_arcsec = frozen(columns["right_arcsec"][:size])
        self.up_arcsec = frozen(columns["up_arcsec"][::size])
        self.total_m2 = frozen(columns["total_m2"].reshape(size, size))
        self.parallel_m2 = frozen(columns["parallel_m2"].reshape(size, size))
        self.crossed_m2 = frozen(columns["crossed_m2"].reshape(size, size))

    def __repr__(self) -> str:
        return (
            f"<CrossSectionMap: {len(self.up_arcsec)} x {len(self.right_arcsec)} directions, "
            f"total_m2 up to {self.total_m2.max():.6g}>"
        )


class RangingResult(Result):
    """Cross sections of a cube corner, or of an array of cube corners. The columns of `points` have
    one value for each wavelength and direction of light."""

    _rows = "points"
    _told = ("wavelength_nm",)

    points: Columns
    complete: bool
    cubes: dict[str, Array]  #: illuminated cubes of the first point; empty for a single cube
    response: dict[str, Array]  #: response of the first point to a pulse; empty without a pulse
    shots: dict[str, Array]  #: single shots of the first point; empty without shots

    def __init__(self, core: Any) -> None:
        super().__init__(
            core,
            drawings={"map": core.map, "rings": core.rings, "response": core.response},
        )
        self._map_csv: str = core.map_csv
        self.cubes = _columns(core.cubes_csv) if core.cubes_csv else {}
        self.response = _columns(core.response_csv) if core.response_csv else {}
        self.shots = _columns(core.shots_csv) if core.shots_csv else {}

    @property
    def map(self) -> CrossSectionMap | None:
        """Far field of the first point, or None if no light returns."""
        return CrossSectionMap(self._map_csv) if self._map_csv else None

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset over wavelength, incidence and azimuth."""
        return dataset_of(
            self.points, ["wavelength_nm", "incidence_deg", "azimuth_deg"], self._attributes()
        )

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("map")


@described(FIELDS["ranging"])
def ranging(
    design: AnyDesign,
    *,
    # generated: keywords of the request ranging
    threads: int | None = None,
    progress: Progress = None,
) -> RangingResult:
    """Computes the optical cross section and the range correction of a single cube corner, like the
    command `retrace ranging`. Diffraction and polarisation are included.

    cubes: file with the cubes of an array, which all have this design. threads: maximum number of
    threads [all cores]."""
    taken = design_of(design)
    request = _core.RangingRequest()  # generated: sets the fields of the request ranging
    count = thread_count(threads)
    with teller(progress, "tracing") as tell:
        return RangingResult(_core.ranging(taken._core, request, tell, count))
