"""Fabrication jobs, NC programs, and simulation of the surface that the programs cut."""

from __future__ import annotations

import os
import shutil
import tempfile
import weakref
from collections.abc import Mapping, Sequence
from typing import Any, Union

from . import _core
from ._arguments import PathLike, path, refuse, shown, thread_count
from ._design import AnyDesign, Design, design_of
from ._errors import InputError
from ._fields import FIELDS
from ._progress import Progress, teller
from ._request import described, given
from ._results import Columns, Result, html_table, write_file

__all__ = ["Fabrication", "Job", "Verification", "fabricate", "job", "verify"]

_IN_MEMORY = "job.toml"  # file name of jobs that are in memory


class Job(Result):
    """A fabrication job: the text of a job file."""

    _told = ("elements", "machine", "strategy")

    text: str  #: text of the job file
    elements: int  #: number of elements that are cut
    partial_elements: int  #: number of partial elements of the design, which the job omits

    def __init__(self, core: Any) -> None:
        super().__init__(core)
        self.text = core.text

    def save(self, file: PathLike) -> None:
        """Writes the job file."""
        write_file(path("file", file), self.text.encode())


class Fabrication(Result):
    """The NC programs of a job."""

    _told = ("elements", "time_s", "dialect")

    programs: dict[
        str, str
    ]  #: texts of the programs by file name, in the order of execution

    def __init__(self, core: Any) -> None:
        super().__init__(
            core,
            drawings={
                "roughing": core.roughing,
                "finishing": core.finishing,
                "arrangement": core.arrangement,
            },
        )
        self.programs = dict(core.programs)

    def save(self, file: PathLike) -> None:
        """Writes the programs to a folder."""
        folder = path("file", file)
        os.makedirs(folder, exist_ok=True)
        for name, text in self.programs.items():
            write_file(os.path.join(folder, name), text.encode())

    def _repr_svg_(self) -> str | None:
        return self._shown_drawing("finishing", "roughing")


#: A job, or the name of its file.
AnyJob = Union[Job, PathLike]
#: NC programs: the result of fabricate(), a mapping from names to texts, or names of files in the
#: order of execution. A name can have the form FILE@LINE, which means that the program was stopped
#: after this line.
AnyPrograms = Union[Fabrication, Mapping[str, str], PathLike, Sequence[PathLike]]


class _Folder:
    """A temporary folder that is deleted together with this object."""

    def __init__(self) -> None:
        self.name = tempfile.mkdtemp(prefix="retrace-")
        weakref.finalize(self, shutil.rmtree, self.name, ignore_errors=True)


class Verification(Result):
    """Result of a simulation: the surface that NC programs cut, compared with their job."""

    _told = ("verdict",)
    _costly = ("map",)

    verdict: str  #: pass, incomplete or fail
    passes: bool

    def __init__(self, core: Any, request: Any) -> None:
        super().__init__(core, drawings={"map": core.map})
        self.passes = core.passes
        self._core: Any = core
        self._asked = {
            "job": str(request.job),
            "programs": list(request.programs),
            "dialect": request.dialect,
            "tolerance_nm": request.tolerance_nm,
            "next_stage": request.next_stage,
            "texts": dict(request.texts),
        }

    @property
    def findings(self) -> Columns:
        """Errors of the programs, with the columns kind, program, line, message, value and limit.
        An error is something that is not allowed, or something required that is missing."""
        names = ("kind", "program", "line", "message", "value", "limit")
        return Columns(self.document.get("findings", []), names)

    @property
    def as_machined(self) -> Design:
        """The machined part as a design. If this result was unpickled, the programs are
        simulated again."""
        folder = _Folder()
        file = os.path.join(folder.name, "as_machined.toml")
        if self._core is None:
            request = _core.VerificationRequest()
            for name, value in self._asked.items():
                # Objects that were pickled by former versions contain the former name of the field
                # next_stage.
                setattr(request, "next_stage" if name == "standing" else name, value)
            self._core = _core.verify(request, None, 0)
        _core.write_as_machined(self._core, file)
        # The design may refer to a table of facets in a separate file of this folder.
        return Design._of(_core.Design.load(file, []), keeps=folder)

    def __getstate__(self) -> dict[str, Any]:
        # The picture of the machined part is omitted, because it consists of many pixels.
        return {**super().__getstate__(), "drawings": {}, "_core": None}

    def _repr_html_(self) -> str | None:
        verdict = html_table([{"verdict": self.verdict, "findings": len(self.findings.rows)}])
        return verdict + (html_table(self.findings.rows) if self.findings.rows else "")


@described(FIELDS["job"])
def job(
    design: AnyDesign,
    **fields: object,  # generated: keywords of the request job
) -> Job:
    """Computes the fabrication job of a design, like the command `retrace job`."""
    request = _core.JobRequest()  # generated: sets the fields of the request job
    return Job(_core.make_job(design_of(design)._core, request))


def _job_file(value: object) -> tuple[str, str | None]:
    """Returns the file name of a job, and the text of the job if it is in memory."""
    if isinstance(value, Job):
        return _IN_MEMORY, value.text
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return path("job", value), None
    raise refuse("job", "a Job or the name of its file", value)


@described(FIELDS["fabrication"])
def fabricate(
    job: AnyJob,
    **fields: object,  # generated: keywords of the request fabrication
) -> Fabrication:
    """Computes the NC programs of a job and their machining time, like the command `retrace
    fabricate`."""
    name, text = _job_file(job)
    request = _core.FabricationRequest()  # generated: sets the fields of the request fabrication
    request.job_text = text
    return Fabrication(_core.fabricate(name, request))


def _programs(value: object) -> tuple[list[str], dict[str, str]]:
    """Returns the names of programs, and the texts of programs that are in memory."""
    if isinstance(value, Fabrication):
        return list(value.programs), dict(value.programs)
    if isinstance(value, Mapping):
        for name, text in value.items():
            if not isinstance(name, str) or not isinstance(text, str):
                raise InputError(
                    f"must be a dict of program texts by name, got {shown(value)}", key="programs"
                )
        return list(value), dict(value)
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return [path("programs", value)], {}
    if isinstance(value, (list, tuple)):
        return [path("programs", one) for one in value], {}
    raise refuse(
        "programs", "the result of fabricate(), a dict of texts by name, or names of files", value
    )


@described(FIELDS["verification"])
def verify(
    job: AnyJob,
    programs: AnyPrograms,
    *,
    # generated: keywords of the request verification
    threads: int | None = None,
    progress: Progress = None,
) -> Verification:
    """Simulates NC programs and compares the result with their job, like the command `retrace
    verify`."""
    name, text = _job_file(job)
    names, texts = _programs(programs)
    if not names:
        raise InputError("must be one or more, got none", key="programs")
    request = _core.VerificationRequest()  # generated: sets the fields of the request verification
    request.job = name
    request.programs = names
    request.texts = {**texts, **({} if text is None else {name: text})}
    count = thread_count(threads)
    with teller(progress, "cutting") as tell:
        return Verification(_core.verify(request, tell, count), request)
