"""Oil whirl of a rigid rotor on either side of the threshold that `equilibrium` predicts from K and C."""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

SPEED = 300.0
CLEARANCE = 50e-6


def _bearing(film):
    return ehd.JournalBearing(
        journal_radius=0.025,
        length=0.025,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.02),
        film=film,
    )


def _free_vibration(planar_rotor, bearing, mass_ratio):
    """(growth rate, frequency) of a small disturbance, divided by the spin."""
    load = 0.0784 * bearing.reference_force(SPEED)
    eq = ehd.equilibrium(bearing, speed=SPEED, load=(0.0, -load))
    whirl = eq.whirl_ratio * SPEED
    period = 2.0 * math.pi / whirl
    # 1e-4 c: small enough for the linear theory, whose coefficients are those of one active set
    start = eq.position + (1e-4 * CLEARANCE, 0.0)
    rotor = planar_rotor(bearing, mass=mass_ratio * eq.critical_mass, speed=SPEED, load=(0, -load), position=start)
    history = rotor.run(24 * period, period / 160, spectral_radius=1.0, relativeTolerance=1e-9)
    late = history.time > 4 * period
    signal = (history.eccentricity - eq.position)[late]
    t = history.time[late]
    # whirl is an ellipse: a complex signal from x and y; amplitude and phase are linear in time for one mode
    z = signal[:, 0] / np.abs(signal[:, 0]).max() + 1j * signal[:, 1] / np.abs(signal[:, 1]).max()
    phase = np.unwrap(np.angle(z))
    frequency = abs(np.polyfit(t, phase, 1)[0])
    # amplitude over whole periods from the maxima of |x|
    x = np.abs(signal[:, 0])
    peaks = np.flatnonzero((x[1:-1] > x[:-2]) & (x[1:-1] >= x[2:])) + 1
    growth = np.polyfit(t[peaks], np.log(x[peaks]), 1)[0]
    return eq, growth / SPEED, frequency / SPEED


@pytest.mark.slow
@pytest.mark.parametrize("film", [ehd.FiniteLength(), ehd.ShortBearing()])
def test_threshold(planar_rotor, film):
    bearing = _bearing(film)
    growth = {}
    for ratio in (0.98, 1.02):
        eq, growth[ratio], frequency = _free_vibration(planar_rotor, bearing, ratio)
        if ratio == 0.98 and isinstance(film, ehd.FiniteLength):
            assert eq.eccentricity_ratio == pytest.approx(0.2, abs=0.005)
        # away from the threshold the frequency moves with the mass by about a tenth of the mass's change
        assert frequency == pytest.approx(eq.whirl_ratio, rel=0.005)
    assert growth[0.98] < 0.0 < growth[1.02]
    # nearly symmetric about the threshold, and of the size known for the short bearing (0.0024 at eps 0.2)
    assert growth[1.02] == pytest.approx(-growth[0.98], rel=0.1)
    assert growth[1.02] == pytest.approx(0.0024, rel=0.15)
