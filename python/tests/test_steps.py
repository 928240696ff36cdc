"""Stepping from Python: the same steps as in a run, and arrays that say what stands in the files."""

import gc
from pathlib import Path

import checkdam
import numpy as np
import pytest


@pytest.fixture
def simulation(slide: Path) -> checkdam.Simulation:
    return checkdam.load(slide).simulation()


def test_steps_are_those_of_a_run(slide: Path, simulation: checkdam.Simulation) -> None:
    case = checkdam.load(slide)
    case["numerics.opened_volume"] = case["numerics.opened_volume"]
    run = case.run()
    simulation.release()
    assert simulation.time_s == 0.0
    simulation.advance(run.summary["case"]["stages"]["run"]["end_time_s"])
    peak, time = simulation.barrier_peak
    barrier = run.summary["barrier"]
    assert (peak, time) == (barrier["peak_step_n"], barrier["peak_step_time_s"])
    energy = simulation.energy_j()
    last = {name: column[-1] for name, column in run["energy"].items()}
    for name in ("kinetic", "gravitational", "plastic", "elastic"):
        # Tables have nine digits, and their last row is up to ten samples old.
        assert abs(energy[name] - last[f"{name}_j"]) < 0.05 * abs(energy["initial"]) + 1e-6, name
    assert abs(energy["residual"]) < 0.02 * max(abs(energy["gravitational"]), abs(energy["plastic"]))


def test_points_are_whole_and_in_order(slide: Path, simulation: checkdam.Simulation) -> None:
    points = simulation.points()
    count = len(points["id"])
    assert simulation.bodies == ["sand"] and list(points["id"]) == sorted(points["id"])
    assert points["x_m"].shape == points["velocity_m_per_s"].shape == (count, 2) and points["stress_pa"].shape == (count, 4)
    assert np.isclose(points["mass_kg"].sum(), 1500 * 0.3 * 0.2 * 0.2, rtol=1e-12)
    np.testing.assert_allclose(points["x_m"].mean(axis=0), [-0.15, 0.1], atol=1e-12)
    with pytest.raises(KeyError, match="there are sand"):
        simulation.points("gravel")
    # Copies: what is changed in them stays there, and they outlive the simulation.
    points["x_m"][:] = 7.0
    again = simulation.points("sand")
    assert again["x_m"][:, 0].max() < 0.0
    del simulation
    gc.collect()
    assert again["x_m"].min() < -0.29


def test_momentum_of_the_points_is_what_gravity_and_boundaries_give(simulation: checkdam.Simulation) -> None:
    simulation.release()
    given = np.zeros(2)
    for _ in range(40):
        simulation.step()
        forces = simulation.boundary_forces_n()
        assert set(forces) == {"base", "wall"}
        given += sum(forces.values()) * simulation.time_step_s
    points = simulation.points()
    mass = points["mass_kg"][:, None]
    slope = np.radians(35)
    weight = mass.sum() * 9.81 * np.array([np.sin(slope), -np.cos(slope)])
    momentum = (mass * points["velocity_m_per_s"]).sum(axis=0)
    wanted = weight * simulation.time_s + given
    # Gravity's magnitude is that of the case.
    np.testing.assert_allclose(momentum, wanted, atol=2e-3 * np.linalg.norm(weight) * simulation.time_s)
    assert momentum[0] > 0 and simulation.steps == 40


def test_a_field_closes_with_the_points(simulation: checkdam.Simulation) -> None:
    simulation.release()
    simulation.step(50)
    field, points = simulation.field(), simulation.points()
    assert (field["fill_1"] > 0).all() and field["x_m"].shape[1] == 2
    assert abs(np.average(field["velocity_m_per_s"][:, 0]) - points["velocity_m_per_s"][:, 0].mean()) < 0.2
    volume = field["fill_1"].sum() * 0.025**2 * 0.2
    assert np.isclose(volume, (points["mass_kg"] * points["volume_ratio_1"]).sum() / 1500, rtol=1e-9)


def test_the_order_of_calls_is_told(simulation: checkdam.Simulation) -> None:
    with pytest.raises(RuntimeError, match="release"):
        simulation.step()
    with pytest.raises(RuntimeError, match="release"):
        simulation.energy_j()
    simulation.release()
    with pytest.raises(RuntimeError, match="already"):
        simulation.release()
    with pytest.raises(ValueError, match="NaN"):
        simulation.advance(float("nan"))


def test_a_simulation_belongs_to_its_thread(simulation: checkdam.Simulation) -> None:
    import threading

    raised = []

    def use() -> None:
        try:
            simulation.steps
        except BaseException as error:
            raised.append(error)

    thread = threading.Thread(target=use)
    thread.start()
    thread.join()
    assert raised


def test_what_was_interrupted_is_not_gone_on_with(slide: Path) -> None:
    slide.write_text(slide.read_text() + "\n[stages.settle]\ndamping_per_s = 60\nresidual = 1e-4\nmax_time_s = 5\n")
    simulation = checkdam.load(slide).simulation()
    with pytest.raises(checkdam.RunError, match="stopped"):
        simulation.release(progress=lambda p: False)
    for call in (simulation.release, simulation.step):
        with pytest.raises(RuntimeError, match="new simulation|release"):
            call()

