"""Errors of checkdam: the report that the command prints, and its parts as attributes."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, Dict, List, Optional

__all__ = ["CaseError", "CheckdamError", "Problem", "RunError"]

_HEAD = re.compile(r"^(error|warning): (.*)$")
_PLACE = re.compile(r"^\s*--> (.*?)(?::(\d+):(\d+))?$")
_NOTE = re.compile(r"^\s*= (allowed|fix): (.*)$")
_COUNT = re.compile(r"^\d+ problems in ")


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong with the input."""

    level: str
    """``"error"``, or ``"warning"`` for what is allowed and looks like a mistake."""
    what: str
    """What is wrong, in a sentence."""
    file: Optional[str] = None
    """The file at fault, as it was given."""
    line: Optional[int] = None
    """Its line, from 1; None if it is no one line."""
    column: Optional[int] = None
    """Its column, from 1."""
    value: Optional[str] = None
    """The value at fault, as it stands there."""
    allowed: Optional[str] = None
    """What is allowed."""
    fix: Optional[str] = None
    """What to do."""


def _problems(report: str) -> List[Problem]:
    """The problems of a report, in its order."""
    found: List[Dict[str, Any]] = []
    content = None
    for line in report.splitlines():
        head = _HEAD.match(line)
        if head:
            if not _COUNT.match(head[2]):
                found.append({"level": head[1], "what": head[2]})
            continue
        if not found:
            continue
        last = found[-1]
        place, note = _PLACE.match(line), _NOTE.match(line)
        if place and "file" not in last:
            last["file"] = place[1]
            if place[2]:
                last["line"], last["column"] = int(place[2]), int(place[3])
        elif note:
            last[note[1]] = note[2]
        elif re.match(r"^\s*\d+ \| ", line):
            content = line.split(" | ", 1)[1]
        elif re.match(r"^\s*\| +\^+$", line) and content is not None and "column" in last:
            start = last["column"] - 1
            last["value"] = content[start : start + line.count("^")]
    return [Problem(**p) for p in found]


class CheckdamError(Exception):
    """What checkdam could not do. ``str()`` gives the report, as the command prints it."""

    def __init__(self, report: str) -> None:
        super().__init__(report.rstrip())
        self.report: str = report.rstrip()
        #: All problems that were found, errors and warnings.
        self.problems: List[Problem] = _problems(report)

    def _first(self) -> Optional[Problem]:
        return next((p for p in self.problems if p.level == "error"), None)

    @property
    def file(self) -> Optional[str]:
        """The file at fault; that of the first problem, as are the other attributes."""
        first = self._first()
        return first.file if first else None

    @property
    def line(self) -> Optional[int]:
        """Its line, from 1."""
        first = self._first()
        return first.line if first else None

    @property
    def value(self) -> Optional[str]:
        """The value at fault."""
        first = self._first()
        return first.value if first else None

    @property
    def fix(self) -> Optional[str]:
        """What to do."""
        first = self._first()
        return first.fix if first else None


class CaseError(CheckdamError):
    """The input is at fault, and nothing was computed (exit code 2 of the command)."""


class RunError(CheckdamError):
    """A run or a study failed, or its files could not be written or read (exit code 3 of the command)."""
