"""Studies from Python leave what the command leaves."""

import subprocess
from pathlib import Path

import checkdam
import pytest

STUDY = """title = "Two angles"
cases = ["slide.toml"]

[[axis]]
name = "angle_deg"
fields = ["gravity.inclination_deg"]
values = [35, 40]
"""


@pytest.fixture
def asked(slide: Path) -> Path:
    path = slide.parent / "angles.toml"
    path.write_text(STUDY)
    return path


def test_a_study_has_the_bytes_of_the_command(asked: Path, tmp_path: Path, command: str) -> None:
    news = []
    ours = checkdam.study(asked, tmp_path / "ours", progress=news.append)
    subprocess.run([command, "study", asked, "--out", tmp_path / "theirs"], capture_output=True, check=True)
    assert (tmp_path / "ours" / "runs.csv").read_bytes() == (tmp_path / "theirs" / "runs.csv").read_bytes()
    assert ours.complete and ours.runs.rows == 2 and list(ours.runs["angle_deg"]) == [35.0, 40.0]
    for angle, peak in zip((35, 40), ours.runs["peak_step_n"]):
        case = checkdam.load(asked.parent / "slide.toml")
        case["gravity.inclination_deg"] = angle
        # Tables have nine digits.
        assert abs(case.run().summary["barrier"]["peak_step_n"] - peak) < 1e-8 * peak
    assert list(ours.to_pandas()["ended"]) == list(ours.runs["ended"])
    assert news and news[-1]["total"] == 2
    assert checkdam.open_study(tmp_path / "ours").complete


def test_a_study_that_is_stopped_goes_on(asked: Path, tmp_path: Path) -> None:
    stopped = checkdam.study(asked, tmp_path / "out", threads=1, progress=lambda news: False)
    assert not stopped.complete and not checkdam.open_study(tmp_path / "out").complete
    assert checkdam.study(asked, tmp_path / "out").complete


def test_a_study_at_fault_says_where(asked: Path, tmp_path: Path) -> None:
    asked.write_text(STUDY.replace("inclination_deg\"]", "angle_deg\"]"))
    with pytest.raises(checkdam.CaseError, match="angle_deg"):
        checkdam.study(asked, tmp_path / "out")
    with pytest.raises(checkdam.CaseError, match="does not exist"):
        checkdam.study(tmp_path / "none.toml", tmp_path / "out")
