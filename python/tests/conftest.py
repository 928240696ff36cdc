"""Cases that run within a second."""

from pathlib import Path

import pytest

#: Sand that slides down 0.2 m and strikes a wall: some hundred points.
SLIDE = """title = "Sand strikes a wall"

[gravity]
inclination_deg = 35

[grid]
spacing_m = 0.025
thickness_m = 0.2

[domain]
x_m = [-0.5, 0.6]
y_m = [-0.2, 0.5]

[materials.sand]
law = "drucker_prager"
density_kg_per_m3 = 1500
young_pa = 1.0e6
poisson = 0.3
friction_angle_deg = 31

[[bodies]]
name = "sand"
material = "sand"
x_m = [-0.3, 0.0]
y_m = [0.0, 0.2]

[[boundaries]]
name = "base"
kind = "plane"
point_m = [0.0, 0.0]
normal_deg = 90
contact = "coulomb"
friction = 0.3

[[boundaries]]
name = "wall"
kind = "wall"
foot_m = [0.2, 0.0]
height_m = 0.4
thickness_m = 0.1
material_side = "left"
contact = "smooth"

[stages.run]
end_time_s = 0.4

[gauges]
barrier = "wall"
base = "base"

[output]
vtk_interval_s = 0.1
"""


@pytest.fixture
def slide(tmp_path: Path) -> Path:
    path = tmp_path / "slide.toml"
    path.write_text(SLIDE)
    return path


@pytest.fixture
def command() -> str:
    """The command that the wheel has brought."""
    import shutil
    import sysconfig

    found = shutil.which("checkdam", path=sysconfig.get_path("scripts"))
    assert found, "the wheel has not brought the command"
    return found
