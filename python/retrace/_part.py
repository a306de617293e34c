"""Properties of a design: dimensions, drawings, solids."""

from __future__ import annotations

import enum
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arguments import PathLike, path, thread_count
from ._design import AnyDesign, design_of
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given
from ._results import Array, Result, needed

__all__ = [
    "ExportResult",
    "FaceKind",
    "Inspection",
    "MaterialResult",
    "Mesh",
    "export",
    "export_material",
    "inspect",
    "mesh",
]


class FaceKind(enum.IntEnum):
    """Types of faces of a part, used as labels of a mesh."""

    ENTRANCE = 0
    RETRO_FACET = 1
    FLAT_BACK = 2
    INNER_WALL = 3
    BORDER_WALL = 4
    SIDE = 5


class Mesh:
    """A closed triangle mesh in the part frame. To unpack it: `vertices, faces, labels = mesh`.

    The arrays use the memory of the library and are read-only."""

    vertices_mm: Array  #: (n, 3)
    faces: NDArray[np.uint32]  #: (m, 3), counter-clockwise as seen from outside
    labels: NDArray[np.int32]  #: (m,), values of FaceKind
    volume_mm3: float
    area_mm2: float
    is_manifold: bool  #: true if no edge is shared by more than two triangles
    warnings: tuple[str, ...]

    def __init__(self, made: dict[str, Any]) -> None:
        self.vertices_mm = made["vertices_mm"]
        self.faces = made["triangles"]
        self.labels = made["kinds"]
        self.volume_mm3 = made["volume_mm3"]
        self.area_mm2 = made["area_mm2"]
        self.is_manifold = made["is_manifold"]
        self.warnings = tuple(made["warnings"])

    def __iter__(self) -> Iterator[Any]:
        return iter((self.vertices_mm, self.faces, self.labels))

    def to_trimesh(self) -> Any:
        """Returns a trimesh.Trimesh with the labels as a face attribute."""
        trimesh = needed("trimesh", "to_trimesh()")
        return trimesh.Trimesh(
            np.array(self.vertices_mm),
            np.array(self.faces, dtype=np.int64),
            process=False,
            face_attributes={"label": np.array(self.labels)},
        )

    def __repr__(self) -> str:
        return f"<Mesh: {len(self.faces)} triangles, {self.volume_mm3:.6g} mm3>"


class ExportResult(Result):
    """Result of writing a solid to a file."""

    _told = ("file", "triangles", "volume_mm3")


class MaterialResult(Result):
    """Result of writing a file with a material that reflects light in the same way as a part."""

    _told = ("file", "directions")


class Inspection(Result):
    """Properties of a design that need no ray tracing. The drawings are "plan", "section",
    "entrance_surface", "shells", "pin_axes" and "view"."""

    _told = ("elements_full", "element_depth_mm", "tir_limit_deg")

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("plan")


@described(FIELDS["solid"])
def mesh(
    design: AnyDesign,
    **fields: object,  # generated: keywords of the request solid
) -> Mesh:
    """Returns the solid of a design as a triangle mesh."""
    request = _core.SolidRequest()  # generated: sets the fields of the request solid
    return Mesh(_core.mesh(design_of(design)._core, request))


@described(FIELDS["solid"])
def export(
    design: AnyDesign,
    file: PathLike,
    **fields: object,  # generated: keywords of the request solid
) -> ExportResult:
    """Writes the solid of a design as STL, OBJ, glTF or STEP, like the command `retrace export`.
    The ending of the file name determines the format."""
    request = _core.SolidRequest()  # generated: sets the fields of the request solid
    return ExportResult(_core.export_solid(design_of(design)._core, path("file", file), request))


@described(FIELDS["material"])
def export_material(
    design: AnyDesign,
    file: PathLike,
    *,
    # generated: keywords of the request material
    threads: int | None = None,
    progress: Progress = None,
) -> MaterialResult:
    """Writes a material that reflects light in the same way as a part, like the command
    `retrace export`. Renderers and simulators can use the material. The formats are a table (.json
    and a .csv file), a BSDF for Radiance (.xml), and lobes in a shader (.glsl)."""
    taken = design_of(design)
    request = _core.MaterialRequest()  # generated: sets the fields of the request material
    count = thread_count(threads)
    with teller(progress, "material") as tell:
        return MaterialResult(
            _core.export_material(taken._core, path("file", file), request, tell, count)
        )


@described(FIELDS["inspect"])
def inspect(
    design: AnyDesign,
    **fields: object,  # generated: keywords of the request inspect
) -> Inspection:
    """Computes properties of a design that need no ray tracing, like the command `retrace inspect`.
    Examples are counts, areas, limits of total reflection, the smallest wall and the draft."""
    request = _core.InspectRequest()  # generated: sets the fields of the request inspect
    core = _core.inspect(design_of(design)._core, request)
    return Inspection(
        core,
        drawings={
            "plan": core.plan,
            "section": core.section,
            "entrance_surface": core.entrance_surface,
            "shells": core.shells,
            "pin_axes": core.pin_axes,
            "view": core.view,
        },
    )
