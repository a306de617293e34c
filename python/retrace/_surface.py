"""Measured surfaces."""

from __future__ import annotations

from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arguments import (
    Numbers,
    PathLike,
    checked,
    flag,
    give,
    number,
    number_list,
    path,
    refuse,
    whole,
    word,
)
from ._errors import InputError
from ._options import OPTIONS
from ._results import Array, Result

__all__ = ["MetrologyResult", "metrology"]

_UNITS = ("m", "mm", "um", "nm", "pm")


class MetrologyResult(Result):
    """Roughness, waviness, dominant waves and edges of a surface. Maps are read-only (rows,
    columns) arrays with NaN where nothing was measured."""

    _told = ("roughness_sa_nm", "waviness_sa_nm")

    surface: dict[str, float]  #: keys of the table [surface] of a design with this surface
    surface_toml: str  #: table [surface] as text of a design file
    spectra_csv: str  #: power spectral densities
    heights_nm: Array  #: heights without the form
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
    allowed = "the name of a file, or an array of heights in nm, one row a profile along x"
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


@checked(OPTIONS["metrology"])
def metrology(
    heights: Union[PathLike, ArrayLike],
    *,
    pixel_um: Numbers | None = None,
    form: str = "plane",
    cutoff_um: float = 80.0,
    height_unit: str | None = None,
    lateral_unit: str | None = None,
    channel: int | None = None,
    feed_mm_per_min: float | None = None,
    edge: bool = False,
) -> MetrologyResult:
    """Computes roughness, waviness, dominant waves, scratches and edge radius of a measured height
    map or profile, as `retrace metrology`.

    heights: file (text, SDF, GSF or GWY), or an array of heights in nm, positive out of the
    material, NaN where nothing was measured. pixel_um: required for arrays; one number, or two for
    x and y."""
    request = give(
        _core.MetrologyRequest(),
        form=word("form", form),
        edge=flag("edge", edge),
        cutoff_um=number("cutoff_um", cutoff_um, 0, low_included=False),
    )
    if pixel_um is not None:
        pixels = number_list("pixel_um", pixel_um, 0, included=False)
        if len(pixels) > 2:
            raise refuse("pixel_um", "one number, or two for x and y", pixel_um)
        request.x_pixel_um, request.y_pixel_um = pixels[0], pixels[-1]
    for name, unit in (("height_unit", height_unit), ("lateral_unit", lateral_unit)):
        if unit is not None:
            setattr(request, name, word(name, unit, _UNITS))
    if channel is not None:
        request.channel = whole("channel", channel, 0, 999999)
    if feed_mm_per_min is not None:
        request.feed_mm_per_min = number("feed_mm_per_min", feed_mm_per_min, 0, low_included=False)
    if isinstance(heights, str) or hasattr(heights, "__fspath__"):
        return MetrologyResult(_core.measure_file(path("heights", heights), request))
    for name, given in (
        ("height_unit", height_unit),
        ("lateral_unit", lateral_unit),
        ("channel", channel),
    ):
        if given is not None:
            raise InputError("is for files; heights in memory are in nm", key=name)
    return MetrologyResult(_core.measure_heights(_heights(heights), request))
