"""retrace: optical ray tracing of retroreflectors, and NC programs that machine them.

    import retrace as rt
    design = rt.Design.load("honeycomb.toml").replace({"element.aperture_mm": 0.5})
    result = rt.rre(design, incidence_deg=[0, 10, 20])
    result.rre, result.ledger["transmitted"], result.to_pandas()

Names, units, defaults and numbers are the same as on the command line and in its JSON documents
(docs/python.md).
"""

from . import image
from ._core import version as _version
from ._design import Design
from ._errors import BudgetError, Error, InputError, OutputError
from ._fabrication import Fabrication, Job, Verification, fabricate, job, verify
from ._light import (
    CoefficientMap,
    Footprint,
    PhotometryResult,
    PolarMap,
    RreResult,
    footprint,
    photometry,
    rre,
)
from ._part import (
    ExportResult,
    FaceKind,
    Inspection,
    MaterialResult,
    Mesh,
    export,
    export_material,
    inspect,
    mesh,
)
from ._ranging import CrossSectionMap, RangingResult, ranging
from ._rays import RayAccount, RaysResult, TracedRays, rays, trace
from ._report import Page, report
from ._results import Columns, Drawing, Result
from ._studies import (
    FoundOptimum,
    Optimum,
    SweepResult,
    ToleranceResult,
    optimize,
    sweep,
    tolerance,
)
from ._surface import MetrologyResult, metrology

__version__: str = _version()

__all__ = [
    "BudgetError",
    "CoefficientMap",
    "Columns",
    "CrossSectionMap",
    "Design",
    "Drawing",
    "Error",
    "ExportResult",
    "Fabrication",
    "FaceKind",
    "Footprint",
    "FoundOptimum",
    "InputError",
    "Inspection",
    "Job",
    "MaterialResult",
    "Mesh",
    "MetrologyResult",
    "Optimum",
    "OutputError",
    "Page",
    "PhotometryResult",
    "PolarMap",
    "RangingResult",
    "RayAccount",
    "RaysResult",
    "Result",
    "RreResult",
    "SweepResult",
    "ToleranceResult",
    "TracedRays",
    "Verification",
    "export",
    "export_material",
    "fabricate",
    "footprint",
    "image",
    "inspect",
    "job",
    "mesh",
    "metrology",
    "optimize",
    "photometry",
    "ranging",
    "rays",
    "report",
    "rre",
    "sweep",
    "tolerance",
    "trace",
    "verify",
]
