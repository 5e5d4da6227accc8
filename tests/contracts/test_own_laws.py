"""A closure and laws of the oil that users write, by what `exudyn_ehd/README.md` asks of them alone: each takes part in
films, tangents, histories and friction as those of the package do, and what lacks something is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.cavitation.closures import Closure
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.links import LinkLaw
from exudyn_ehd.joint.model.build import build_model
from tests.tangents import tangent_error

R, L, C, MU, STEP = 0.025, 0.05, 25e-6, 0.02, 1e-4
# Tilted, squeezing, sliding axially.
MOTION = np.array([11e-6, 5e-6, 1e-4, -1.5e-4, 3e-3, -2e-3, 0.05, 0.02, 250.0, 0.3])
UNIT = np.array([C, C, 1e-3, 1e-3, 5e-3, 5e-3, 0.2, 0.2, 300.0, 3.0])


@dataclass(frozen=True, kw_only=True)
class Tensile(Closure):
    """Complementarity: oil that bears a tension before it ruptures, in cavities at the same pressure."""

    cavity_pressure: float = -1.5e5
    line_in_cells: bool | None = None


@dataclass(frozen=True, kw_only=True)
class BulkModulus:
    """Density ratio exp(p / K)."""

    modulus: float

    @property
    def coefficient(self):
        return 1.0 / self.modulus

    def ratio(self, p):
        return np.exp(np.asarray(p, dtype=float) / self.modulus)

    def ratio_slope(self, p):
        return self.ratio(p) / self.modulus

    def ratio_bend(self, p):
        return self.ratio(p) / self.modulus**2

    def flow_work(self, p):
        return -self.modulus * np.expm1(-np.asarray(p, dtype=float) / self.modulus)


@dataclass(frozen=True, kw_only=True)
class Yielding:
    """Bingham-like oil after Bercovier and Engelman: ratio r + (1 - r) / sqrt(1 + x^2), x = relaxation_time rate, with
    the yield stress (1 - r) mu_0 / relaxation_time; at every height of the film."""

    relaxation_time: float = 1e-5
    residual: float = 0.3

    @property
    def onset(self):
        return 1.0 / self.relaxation_time

    def _square(self, rate):
        return 1.0 + (self.relaxation_time * np.asarray(rate, dtype=float)) ** 2

    def ratio(self, rate):
        return self.residual + (1.0 - self.residual) * self._square(rate) ** -0.5

    def ratio_slope(self, rate):
        return -(1.0 - self.residual) * self.relaxation_time**2 * rate * self._square(rate) ** -1.5

    def ratio_bend(self, rate):
        b = self._square(rate)
        return (1.0 - self.residual) * self.relaxation_time**2 * (2.0 * b - 3.0) * b**-2.5

    def bound(self, radius, clearance):
        return ShearThinning(self, radius, clearance)


class Sliding(Yielding):
    """Ratio of `Yielding` by the sliding alone, U / h: a law of the links that does not know the pressure."""

    def bound(self, radius, clearance):
        return SlidingLinks(self, 2.0 * radius / clearance)


class SlidingLinks(LinkLaw):
    """`Sliding` as flux effect and shear factor of one bearing."""

    changes_carriers = False
    depends_on_speed = True

    def __init__(self, law, scale):
        self.law, self.scale = law, scale

    def _ratio(self, H, vx):
        rate = self.scale * vx / H
        slope = self.law.ratio_slope(rate)
        return self.law.ratio(rate), -slope * rate / H, slope * self.scale / H

    def apply(self, flux, gap_x, gap_z, vx, vz):
        for gap, g, g_h, g_v in ((gap_x, flux.gx, flux.gx_h, flux.gx_v), (gap_z, flux.gz, flux.gz_h, flux.gz_v)):
            ratio, ratio_h, ratio_v = self._ratio(gap, vx)
            g_h[:] = (g_h - g * ratio_h / ratio) / ratio
            g_v[:] = (g_v - g * ratio_v / ratio) / ratio
            g /= ratio

    def factor(self, H, vx, ratio_out, ratio_h_out, ratio_v_out):
        ratio_out[:], ratio_h_out[:], ratio_v_out[:] = self._ratio(H, vx)


# Ten times softer than oil, so that an error in the density's share of the tangent would show.
LAWS = {
    "density": {"density_law": BulkModulus(modulus=1.7e8)},
    "thinning": {"shear_law": Yielding()},
    "by the sliding": {"shear_law": Sliding()},
    "closure": {},
}


def make(cavitation=None, laws=None, **options):
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=MU, **(laws or {})),
        film=ehd.FiniteLength(n_theta=48, n_z=8),
        cavitation=Tensile() if cavitation is None else cavitation,
        **options,
    )


@pytest.mark.parametrize("cavitation", [Tensile(), ehd.ElrodAdams(cavity_pressure=-1e5)], ids=["tensile", "elrod"])
@pytest.mark.parametrize("name", LAWS)
def test_tangent_is_exact(name, cavitation):
    """Against central differences of fourth order, three steps after a flooded start; 1e-6 is what they leave."""
    model = build_model(make(cavitation, LAWS[name]))
    history = model.initial_history(MOTION)
    for _ in range(3):
        evaluation = model.evaluate(MOTION, history, STEP)
        assert evaluation.status is ehd.Status.CONVERGED
        history = evaluation.history()
    assert tangent_error(model, MOTION, UNIT, history, STEP) < 1e-6


def test_a_closure_is_its_data():
    """The bits of the closure of the package with the same data, steady and under a load."""
    own, known = make(), make(ehd.SwiftStieber(cavity_pressure=-1.5e5))
    steady = [ehd.steady(b, speed=200.0, eccentricity_ratio=0.6) for b in (own, known)]
    np.testing.assert_array_equal(steady[0].pressure, steady[1].pressure)
    assert steady[0].pressure.min() == pytest.approx(-1.5e5)
    balanced = [ehd.equilibrium(b, speed=200.0, load=(0.0, -2000.0)) for b in (own, known)]
    for name in ("stiffness", "damping", "whirl_ratio"):
        np.testing.assert_array_equal(*(getattr(b, name) for b in balanced))


def test_density_is_that_of_the_law():
    """Check the film's own pressures, within the error of the table between them."""
    law = BulkModulus(modulus=1.7e8)
    model = build_model(make(laws={"density_law": law}))
    film = model.evaluate(MOTION).film
    p = film.oil.P * film.scales.pressure
    assert p.max() > 1e7
    np.testing.assert_allclose(model.solver.rho, law.ratio(p), rtol=1e-10)


@pytest.mark.parametrize("law", [Yielding(), Sliding()], ids=["thinning", "by the sliding"])
def test_friction_of_a_concentric_journal(law):
    """No pressure and one shear rate: the torque is 2 pi R^2 L times the stress of the law."""
    film = ehd.steady(make(laws={"shear_law": law}), speed=200.0, eccentricity_ratio=0.0)
    rate = 200.0 * R / C
    stress = MU * float(law.ratio(rate)) * rate
    # the table's error of a law at every height
    assert abs(film.friction_torque) == pytest.approx(2.0 * math.pi * R**2 * L * stress, rel=1e-7)


def test_a_law_without_a_method_is_refused():
    class NoBend:
        coefficient, ratio, ratio_slope, flow_work = 1e-9, np.ones_like, np.zeros_like, np.copy

    for value in (NoBend(), BulkModulus, "dowson"):
        with pytest.raises(ehd.InputError, match=r"density_law must be .* or a DensityLaw of your own or None"):
            ehd.Lubricant(viscosity=MU, density_law=value)
    with pytest.raises(ehd.InputError, match="shear_law must be"):
        ehd.Lubricant(viscosity=MU, shear_law=ehd.BarusPressure(coefficient=1e-8))
    with pytest.raises(ehd.InputError, match=r"cavitation must be .* or a Closure of your own"):
        make(ehd.SwiftStieber)


def test_a_ratio_that_is_not_1_at_rest_is_refused():
    class Plastic(Yielding):
        def ratio(self, rate):
            return 1.0 + super().ratio(rate)

    with pytest.raises(ehd.InputError, match="Plastic: the ratio must be 1 at rest"):
        ehd.steady(make(laws={"shear_law": Plastic()}), speed=200.0, eccentricity_ratio=0.6)
