"""Pictures as seen by a detector, by a camera, and by a driver at night."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import _core
from ._arguments import Numbers, PathLike, thread_count
from ._design import AnyDesign, design_of, designs_of
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given, with_values
from ._results import Array, Drawing, Result, needed, unit_of

__all__ = ["ImageResult", "Picture", "camera", "camera_series", "detector", "road"]


class Picture(Mapping[str, Array]):
    """Channels of a picture by name: read-only (rows, columns) arrays, beginning with the top
    row."""

    def __init__(self, name: str, channels: dict[str, Array], drawing: Any) -> None:
        self.name = name
        self._channels = channels
        #: Drawing that displays this picture.
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
    """Pictures by the names of their files. A series also has the drawing "sheet", which shows all
    pictures next to each other."""

    _told = ("kind", "engine")

    pictures: dict[str, Picture]
    complete: bool

    def __init__(self, made: tuple[Any, dict[str, tuple[dict[str, Array], Any]]]) -> None:
        core, pictures = made
        drawings = {name: drawing for name, (_, drawing) in pictures.items()}
        if core.sheet:
            drawings["sheet"] = core.sheet
        super().__init__(core, drawings=drawings)
        self.pictures = {name: Picture(name, *content) for name, content in pictures.items()}

    def __getitem__(self, name: str) -> Picture:
        return self.pictures[name]

    def _repr_png_(self) -> bytes | None:
        picture = next(iter(self.pictures.values()), None)
        return picture._repr_png_() if picture is not None else None


@described(FIELDS["detector"])
def detector(
    design: AnyDesign,
    *,
    # generated: keywords of the request detector
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes maps of the returned light by position ("irradiance") and by direction ("angular"),
    like the command `retrace image --detector`."""
    request = _core.DetectorRequest()  # generated: sets the fields of the request detector
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "tracing") as tell:
        return ImageResult(_core.detector(taken._core, request, tell, count))


@described(FIELDS["camera"])
def camera(
    design: AnyDesign,
    *,
    # generated: keywords of the request camera
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes a camera picture of the part in the light of a lamp ("camera": luminance Y in
    cd/m2), like the command `retrace image --camera`. If the part is coloured, the picture also
    contains the tristimulus values X and Z, and the linear sRGB values R, G and B with the lamp as
    white, all in cd/m2.

    eye_mm, lamp_mm: positions, three numbers each. film_mm: two numbers. lamp: a photometric
    file. exposure_ev, tone, background: only for the drawing."""
    request = _core.CameraRequest()  # generated: sets the fields of the request camera
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "rendering") as tell:
        return ImageResult(_core.camera(taken._core, request, tell, count))


@described(FIELDS["camera"])
def camera_series(
    designs: AnyDesign | Sequence[AnyDesign],
    values: Mapping[str, Numbers] | None = None,
    *,
    # generated: keywords of the request camera
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes several camera pictures with the same exposure, like the command `retrace image
    --camera` with several designs or a list. The pictures are "camera_01", "camera_02" and so on.
    The drawing "sheet" shows all of them.

    designs: one design, or a list with one design for each picture. values: only for one
    design; a dict with one keyword of camera() and a list of its values, such as
    {"observation_deg": [0.2, 0.5]}. The keyword must be a number. There is one picture for each
    value. All other keywords are those of camera()."""
    request = _core.CameraRequest()  # generated: sets the fields of the request camera
    taken, count = designs_of(designs), thread_count(threads)
    requests = with_values(request, FIELDS["camera"], "values", values)
    with teller(progress, "rendering") as tell:
        return ImageResult(
            _core.camera_series([design._core for design in taken], requests, tell, count)
        )


@described(FIELDS["road"])
def road(
    design: AnyDesign,
    *,
    # generated: keywords of the request road
    threads: int | None = None,
    progress: Progress = None,
) -> ImageResult:
    """Computes a driver's view at night of a car ahead with two reflectors of the design, or of a
    sign, like the command `retrace image --road`. The picture "road" has the luminance Y, its
    components `reflected` (directly from the reflectors) and `veil` (scattered in the eye), and the
    linear sRGB values R, G and B with the lamp as white, all in cd/m2.

    reflector_mm, pixels: two numbers each. lamp: a photometric file. exposure_ev, tone: only for
    the drawing."""
    request = _core.RoadRequest()  # generated: sets the fields of the request road
    taken, count = design_of(design), thread_count(threads)
    with teller(progress, "tracing") as tell:
        return ImageResult(_core.road(taken._core, request, tell, count))
