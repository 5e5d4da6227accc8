"""Joints of engines under impulsive loads, in coarse steps and with every effect of the oil."""

import math

import exudyn as exu
import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.sampling import sample

CYCLE, RADIUS, CLEARANCE = 0.02, 0.02, 25e-6
LAWS = {"barus": ehd.BarusPressure(coefficient=1.5e-8), "roelands": ehd.RoelandsPressure(coefficient=1.5e-8)}


def swinging(planar_rotor, law, steps, rho, cycles=3, load=5500.0, closure=ehd.ElrodAdams):
    """History of a rotor that swings to and fro in a grooved bearing under a load that turns."""
    bearing = ehd.JournalBearing(
        journal_radius=RADIUS,
        length=0.02,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.017, pressure_law=LAWS[law]),
        film=ehd.FiniteLength(n_theta=64, n_z=8),
        cavitation=closure(cavity_pressure=-5e4),
        asperity=ehd.GreenwoodTripp(composite_roughness=8e-7, composite_modulus=2e10),
        supply=(ehd.CircumferentialGroove(width=4e-3, pressure=2e5),),
    )
    rate, speed = 2.0 * math.pi / CYCLE, 430.0
    rotor = planar_rotor(
        bearing,
        mass=0.5,
        speed=(lambda t: speed / rate * math.sin(rate * t), lambda t: speed * math.cos(rate * t)),
        position=(0.2 * CLEARANCE, -0.3 * CLEARANCE),
        load=lambda t: (0.5 * load * math.sin(rate * t), -load * (1.0 - 0.4 * math.cos(rate * t))),
    )
    return rotor.run(cycles * CYCLE, CYCLE / steps, spectral_radius=rho)


def lowest(history):
    """Smallest gap after the first cycle, um."""
    return 1e6 * history.minimum_gap[history.time > CYCLE].min()


@pytest.mark.parametrize("law", sample(list(LAWS), 1))
def test_cavities_that_close_under_a_pressure_law(planar_rotor, law):
    """Where a cavity closes, the film of a stiff oil has no pressure at the speed of before, however short the step:
    Newton's method comes back from there. 2 cycles were the end, with steps of any size."""
    history = swinging(planar_rotor, law, 100, 0.6)
    assert history.time[-1] == pytest.approx(3.0 * CYCLE)
    assert np.diff(history.time).min() > 0.01 * CYCLE / 100
    assert np.isfinite(history.peak_pressure).all()


@pytest.mark.slow
@pytest.mark.parametrize("law", LAWS)
def test_steps_under_a_pressure_law(planar_rotor, law):
    """500 steps a cycle against 2000, hardly any of them halved."""
    coarse, fine = (swinging(planar_rotor, law, steps, 0.9, cycles=2) for steps in (500, 2000))
    assert coarse.time.size < 1.1 * 1000
    assert lowest(coarse) == pytest.approx(lowest(fine), rel=0.05)
    assert coarse.peak_pressure.max() == pytest.approx(fine.peak_pressure.max(), rel=0.05)


@pytest.mark.parametrize("closure", [ehd.SwiftStieber, ehd.ElrodAdams])
def test_loads_beyond_a_pressure_law(planar_rotor, closure):
    """Ten times the load: rigid surfaces carry no more than some 1 / coefficient, whatever the steps."""
    for steps in (100, 400):
        with pytest.raises(
            exu.ExudynError, match=r"'rotor bearing'.* t = .*runs away.*RoelandsPressure.*liner or bush"
        ):
            swinging(planar_rotor, "barus", steps, 0.9, load=55000.0, closure=closure)
