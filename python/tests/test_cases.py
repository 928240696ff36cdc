"""Cases are read, changed and refused as the command does it."""

import os
from pathlib import Path

import checkdam
import numpy as np
import pytest


def test_fields_are_read_with_their_defaults(slide: Path) -> None:
    case = checkdam.load(slide)
    assert case["gravity.inclination_deg"] == 35
    assert case["bodies.sand.x_m"] == [-0.3, 0.0]
    assert case["boundaries.base.friction"] == 0.3
    assert case["numerics.cfl"] > 0
    with pytest.raises(KeyError, match="gravity.angle"):
        case["gravity.angle"]


def test_changes_arrive_in_the_run(slide: Path) -> None:
    case = checkdam.load(slide)
    twin = case.copy()
    case["gravity.inclination_deg"] = np.float64(40.0)
    case["bodies.sand.y_m"] = np.array([0.0, 0.1])
    assert (twin["gravity.inclination_deg"], case["gravity.inclination_deg"]) == (35, 40.0)
    text = case.to_toml()
    assert "inclination_deg = 40.0" in text and "spacing_m = 0.025" in text
    run = case.run(threads=1)
    assert "y_m = [" in (run.folder / "summary.toml").read_text()
    assert run.summary["case"]["gravity"]["inclination_deg"] == 40.0
    del case["output.vtk_interval_s"]
    assert "output.vtk_interval_s" not in case.to_toml()
    with pytest.raises(checkdam.CaseError, match="not there"):
        del case["output.vtk_interval_s"]


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("gravity.angle_deg", 45, "angle_deg"),
        ("gravity.inclination_deg", "steep", "inclination_deg"),
        ("bodies.gravel.x_m", [0, 1], "sand"),
        ("materials.sand.young_pa", {"a": 1}, "young_pa"),
    ],
)
def test_what_does_not_exist_is_refused_at_once(slide: Path, path: str, value: object, words: str) -> None:
    case = checkdam.load(slide)
    before = case.to_toml()
    with pytest.raises(checkdam.CaseError, match=words):
        case[path] = value
    assert case.to_toml() == before


def test_values_that_make_no_sense_are_refused_with_place_and_fix(slide: Path) -> None:
    case = checkdam.load(slide)
    case["materials.sand.density_kg_per_m3"] = -1500
    for refused in (case.check, case.run, case.simulation):
        with pytest.raises(checkdam.CaseError) as caught:
            refused()
        error = caught.value
        assert error.file == f"{slide} (changed)" and error.value == "-1500" and error.fix and error.line
        assert "density_kg_per_m3" in error.problems[0].what and error.problems[0].allowed
    with pytest.raises(TypeError, match="object"):
        case["grid.spacing_m"] = object()
    with pytest.raises(ValueError, match="too large"):
        case["grid.particles_per_cell"] = 2**70


def test_a_file_that_is_wrong_says_line_value_and_fix(slide: Path, tmp_path: Path) -> None:
    lines = slide.read_text().splitlines()
    lines[lines.index("friction_angle_deg = 31")] = "friction_angle_deg = 131"
    lines[lines.index("poisson = 0.3")] = "poisson = 0.7"
    slide.write_text("\n".join(lines))
    with pytest.raises(checkdam.CaseError) as caught:
        checkdam.load(slide)
    error = caught.value
    assert [p.line for p in error.problems if p.level == "error"] == [
        1 + lines.index("poisson = 0.7"),
        1 + lines.index("friction_angle_deg = 131"),
    ]
    assert error.file == str(slide) and error.value == "0.7" and error.fix
    with pytest.raises(checkdam.CaseError, match="does not exist") as missing:
        checkdam.load(tmp_path / "none.toml")
    assert missing.value.fix and missing.value.line is None
    assert isinstance(missing.value, checkdam.CheckdamError)


def test_files_are_looked_for_beside_the_case(slide: Path, tmp_path: Path) -> None:
    (tmp_path / "bed.csv").write_text("x_m,y_m\n-1,0\n0.1,0\n1,-0.05\n")
    old = slide.read_text()
    start = old.index('kind = "plane"')
    end = old.index("contact", start)
    new = old[:start] + 'kind = "polyline"\npoints_file = "bed.csv"\n' + old[end:]
    slide.write_text(new.replace('base = "base"\n', ""))
    where = os.getcwd()
    os.chdir("/")
    try:
        case = checkdam.load(slide)
        case["grid.spacing_m"] = 0.02
        assert case.check() is not None
    finally:
        os.chdir(where)
