"""A free journal under a suddenly applied load, implicit in time.

The exact tangent keeps Newton's iterations at the plain film's.
"""

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

MASS, LOAD, OMEGA, STEP, STEPS = 2.0, np.array([0.0, -12000.0]), 300.0, 1e-4, 120
OIL = ehd.oil("ISO VG 46", temperature=330.0)
EFFECTS = {
    "plain": {},
    "barus": {"pressure_law": ehd.BarusPressure(coefficient=2e-8)},
    "roelands": {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
    "carreau": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)},
    "density": {"density_law": ehd.DowsonHigginson(coefficient=3e-9)},
    "density and roelands": {
        "density_law": ehd.DowsonHigginson(),
        "pressure_law": ehd.RoelandsPressure(coefficient=2e-8),
    },
    "lumped": {"thermal": ehd.LumpedThermal(supply_temperature=330.0)},
    "field": {"thermal": ehd.FilmEnergy(supply_temperature=330.0, bush_coefficient=1e3)},
    "all": {
        "pressure_law": ehd.RoelandsPressure(coefficient=2e-8),
        "shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2),
        "thermal": ehd.FilmEnergy(supply_temperature=330.0, bush_coefficient=1e3),
    },
}


def run(effects, cavitation):
    """Backward Euler of the journal's two translations.

    Returns iterations per step, orbit (STEPS, 2) and film temperature.
    """
    effects = dict(effects)
    thermal = effects.pop("thermal", None)
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.05,
        radial_clearance=25e-6,
        lubricant=dataclasses.replace(OIL, **effects),
        cavitation=cavitation,
        thermal=thermal,
        end_pressures=(1e5, 1e5),
        film=ehd.FiniteLength(n_theta=64, n_z=8),
    )
    model = build_model(bearing)
    position, velocity, orbit, total = np.array([1e-7, 0.0]), np.zeros(2), [], 0
    motion = np.zeros(10)
    motion[8] = OMEGA
    motion[:2] = position
    history = model.initial_history(motion)
    for _ in range(STEPS):
        v = velocity.copy()
        for _ in range(12):
            motion[:2], motion[4:6] = position + STEP * v, v
            e = model.evaluate(motion, history, STEP)
            assert e.status is ehd.Status.CONVERGED
            residual = MASS * (v - velocity) / STEP - e.wrench[:2] - LOAD
            if np.abs(residual).max() < 1e-7 * np.abs(LOAD).max():
                break
            total += 1
            T = e.tangent()[:2]
            v = v - np.linalg.solve(MASS / STEP * np.eye(2) - STEP * T[:, :2] - T[:, 4:6], residual)
        else:
            raise AssertionError("Newton's method did not converge")
        position, velocity, history = motion[:2].copy(), v, e.history()
        orbit.append(position)
    temperature = None if thermal is None else np.asarray(history.temperature)
    return total / STEPS, np.array(orbit), temperature


@pytest.mark.parametrize(
    "cavitation", sample([ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)]), ids=["swift", "elrod"]
)
def test_newton_iterations_stay_those_of_the_plain_film(cavitation):
    results = {name: run(effects, cavitation) for name, effects in EFFECTS.items()}
    plain = results["plain"]
    for name, (iterations, orbit, temperature) in results.items():
        print(f"{name}: {iterations:.2f} iterations per step, {np.hypot(*orbit[-1]) / 25e-6:.4f} eccentricity ratio")
        assert iterations < plain[0] + 0.3, name
        assert np.all(np.isfinite(orbit))
        assert name == "plain" or np.abs(orbit - plain[1]).max() > 1e-9, name  # every effect shows
        if temperature is not None:
            assert 330.0 < temperature.max() < 400.0


@pytest.mark.parametrize(
    "thermal", [EFFECTS["lumped"]["thermal"], EFFECTS["field"]["thermal"]], ids=["lumped", "field"]
)
def test_hotter_film_lets_the_journal_sink(thermal):
    eccentricity = [float(np.hypot(*run({"thermal": t}, ehd.SwiftStieber())[1][-1])) for t in (None, thermal)]
    assert eccentricity[1] > 1.01 * eccentricity[0]


@pytest.mark.parametrize("density", [None, ehd.DowsonHigginson()], ids=["constant", "dense"])
@pytest.mark.parametrize("law", [ehd.BarusPressure(coefficient=2e-8), ehd.RoelandsPressure(coefficient=2e-8)])
@pytest.mark.parametrize("closure", [ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)])
def test_newton_comes_back_from_a_squeeze_that_no_pressure_carries(closure, law, density):
    """Velocities of approach beyond the law's end have a finite force and slope, which lead to the one of a load."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.05,
        radial_clearance=25e-6,
        lubricant=dataclasses.replace(OIL, pressure_law=law, density_law=density),
        cavitation=closure,
        film=ehd.FiniteLength(n_theta=48, n_z=6),
    )
    for direction in (0.3, 2.0, 4.4):
        model, motion = build_model(bearing), np.zeros(10)
        towards = np.array([np.cos(direction), np.sin(direction)])
        motion[:2] = 0.9 * 25e-6 * towards
        history = model.initial_history(motion)

        def film(speed, model=model, motion=motion, towards=towards, history=history):
            motion[4:6] = speed * towards
            evaluation = model.evaluate(motion, history, 1e-4)
            force = float(towards @ evaluation.wrench[:2])
            return evaluation.status, force, float(towards @ evaluation.tangent()[:2, 4:6] @ towards)

        status, load, _ = film(2e-5)
        assert status is ehd.Status.CONVERGED and load < 0.0
        for fast in (2e-3, 0.05):
            speed = fast
            status, force, slope = film(speed)
            # oil that is stored yields to a slower squeeze
            yields = closure.conserves_mass and density is not None and fast < 0.01
            assert status is ehd.Status.NO_PRESSURE or yields
            assert force < load and slope < 0.0
            for _ in range(40):
                speed += (load - force) / slope
                status, force, slope = film(speed)
                if abs(force - load) < 1e-9 * abs(load):
                    break
            assert status is ehd.Status.CONVERGED
            assert speed == pytest.approx(2e-5, rel=1e-6)


@pytest.mark.parametrize("density", [None, ehd.DowsonHigginson()], ids=("constant", "compressible"))
@pytest.mark.parametrize("in_cells", (False, True))
@pytest.mark.parametrize("velocity", (0.0, 0.004, -0.02))
def test_an_elastic_liner_does_not_jump_at_the_start(density, in_cells, velocity):
    """Pressures and deflections at an instant are those of the state before: the loss is that of sliding and squeeze,
    and the liner stores a small part of it. A prescribed pressure compresses the oil beside it."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=0.02, density_law=density),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=in_cells),
        bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=5e9),
        end_pressures=(2e5, 0.0),
        supply=(ehd.AxialGroove(angle=1.5, width_angle=0.4, length=0.02, pressure=3e5),),
    )
    model, motion = build_model(bearing), np.array([1.2e-5, 0, 0, 0, velocity, 0, 0, 0, 300.0, 0])
    found = model.evaluate(motion, model.initial_history(motion), 0.0).quantities()
    rigid = build_model(dataclasses.replace(bearing, bush=None))
    expected = rigid.evaluate(motion, rigid.initial_history(motion), 0.0).quantities()
    # the liner deflects by up to a tenth of the gap; wrong losses and flows were 1.2 to 400 times as large
    assert found["power_loss"] == pytest.approx(expected["power_loss"], rel=0.1)
    assert abs(found["stored_power"]) < 0.02 * found["power_loss"]
    assert abs(found["supply_flow"]) < 2.0 * abs(expected["supply_flow"]) + 1e-6


@pytest.mark.parametrize("in_cells", (False, True))
@pytest.mark.parametrize("velocity", (1e-3, -1e-3, 0.1, -0.1))
def test_a_velocity_changes_no_force_of_a_film_on_a_liner(in_cells, velocity):
    """The liner takes up the squeeze: force and loss are those without a velocity, but for the gap that it opens."""
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.03,
        radial_clearance=30e-6,
        lubricant=ehd.Lubricant(viscosity=0.02),
        cavitation=ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=in_cells),
        bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=5e9),
    )
    still, moves = (
        ehd.steady(bearing, speed=300.0, eccentricity_ratio=0.6, velocity=(v, 0.0)) for v in (0.0, velocity)
    )
    # rates at an instant are those of a short step, in which the film moves by 1e-7 of its change
    assert moves.force == pytest.approx(still.force, rel=2e-4)
    assert moves.friction_torque == pytest.approx(still.friction_torque, rel=2e-4)
    assert moves.power_loss == pytest.approx(still.power_loss, rel=0.5 * abs(velocity) + 1e-4)


def test_a_shear_law_that_does_not_thin_changes_no_film_at_an_instant():
    """Compressible oil at the start of a run, with a pressure at an end: the same film on the way of shear laws."""
    size = {"journal_radius": 0.025, "length": 0.03, "radial_clearance": 30e-6, "end_pressures": (1e5, 3e4)}
    found = []
    for law in (None, ehd.CarreauShear(relaxation_time=1e-15, exponent=0.75)):
        oil = ehd.Lubricant(viscosity=0.02, density_law=ehd.DowsonHigginson(), shear_law=law)
        model = build_model(ehd.JournalBearing(**size, lubricant=oil, cavitation=ehd.ElrodAdams(cavity_pressure=-5e4)))
        motion = np.array([1.2e-5, 0, 0, 0, 0.01, 0, 0, 0, 300.0, 0])
        film = model.evaluate(motion, model.initial_history(motion), 0.0)
        found.append(np.append(film.wrench, [film.quantities()[name] for name in ("power_loss", "leakage")]))
    # both ways end their iteration by rules of their own
    np.testing.assert_allclose(found[1], found[0], rtol=1e-6, atol=1e-9)
