"""Runs from Python are those of the command, and what they left is read as it stands there."""

import csv
import gc
import math
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import checkdam
import numpy as np
import pytest


def files(folder: Path) -> dict:
    """Bytes of all files below a folder, by name."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file() and not p.name.startswith(".")}


def test_a_run_has_the_bits_of_the_command(slide: Path, tmp_path: Path, command: str) -> None:
    ours = checkdam.load(slide).run(tmp_path / "ours", threads=2)
    ended = subprocess.run([command, "run", slide, "--out", tmp_path / "theirs", "--threads", "1"], capture_output=True)
    assert ended.returncode == (0 if ours.trusted else 4), ended.stderr
    assert files(tmp_path / "ours") == files(tmp_path / "theirs")
    # The comparison sees a number that is off.
    other = checkdam.load(slide)
    other["materials.sand.friction_angle_deg"] = 32
    other.run(tmp_path / "other")
    assert files(tmp_path / "other")["history.csv"] != files(tmp_path / "ours")["history.csv"]


def test_the_summary_and_the_tables_are_those_of_the_files(slide: Path, tmp_path: Path) -> None:
    run = checkdam.load(slide).run(tmp_path / "out")
    assert run.folder == tmp_path / "out" and "history" in run.tables
    with open(tmp_path / "out" / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert run.history.rows == len(rows)
    for name in rows[0]:
        wanted = [float(row[name]) if row[name] else math.nan for row in rows]
        np.testing.assert_array_equal(run.history[name], wanted)
    text = (tmp_path / "out" / "summary.toml").read_text()
    assert f"peak_step_n = {run.summary['barrier']['peak_step_n']!r}" in text
    assert run.summary["barrier"]["peak_step_n"] >= run.history["force_normal_n"].max() > 0
    frame = run.history.to_pandas()
    assert list(frame.columns) == list(run.history) and len(frame) == len(rows)
    again = checkdam.open_run(tmp_path / "out")
    assert again.summary == run.summary and again.trusted == run.trusted and again.reasons == run.reasons
    with pytest.raises(KeyError, match="it has time_s"):
        run.history["force"]
    with pytest.raises(KeyError, match="there are .*energy"):
        run["forces"]


def test_without_a_folder_nothing_stays(slide: Path) -> None:
    run = checkdam.load(slide).run()
    folder = run.folder
    assert run.history.rows > 10 and folder.is_dir()
    del run
    gc.collect()
    assert not folder.exists()


def test_two_runs_at_once_do_not_mix(slide: Path) -> None:
    found = {}

    def make(angle: float) -> None:
        case = checkdam.load(slide)
        case["gravity.inclination_deg"] = angle
        found[angle] = case.run(threads=1).summary["barrier"]["peak_step_n"]

    threads = [threading.Thread(target=make, args=(angle,)) for angle in (35, 40)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    for angle, peak in found.items():
        alone = checkdam.load(slide)
        alone["gravity.inclination_deg"] = angle
        assert alone.run().summary["barrier"]["peak_step_n"] == peak
    assert found[40] != found[35]


def test_others_go_on_while_it_runs_and_progress_is_told(slide: Path) -> None:
    counted, news = [0], []
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    case = checkdam.load(slide)
    case["grid.spacing_m"] = 0.0125
    other.start()
    case.run(progress=news.append)
    done.set()
    other.join()
    assert counted[0] > 20
    assert news and {"stage", "time_s", "end_s", "steps", "particles", "force_n", "residual_1"} == set(news[0])
    assert news[-1]["steps"] >= news[0]["steps"] and news[0]["particles"] > 100


def test_progress_can_stop_a_run_and_break_it(slide: Path, tmp_path: Path) -> None:
    case = checkdam.load(slide)
    case["grid.spacing_m"] = 0.0125
    run = case.run(tmp_path / "stopped", progress=lambda p: False)
    assert "stopped" in run.status and not run.trusted

    def breaks(p: dict) -> None:
        raise ZeroDivisionError("ours")

    with pytest.raises(ZeroDivisionError, match="ours"):
        case.run(tmp_path / "broken", progress=breaks)
    assert "stopped" in checkdam.open_run(tmp_path / "broken").status


def test_ctrl_c_ends_a_run_in_order(slide: Path, tmp_path: Path) -> None:
    program = f"""
import checkdam
case = checkdam.load({str(slide)!r})
case["grid.spacing_m"] = 0.005
print("begins", flush=True)
try:
    case.run({str(tmp_path / "out")!r}, progress=lambda p: print("runs", flush=True))
except KeyboardInterrupt:
    print("heard", flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begins\n" and process.stdout.readline() == "runs\n"
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert "heard" in rest and process.returncode == 0
    assert "stopped" in checkdam.open_run(tmp_path / "out").status


def test_a_folder_is_not_overwritten(slide: Path, tmp_path: Path) -> None:
    case = checkdam.load(slide)
    first = case.run(tmp_path / "out")
    with pytest.raises(checkdam.CaseError, match="out"):
        case.run(tmp_path / "out")
    assert case.run(tmp_path / "out", force=True).summary == first.summary
    with pytest.raises(ValueError, match="threads = 0"):
        case.run(threads=0)
    with pytest.raises(checkdam.RunError, match="no folder of a run"):
        checkdam.open_run(tmp_path)


def test_the_command_of_the_wheel_ends_as_it_should(slide: Path, tmp_path: Path, command: str) -> None:
    slide.write_text(slide.read_text().replace("density_kg_per_m3 = 1500", "density_kg_per_m3 = -1500"))
    ended = subprocess.run([command, "run", slide, "--out", tmp_path / "out"], capture_output=True, text=True)
    assert ended.returncode == 2 and "density_kg_per_m3" in ended.stderr and not (tmp_path / "out").exists()
    version = subprocess.run([command, "--version"], capture_output=True, text=True).stdout
    assert version.split()[-1] == checkdam.__version__
