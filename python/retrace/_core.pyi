"""The library of retrace, for internal use by the package."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Progress = Callable[[float], object] | None
_Floats = NDArray[np.float64]
_Pictures = dict[str, tuple[dict[str, _Floats], Drawing]]

class CameraRequest:
    def __init__(self) -> None: ...
    distance_m: float
    observation_deg: float
    v_deg: float
    h_deg: float
    rotation_deg: float
    eye_mm: list[float] | None
    lamp_mm: list[float] | None
    lamp_arcmin: float
    pupil_arcmin: float
    illuminance_lx: float
    ambient_lx: float
    backlight_lx: float
    columns: int
    rows: int
    field_mm: float | None
    film_mm: list[float]
    cylinder_mm: float | None
    noise: float
    passes: int | None
    lamp: Path | str
    lamp_aim_deg: float
    seed: int

class Design:
    @staticmethod
    def load(file: Path | str, overrides: list[str], /) -> Design: ...
    @staticmethod
    def parse(text: str, source: str, overrides: list[str], /) -> Design: ...
    def replaced(self, overrides: list[str], /) -> Design: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def overrides(self) -> list[str]: ...
    @property
    def files(self) -> list[Path]: ...
    @property
    def warnings(self) -> list[str]: ...
    def json(self) -> str: ...

class DetectorRequest:
    def __init__(self) -> None: ...
    incidence_deg: float
    azimuth_deg: float
    pixels: int
    angle_pixels: int
    window_deg: float
    engine: str
    cutoff: float | None
    samples: int | None
    seed: int

class Drawing:
    def __bool__(self) -> bool: ...
    def svg(self) -> str: ...
    def png(self) -> bytes: ...

class MaterialResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def complete(self) -> bool: ...

class ExportResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...

class Fabrication:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def programs(self) -> dict[str, str]: ...
    @property
    def roughing(self) -> Drawing: ...
    @property
    def finishing(self) -> Drawing: ...
    @property
    def arrangement(self) -> Drawing: ...

class FabricationRequest:
    def __init__(self) -> None: ...
    dialect: str
    phase: str
    from_element: int | None
    from_pass: int | None
    stop_every: int | None
    split_hours: float | None
    job_text: str | None

class ImageResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def complete(self) -> bool: ...

class Inspection:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def plan(self) -> Drawing: ...
    @property
    def section(self) -> Drawing: ...
    @property
    def front(self) -> Drawing: ...
    @property
    def view(self) -> Drawing: ...

class Job:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def text(self) -> str: ...
    @property
    def elements(self) -> int: ...
    @property
    def partial_elements(self) -> int: ...

class JobRequest:
    def __init__(self) -> None: ...
    machine: str
    tool_width_mm: float
    strategy: str
    process: str
    workpiece: str
    shrinkage_percent: float

class Metrology:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def surface_toml(self) -> str: ...
    @property
    def spectra_csv(self) -> str: ...
    @property
    def drawing(self) -> Drawing: ...
    @property
    def x_pixel_um(self) -> float: ...
    @property
    def y_pixel_um(self) -> float: ...

class MetrologyRequest:
    def __init__(self) -> None: ...
    form: str
    cutoff_um: float
    x_pixel_um: float | None
    y_pixel_um: float | None
    height_unit: str | None
    lateral_unit: str | None
    channel: int | None
    feed_mm_per_min: float | None
    edge: bool

class PhotometryRequest:
    def __init__(self) -> None: ...
    standard: str
    class_: str | None
    colour: str | None
    area_cm2: float
    rotation_deg: list[float] | None
    dye: str | None
    source_arcmin: float | None
    receiver_arcmin: float | None
    window_deg: float
    light: str
    engine: str
    cutoff: float | None
    samples: int | None
    seed: int
    diffraction: bool
    window_power: bool
    advice: bool
    pictures: bool

class PhotometryResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def complete(self) -> bool: ...
    @property
    def passes(self) -> bool: ...
    @property
    def csv(self) -> str: ...
    @property
    def far_field(self) -> Drawing: ...
    @property
    def observation(self) -> Drawing: ...

class RaysRequest:
    def __init__(self) -> None: ...
    source: Path | str
    emitter: str
    disc_mm: float | None
    half_angle_deg: float | None
    rays: int
    power: float
    incidence_deg: float | None
    azimuth_deg: float | None
    distance_mm: float | None
    at_mm: list[float] | None
    aim_mm: list[float] | None
    split: float
    cutoff: float
    stokes: bool
    keep_missed: bool
    out: Path | str
    seed: int

class RaysResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...

class RoadRequest:
    def __init__(self) -> None: ...
    distance_m: list[float]
    lamp_cd: float
    lamp: Path | str
    lamp_height_m: float
    lamp_aim_deg: float
    dye: str
    seed: int

class RreRequest:
    def __init__(self) -> None: ...
    incidence_deg: list[float]
    incidence_spans_deg: list[tuple[float, float]]
    azimuth_deg: list[float]
    engine: str
    target_error: float | None
    samples: int | None
    cutoff: float | None
    sampling: str
    seed: int
    derivatives: bool
    footprint: bool
    far_field: bool

class RreResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def complete(self) -> bool: ...
    @property
    def csv(self) -> str: ...
    @property
    def footprint(self) -> str: ...
    @property
    def far_field(self) -> str: ...
    @property
    def curve(self) -> Drawing: ...
    @property
    def footprint_map(self) -> Drawing: ...

class Study:
    def __init__(self, text: str, source: str, designs: dict[str, str], /) -> None: ...
    @staticmethod
    def load(file: Path | str, /) -> Study: ...
    @property
    def text(self) -> str: ...
    @property
    def source(self) -> str: ...
    @property
    def designs(self) -> dict[str, str]: ...

class StudyRequest:
    def __init__(self) -> None: ...
    overrides: list[str]
    seed: int
    store: Path | str
    if_exists: str

class StudyResult:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def complete(self) -> bool: ...
    @property
    def is_yes(self) -> bool: ...
    @property
    def csv(self) -> str: ...
    @property
    def drawing(self) -> Drawing: ...

class TraceRequest:
    def __init__(self) -> None: ...
    split: float
    cutoff: float
    keep_missed: bool
    seed: int

class TracedRays:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...

class Verification:
    @property
    def warnings(self) -> list[str]: ...
    @property
    def json(self) -> str: ...
    @property
    def table(self) -> str: ...
    @property
    def passes(self) -> bool: ...
    @property
    def verdict(self) -> str: ...
    @property
    def map(self) -> Drawing: ...

class MaterialRequest:
    def __init__(self) -> None: ...
    entrance_deg: float
    window_deg: float
    source_arcmin: float
    receiver_arcmin: float
    error: float
    most_directions: int

class VerificationRequest:
    def __init__(self) -> None: ...
    job: Path | str
    programs: list[str]
    dialect: str
    tolerance_nm: float | None
    standing: str
    as_machined: Path | str
    texts: dict[str, str]

def version() -> str: ...
def rre(
    designs: list[Design], request: RreRequest, progress: _Progress, threads: int, /
) -> RreResult: ...
def seconds_of_rre(designs: list[Design], request: RreRequest, /) -> float: ...
def photometry(
    design: Design, request: PhotometryRequest, progress: _Progress, threads: int, /
) -> PhotometryResult: ...
def inspect(design: Design, /) -> Inspection: ...
def export_solid(
    design: Design, file: Path | str, what: str, block_mm: float | None, /
) -> ExportResult: ...
def export_material(
    design: Design,
    file: Path | str,
    request: MaterialRequest,
    progress: _Progress,
    threads: int,
    /,
) -> MaterialResult: ...
def mesh(design: Design, what: str, block_mm: float | None, /) -> dict[str, Any]: ...
def make_job(design: Design, request: JobRequest, /) -> Job: ...
def fabricate(job: Path | str, request: FabricationRequest, /) -> Fabrication: ...
def write_as_machined(verification: Verification, design: Path | str, /) -> bool: ...
def verify(request: VerificationRequest, progress: _Progress, threads: int, /) -> Verification: ...
def sweep(
    study: Study, request: StudyRequest, progress: _Progress, threads: int, /
) -> StudyResult: ...
def tolerance(
    study: Study, request: StudyRequest, progress: _Progress, threads: int, /
) -> StudyResult: ...
def optimize(
    study: Study, request: StudyRequest, progress: _Progress, threads: int, /
) -> StudyResult: ...
def detector(
    design: Design, request: DetectorRequest, progress: _Progress, threads: int, /
) -> tuple[ImageResult, _Pictures]: ...
def camera(
    design: Design, request: CameraRequest, progress: _Progress, threads: int, /
) -> tuple[ImageResult, _Pictures]: ...
def road(
    design: Design, request: RoadRequest, progress: _Progress, threads: int, /
) -> tuple[ImageResult, _Pictures]: ...
def ray_accounts() -> list[str]: ...
def rays(
    design: Design, request: RaysRequest, progress: _Progress, threads: int, /
) -> RaysResult: ...
def trace(
    design: Design,
    origins: _Floats,
    directions: _Floats,
    stokes: _Floats,
    axes: _Floats,
    wavelengths: _Floats,
    request: TraceRequest,
    progress: _Progress,
    threads: int,
    /,
) -> tuple[TracedRays, dict[str, NDArray[Any]]]: ...
def measure_file(
    file: Path | str, request: MetrologyRequest, /
) -> tuple[Metrology, tuple[_Floats, _Floats, _Floats]]: ...
def measure_heights(
    heights: _Floats, request: MetrologyRequest, /
) -> tuple[Metrology, tuple[_Floats, _Floats, _Floats]]: ...
def report_page(
    parts: list[tuple[str, str | bytes]], title: str, readable: list[str], /
) -> tuple[str, list[str]]: ...
