"""Pictures as seen by a detector, by a camera, and by a driver at night."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import _core
from ._arguments import (
    Numbers,
    PathLike,
    checked,
    give,
    number,
    number_list,
    path,
    thread_count,
    whole,
    word,
)
from ._design import AnyDesign, design_of
from ._errors import InputError
from ._options import OPTIONS
from ._progress import Progress, teller
from ._results import Array, Drawing, Result, needed, unit_of

__all__ = ["ImageResult", "Picture", "camera", "detector", "road"]

_NAMES = {"incidence_deg": "incidence", "azimuth_deg": "azimuth", "distance_m": "distance-m"}
_MOST = 2**32 - 1


class Picture(Mapping[str, Array]):
    """Channels of a picture by name: read-only (rows, columns) arrays, beginning with the top
    row."""

    def __init__(self, name: str, channels: dict[str, Array], drawing: Any) -> None:
        self.name = name
        self._channels = channels
        #: Drawing of the picture for viewing.
        self.drawing = Drawing(drawing)

    def __getitem__(self, channel: str) -> Array:
        return self._channels[channel]

    def __iter__(self) -> Any:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset over rows and columns."""
        xarray = needed("xarray", "to_xarray()")
        return xarray.Dataset(
            {
                name: (("row", "column"), values, {"units": unit_of(name)})
                for name, values in self.items()
            },
            attrs={"name": self.name},
        )

    def _repr_png_(self) -> bytes | None:
        return self.drawing.png if self.drawing.is_there else None

    def __repr__(self) -> str:
        rows, columns = next(iter(self.values())).shape
        return f"<Picture {self.name}: {columns} x {rows}, {', '.join(self)}>"


class ImageResult(Result):
    """Pictures by the names of their files."""

    _told = ("kind", "engine")

    pictures: dict[str, Picture]
    complete: bool

    def __init__(self, made: tuple[Any, dict[str, tuple[dict[str, Array], Any]]]) -> None:
        core, pictures = made
        super().__init__(core, drawings={name: drawing for name, (_, drawing) in pictures.items()})
        self.pictures = {name: Picture(name, *content) for name, content in pictures.items()}

    def __getitem__(self, name: str) -> Picture:
        return self.pictures[name]

    def _repr_png_(self) -> bytes | None:
        picture = next(iter(self.pictures.values()), None)
        return picture._repr_png_() if picture is not None else None


def _cutoff(request: Any, cutoff: float | None) -> None:
    if cutoff is not None:
        request.cutoff = number("cutoff", cutoff, 0, 1, low_included=False, high_included=False)


@checked(OPTIONS["image"], _NAMES)
def detector(
    design: AnyDesign,
    *,
    incidence_deg: float = 0.0,
    azimuth_deg: float = 0.0,
    pixels: int = 400,
    angle_pixels: int = 201,
    window_deg: float = 1.0,
    engine: str = "auto",
    cutoff: float | None = None,
    samples: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes maps of the returned light by position ("irradiance") and by direction ("angular"),
    as `retrace image --detector`."""
    request = give(
        _core.DetectorRequest(),
        incidence_deg=number(
            "incidence_deg", incidence_deg, -90, 90, low_included=False, high_included=False
        ),
        azimuth_deg=number("azimuth_deg", azimuth_deg),
        pixels=whole("pixels", pixels, 1, 8192),
        angle_pixels=whole("angle_pixels", angle_pixels, 1, 2049),
        window_deg=number("window_deg", window_deg, 0, 90, low_included=False),
        engine=word("engine", engine, ("auto", "exact", "montecarlo", "embree")),
        seed=whole("seed", seed, 0, _MOST),
    )
    if samples is not None:
        request.samples = whole("samples", samples, 1, _MOST)
    _cutoff(request, cutoff)
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "tracing") as tell:
        return ImageResult(_core.detector(taken._core, request, tell, count))


def _numbers(name: str, value: object, count: int) -> list[float]:
    numbers = number_list(name, value)
    if len(numbers) != count:
        raise InputError(f"must be {count} numbers, got {len(numbers)}", key=name)
    return numbers


@checked(OPTIONS["image"], _NAMES)
def camera(
    design: AnyDesign,
    *,
    distance_m: float = 10.0,
    observation_deg: float = 0.33,
    v_deg: float = 0.0,
    h_deg: float = 0.0,
    rotation_deg: float = 0.0,
    eye_mm: Numbers | None = None,
    lamp_mm: Numbers | None = None,
    lamp_arcmin: float = 10.0,
    pupil_arcmin: float = 10.0,
    illuminance_lx: float = 10.0,
    ambient_lx: float = 0.0,
    backlight_lx: float = 0.0,
    pixels: tuple[int, int] = (400, 300),
    field_mm: float | None = None,
    film_mm: Numbers = (100.0, 100.0),
    cylinder_mm: float | None = None,
    noise: float = 0.02,
    passes: int | None = None,
    lamp: PathLike | None = None,
    lamp_aim_deg: float = 0.0,
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes a camera picture of the part in the light of a lamp ("camera": luminance Y in
    cd/m2), as `retrace image --camera`.

    eye_mm, lamp_mm: positions, three numbers each. film_mm: two numbers. lamp: a photometric
    file."""
    if not isinstance(pixels, (tuple, list)) or len(pixels) != 2:
        raise InputError("must be a pair (columns, rows)", key="pixels")
    request = give(
        _core.CameraRequest(),
        **{
            name: number(name, value)
            for name, value in (
                ("distance_m", distance_m),
                ("observation_deg", observation_deg),
                ("v_deg", v_deg),
                ("h_deg", h_deg),
                ("rotation_deg", rotation_deg),
                ("lamp_arcmin", lamp_arcmin),
                ("pupil_arcmin", pupil_arcmin),
                ("illuminance_lx", illuminance_lx),
                ("ambient_lx", ambient_lx),
                ("backlight_lx", backlight_lx),
                ("noise", noise),
                ("lamp_aim_deg", lamp_aim_deg),
            )
        },
        columns=whole("pixels", pixels[0], 1, _MOST),
        rows=whole("pixels", pixels[1], 1, _MOST),
        seed=whole("seed", seed, 0, _MOST),
    )
    film = _numbers("film_mm", film_mm, 2)
    if film != [100.0, 100.0]:
        request.film_mm = film
    for name, place in (("eye_mm", eye_mm), ("lamp_mm", lamp_mm)):
        if place is not None:
            setattr(request, name, _numbers(name, place, 3))
    for name, length in (("field_mm", field_mm), ("cylinder_mm", cylinder_mm)):
        if length is not None:
            setattr(request, name, number(name, length))
    if passes is not None:
        request.passes = whole("passes", passes, 1, _MOST)
    if lamp is not None:
        request.lamp = path("lamp", lamp)
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "rendering") as tell:
        return ImageResult(_core.camera(taken._core, request, tell, count))


@checked(OPTIONS["image"], {"distance_m": "road-distance-m"})
def road(
    design: AnyDesign,
    *,
    distance_m: Numbers = (10.0, 30.0, 100.0),
    lamp_cd: float = 10000.0,
    lamp: PathLike | None = None,
    lamp_height_m: float = 0.65,
    lamp_aim_deg: float = 0.0,
    dye: str = "none",
    seed: int = 1,
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes a driver's view at night of a car ahead with two such reflectors ("road"), as
    `retrace image --road`."""
    request = give(
        _core.RoadRequest(),
        distance_m=number_list("distance_m", distance_m),
        lamp_cd=number("lamp_cd", lamp_cd, 0, low_included=False),
        lamp_height_m=number("lamp_height_m", lamp_height_m),
        lamp_aim_deg=number("lamp_aim_deg", lamp_aim_deg),
        dye=path("dye", dye),
        seed=whole("seed", seed, 0, _MOST),
    )
    if lamp is not None:
        request.lamp = path("lamp", lamp)
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "tracing") as tell:
        return ImageResult(_core.road(taken._core, request, tell, count))
