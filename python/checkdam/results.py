"""What a run or a study left: tables as numpy arrays, and the summary as a dictionary."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Optional, Union

import numpy as np

from ._checkdam import read_table, read_toml
from .errors import RunError

if TYPE_CHECKING:
    import pandas

__all__ = ["Run", "Study", "Table", "open_run", "open_study"]

#: A column: float64 with nan where a cell is empty, or texts.
Column = Union["np.ndarray[Any, np.dtype[np.float64]]", List[str]]


class Table(Mapping[str, Column]):
    """A table, by the names of its columns, which end in their units (``force_normal_n`` is in newton).

    The arrays are copies of what the file says; changing them changes no file.
    """

    def __init__(self, path: Union[str, Path]) -> None:
        self._columns: Dict[str, Column] = read_table(str(path))
        self.path = Path(path)

    def __getitem__(self, name: str) -> Column:
        if name not in self._columns:
            raise KeyError(f"{self.path.name} has no column `{name}`; it has {', '.join(self._columns)}")
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(next(iter(self._columns.values()), []))

    def to_pandas(self) -> "pandas.DataFrame":
        """The table as a data frame; needs pandas."""
        import pandas

        return pandas.DataFrame(self._columns)

    def __repr__(self) -> str:
        return f"<checkdam.Table {self.path.name}: {self.rows} rows of {', '.join(self._columns)}>"


class _Folder:
    def __init__(self, folder: Union[str, Path], keeper: Optional["tempfile.TemporaryDirectory[str]"] = None) -> None:
        #: Where the files are.
        self.folder = Path(folder)
        # A folder that nobody asked for goes with the last that reads it.
        self._keeper = keeper

    @property
    def tables(self) -> List[str]:
        """Names of the tables that are there: ``run["history"]`` reads ``history.csv``."""
        return sorted(p.stem for p in self.folder.glob("*.csv"))

    def __getitem__(self, name: str) -> Table:
        path = self.folder / f"{name}.csv"
        if not path.is_file():
            raise KeyError(f"there is no table `{name}`; there are {', '.join(self.tables)}")
        return Table(path)


class Run(_Folder):
    """A run that has ended, in whatever way."""

    def __init__(self, folder: Union[str, Path], keeper: Optional["tempfile.TemporaryDirectory[str]"] = None) -> None:
        super().__init__(folder, keeper)
        if not (self.folder / "summary.toml").is_file():
            raise RunError(f"error: {self.folder} is no folder of a run: it has no summary.toml")
        #: ``summary.toml`` as a dictionary; names end in their units.
        self.summary: Dict[str, Any] = read_toml(str(self.folder / "summary.toml"))

    @property
    def trusted(self) -> bool:
        """Whether the numbers are to be trusted; ``reasons`` says why not."""
        return bool(self.summary.get("trusted", False))

    @property
    def reasons(self) -> List[str]:
        """Why the numbers are not to be trusted; empty if they are."""
        return list(self.summary.get("reasons", []))

    @property
    def status(self) -> str:
        """How the run ended."""
        return str(self.summary["status"])

    @property
    def history(self) -> Table:
        """Samples of the gauges over time."""
        return self["history"]

    def __repr__(self) -> str:
        verdict = "trusted" if self.trusted else "NOT TO BE TRUSTED"
        return f"<checkdam.Run {self.folder}: {self.status}, {verdict}>"


class Study(_Folder):
    """A study, with the runs that it has."""

    def __init__(self, folder: Union[str, Path], complete: bool) -> None:
        super().__init__(folder)
        #: Whether every run is there and none failed.
        self.complete = complete

    @property
    def runs(self) -> Table:
        """One row per run: what was set, how it ended, whether it is trusted, what was measured."""
        return self["runs"]

    def to_pandas(self) -> "pandas.DataFrame":
        """The runs as a data frame; needs pandas."""
        return self.runs.to_pandas()

    def __repr__(self) -> str:
        return f"<checkdam.Study {self.folder}: {self.runs.rows} runs, {'complete' if self.complete else 'INCOMPLETE'}>"


def open_run(folder: Union[str, Path]) -> Run:
    """Reads the folder of a run that the command or Python made."""
    return Run(folder)


def open_study(folder: Union[str, Path]) -> Study:
    """Reads the folder of a study."""
    status = Path(folder) / "status.toml"
    told = read_toml(str(status)) if status.is_file() else {}
    return Study(folder, told.get("status") == "complete" and told.get("failed") == 0)
