"""Evaluation of measured surfaces."""

from __future__ import annotations

from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arguments import Numbers, PathLike, path, refuse
from ._errors import InputError
from ._fields import FIELDS
from ._request import described, given
from ._results import Array, Result

__all__ = ["MetrologyResult", "metrology"]


class MetrologyResult(Result):
    """Roughness, waviness, dominant waves and edges of a surface. Maps are read-only (rows,
    columns) arrays with NaN where nothing was measured."""

    _told = ("roughness_sa_nm", "waviness_sa_nm")

    surface: dict[str, float]  #: keys of the table [surface] of a design with this surface
    surface_toml: str  #: table [surface] as text of a design file
    spectra_csv: str  #: power spectral densities
    heights_nm: Array  #: heights after removal of the form
    roughness_nm: Array
    waviness_nm: Array
    pixel_um: tuple[float, float]  #: spacing along x and y

    def __init__(self, made: tuple[Any, tuple[Array, Array, Array]]) -> None:
        core, (self.heights_nm, self.roughness_nm, self.waviness_nm) = made
        super().__init__(core, drawings={"metrology": core.drawing})
        self.surface_toml = core.surface_toml
        self.spectra_csv = core.spectra_csv
        self.pixel_um = (core.x_pixel_um, core.y_pixel_um)

    @property
    def changes(self) -> dict[str, float]:
        """Changes that give a design this surface: `design.replace(measured.changes)`."""
        return {
            f"surface.{name}": value for name, value in self.document.get("surface", {}).items()
        }

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("metrology")


def _heights(value: object) -> Array:
    """Converts heights in nm to an array whose rows are along x."""
    allowed = "the name of a file, or an array of heights in nm, each row a profile along x"
    try:
        heights = np.asarray(value)
    except Exception:  # __array__() of a foreign class may raise anything
        raise refuse("heights", allowed, value) from None
    if heights.dtype.kind not in "iuf" or heights.ndim not in (1, 2):
        raise InputError(
            f"must be {allowed}, got {heights.dtype} of shape {heights.shape}", key="heights"
        )
    heights = np.atleast_2d(heights).astype(float)
    if np.isinf(heights).any():
        raise InputError("must be finite, or NaN where nothing was measured", key="heights")
    return heights


@described(FIELDS["metrology"])
def metrology(
    heights: Union[PathLike, ArrayLike],
    **fields: object,  # generated: keywords of the request metrology
) -> MetrologyResult:
    """Computes roughness, waviness, dominant waves, scratches and edge radius of a measured height
    map or profile, like the command `retrace metrology`.

    heights: file (text, SDF, GSF or GWY), or an array of heights in nm, positive out of the
    material, NaN where nothing was measured. pixel_um: required for arrays; one number, or two for
    x and y."""
    request = _core.MetrologyRequest()  # generated: sets the fields of the request metrology
    if isinstance(heights, str) or hasattr(heights, "__fspath__"):
        return MetrologyResult(_core.measure_file(path("heights", heights), request))
    for name, value in (
        ("height_unit", height_unit),
        ("lateral_unit", lateral_unit),
        ("channel", channel),
    ):
        if value is not None:
            raise InputError("is only for files; heights in memory are in nm", key=name)
    return MetrologyResult(_core.measure_heights(_heights(heights), request))
