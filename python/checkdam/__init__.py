"""Force of dry granular flow on barriers, by the material point method.

>>> import checkdam
>>> case = checkdam.load("validation/flume/40deg.toml")     # doctest: +SKIP
>>> case["grid.spacing_m"] = 0.02                           # doctest: +SKIP
>>> run = case.run()                                        # doctest: +SKIP
>>> run.summary["barrier"]["peak_20ms_n"]                   # doctest: +SKIP

Names end in their units. Results are those of the command ``checkdam``, to the last bit, for any number of threads.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any, Callable, Dict, List, Optional, Union

from . import _checkdam
from ._checkdam import Simulation, __version__
from .errors import CaseError, CheckdamError, Problem, RunError
from .results import Run, Study, Table, open_run, open_study

__all__ = [
    "Case",
    "CaseError",
    "CheckdamError",
    "Problem",
    "Run",
    "RunError",
    "Simulation",
    "Study",
    "Table",
    "__version__",
    "load",
    "open_run",
    "open_study",
    "study",
]

Path_ = Union[str, "os.PathLike[str]"]
#: Is told how far a run or a study is; what it returns is taken as "go on", but for ``False``.
Progress = Callable[[Dict[str, Any]], Optional[bool]]


class Case:
    """A case: what a case file says, and what was changed in it.

    Fields are named by their path, ``"materials.sand.young_pa"``; an element of a list by its name, ``"bodies.sand.mass_kg"``.
    What the file leaves out has its default. Keys and their meanings are in docs/reference/case.md.
    """

    def __init__(self, raw: _checkdam.Case) -> None:
        self._raw = raw

    def __getitem__(self, path: str) -> Any:
        """The value of a field, or its default."""
        return self._raw[path]

    def __setitem__(self, path: str, value: Any) -> None:
        """Changes a field.

        Raises CaseError at once for a field that does not exist or another type. Values are checked by check() and run(), since
        some fit together only once all are set.
        """
        self._raw[path] = value

    def __delitem__(self, path: str) -> None:
        """Takes a field out, so that it has its default."""
        del self._raw[path]

    def __repr__(self) -> str:
        return repr(self._raw)

    def check(self) -> List[str]:
        """Checks all values; returns warnings, as the command prints them. Raises CaseError."""
        return self._raw.check()

    def to_toml(self) -> str:
        """The text of a case file, with all defaults. Raises CaseError if the case cannot be run."""
        return self._raw.to_toml()

    def copy(self) -> "Case":
        """A case of its own with the same values."""
        return Case(self._raw.copy())

    def run(
        self,
        out: Optional[Path_] = None,
        *,
        threads: Optional[int] = None,
        force: bool = False,
        progress: Optional[Progress] = None,
    ) -> Run:
        """Runs the case, with the interpreter's lock released.

        out: folder for the files of the run, new or empty; None: a temporary one, which is gone when the Run is.
        threads: any number gives the same bits; None: all processors.
        force: replace what an earlier run left in the folder.
        progress: called some times a second with ``stage``, ``time_s`` and ``end_s`` within the stage, ``steps``, ``particles``,
            ``force_n`` on the barrier and ``residual_1``. Returning False ends the run in order.

        Ctrl-C ends the run in order and raises KeyboardInterrupt; what was computed is in the folder.
        Raises CaseError, or RunError if the run fails.
        """
        keeper = tempfile.TemporaryDirectory(prefix="checkdam-") if out is None else None
        folder = Path(keeper.name if keeper else os.fspath(out))  # type: ignore[arg-type]
        _checkdam.run(self._raw, str(folder), threads, force, progress)
        return Run(folder, keeper)

    def simulation(self) -> Simulation:
        """A simulation of the case to drive step by step; call its release() first. Raises CaseError."""
        return self._raw.simulation()


def load(path: Path_) -> Case:
    """Reads and checks a case file. Raises CaseError, whose attributes say file, line, value and fix."""
    return Case(_checkdam.load(os.fspath(path)))


def study(
    path: Path_,
    out: Optional[Path_] = None,
    *,
    threads: Optional[int] = None,
    progress: Optional[Progress] = None,
) -> Study:
    """Makes the runs of a study that are missing; a study that was stopped goes on.

    out: folder for the results; None: ``out/<name of the study file>``, as the command has it.
    threads: runs at a time; None: all processors.
    progress: called with ``finished``, ``total`` and ``run``; returning False drops the runs on the way and ends the study.

    Raises CaseError for a study or a case at fault, and RunError if files cannot be written.
    """
    folder = Path(os.fspath(out)) if out is not None else Path("out") / Path(os.fspath(path)).stem
    complete = _checkdam.study(os.fspath(path), str(folder), threads, progress)
    return Study(folder, complete)
