"""Traces rays through a part. The rays come from files, from an emitter or from arrays."""

from __future__ import annotations

import enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arguments import Numbers, PathLike, number_list, refuse, thread_count
from ._design import AnyDesign, design_of
from ._errors import InputError
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given
from ._results import Array, Result

__all__ = ["RayAccount", "RaysResult", "TracedRays", "rays", "trace"]


class RayAccount(enum.IntEnum):
    """Ledger account of a ray: how the ray left the part, or why it did not leave."""

    RETROREFLECTED = 0
    FRONT_SPECULAR = 1
    SCATTERED_OUT = 2
    RETURNED_ELSEWHERE = 3
    SIDE_EXIT = 4
    TRANSMITTED = 5
    ABSORBED = 6
    TRUNCATED = 7
    LOST = 8
    MISSED = 9


class RaysResult(Result):
    """Power of the rays by ledger account. If the argument `out` was given, this file contains
    the rays that left the part."""

    _told = ("rays", "power", "power_unit")

    ledger: dict[str, float]  #: fractions of the total power by account; the sum is 1
    power: float  #: total power of all rays
    complete: bool


class TracedRays(RaysResult):
    """All rays that left the part. Arrays have one row per ray, in the order of the incident
    rays."""

    power_out: Array  #: (m,) power of each ray
    origins: Array  #: (m, 3) points where rays left, in mm in the part frame
    directions: Array  #: (m, 3) unit vectors
    stokes: Array  #: (m, 4) Stokes parameters; the first is the power
    axes: Array  #: (m, 3) reference axes: the major axes of the polarisation ellipses
    wavelength_nm: Array  #: (m,)
    account: NDArray[np.uint8]  #: (m,) values of RayAccount
    incident: NDArray[np.uint64]  #: (m,) index of the incident ray

    def __init__(self, made: tuple[Any, dict[str, Any]]) -> None:
        core, arrays = made
        super().__init__(core)
        for name, array in arrays.items():
            setattr(self, name, array)
        self.power_out = self.stokes[:, 0]

    def __len__(self) -> int:
        return len(self.account)


def _array(name: str, values: object, width: int) -> Array:
    """Converts numbers to an array with rows of a given length."""
    allowed = f"an array of numbers of shape (n, {width})"
    try:
        array = np.asarray(values)
    except Exception:  # __array__() of a foreign class may raise anything
        raise refuse(name, allowed, values) from None
    if array.dtype.kind not in "iuf" or array.ndim != 2 or array.shape[1] != width:
        raise InputError(
            f"must be {allowed}, got shape {array.shape} of {array.dtype}", key=name
        ) from None
    return np.ascontiguousarray(array, dtype=np.float64)


def _stokes(stokes: object, count: int) -> Array:
    if np.shape(stokes) == (4,):  # type: ignore[arg-type]
        return np.array([number_list("stokes", stokes)])
    array = _array("stokes", stokes, 4)
    if len(array) != count:
        raise InputError(f"must have {count} rows, got {len(array)}", key="stokes")
    return array


@described(FIELDS["trace"])
def trace(
    design: AnyDesign,
    origins: ArrayLike,
    directions: ArrayLike,
    stokes: ArrayLike = (1.0, 0.0, 0.0, 0.0),
    *,
    axes: ArrayLike | None = None,
    wavelength_nm: Numbers | None = None,
    # generated: keywords of the request trace
    threads: int | None = None,
    progress: Progress = None,
) -> TracedRays:
    """Traces rays from arrays through a part, as `retrace rays` does for rays from files.

    origins, directions: (n, 3) arrays in mm in the part frame; directions may have any length
    above 0. stokes: (n, 4) array, or four numbers for all rays; the first number is the power.
    axes: (n, 3) array, reference axes of the Stokes parameters [+x, projected onto the plane
    perpendicular to each direction]. wavelength_nm: one number, or one per ray [wavelength of the
    design]."""
    taken = design_of(design)
    places = _array("origins", origins, 3)
    ways = _array("directions", directions, 3)
    if len(ways) != len(places):
        raise InputError(f"must have {len(places)} rows, got {len(ways)}", key="directions")
    along = np.empty((0, 3)) if axes is None else _array("axes", axes, 3)
    if axes is not None and len(along) != len(places):
        raise InputError(f"must have {len(places)} rows, got {len(along)}", key="axes")
    waves = np.empty(0)
    if wavelength_nm is not None:
        waves = np.asarray(wavelength_nm)
        if waves.dtype.kind not in "iuf" or waves.ndim > 1 or waves.size not in (1, len(places)):
            raise refuse(
                "wavelength_nm", f"a number, or a list of {len(places)} numbers", wavelength_nm
            )
        waves = np.ascontiguousarray(waves, dtype=np.float64).reshape(-1)
    request = _core.TraceRequest()  # generated: sets the fields of the request trace
    light = _stokes(stokes, len(places))
    count = thread_count(threads)
    with teller(progress, "tracing") as tell:
        return TracedRays(
            _core.trace(taken._core, places, ways, light, along, waves, request, tell, count)
        )


@described(FIELDS["rays"])
def rays(
    design: AnyDesign,
    *,
    # generated: keywords of the request rays
    threads: int | None = None,
    progress: Progress = None,
) -> RaysResult:
    """Traces the rays of a file or an emitter through a part, like the command `retrace rays`.

    out: file for the rays that leave, .tm25ray or .csv. If no file is given, only the power
    is summed."""
    taken = design_of(design)
    if (source is None) == (emitter is None):
        raise InputError("one of source and emitter must be given", key="source")
    request = _core.RaysRequest()  # generated: sets the fields of the request rays
    count = thread_count(threads)
    with teller(progress, "tracing") as tell:
        return RaysResult(_core.rays(taken._core, request, tell, count))
