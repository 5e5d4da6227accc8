"""Drag of a pressure gradient on unequally rough surfaces.

Ridges solved exactly, momentum, reciprocity with the flow, and what is off.
"""

from __future__ import annotations

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.film.surfaces.roughness import nominal_gap, shear_flow_factor
from exudyn_ehd.joint.heat.power import heat_and_exchange
from exudyn_ehd.joint.model.build import build_model

R, L, C, SPEED, MU = 0.02, 0.03, 20e-6, 200.0, 0.03
SIGMA = 1.2e-6


def model_of(share, n_theta=48, *, pattern=1 / 9, **options):
    rough = ehd.PatirCheng(composite_roughness=SIGMA, pattern=pattern, journal_share=share)
    return build_model(
        ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=C,
            lubricant=ehd.Lubricant(viscosity=MU),
            roughness=rough,
            film=ehd.FiniteLength(n_theta=n_theta, n_z=n_theta // 6),
            **options,
        )
    )


def at(eps, axial=0.0, tilt=(0.0, 0.0)):
    return np.array([0.8 * eps * C, 0.6 * eps * C, *tilt, 0, 0, 0, 0, SPEED, axial])


@pytest.mark.parametrize(("moving", "resting"), [(0.3, 0.0), (0.0, 0.3), (0.2, 0.1), (0.15, 0.15)])
def test_ridges_across_are_pulled_by_what_they_carry(moving, resting):
    """Two sinusoidal surfaces, averaged over their relative position: under a unit pressure gradient the wall forces,
    shear and pressure on the slopes, are the mean flows which one surface's unit speed carries in the other's frame;
    half the gap more and less of the same.

    Reynolds' equation of a unit mean gap, unit viscosity; sums over a period of smooth functions are exact to rounding.
    """
    x = np.linspace(0.0, 2.0 * np.pi, 512, endpoint=False)
    pulled, carried = np.zeros(2), np.zeros(2)
    for phase in x[::16]:
        heights = moving * np.cos(x - phase), resting * np.cos(x)
        h = 1.0 + heights[0] + heights[1]
        stiffness = np.mean(h**-3)
        p_x = -1.0 / (stiffness * h**3)  # of mean -1: a unit gradient, walls at rest
        for k, height in enumerate(heights):
            # surface k: shear -h/2 p' and -p da/dx of its slopes, summed by parts
            pulled[k] += np.mean(-0.5 * h * p_x + height * p_x) / 32.0
            # surface k slides at speed 1, no mean gradient: flow h/2 - h^3 p' / 12 - its height is constant along x
            carried[k] += np.mean((0.5 * h - height) / h**3) / stiffness / 32.0
    np.testing.assert_allclose(pulled, carried, rtol=1e-13)
    assert pulled.sum() == pytest.approx(1.0, rel=1e-13)
    assert np.sign(round(pulled[0] - pulled[1], 12)) == np.sign(moving - resting)


def test_ridges_along_are_pulled_alike():
    """Every strip of gap h has h/2 on either wall: half the mean gap each, as no flow is dragged along beyond that."""
    h = 1.0 + 0.3 * np.cos(np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False))
    assert np.mean(0.5 * h) == pytest.approx(0.5, rel=1e-14)
    H = np.array([3.0])
    assert shear_flow_factor(H, 9.0) < 0.4 * shear_flow_factor(H, 1.0) < 0.4 * shear_flow_factor(H, 1 / 9)


@pytest.mark.parametrize("share", [0.0, 0.8])
def test_integrals_are_those_of_the_shear_flow_factor(share):
    """sigma phi_s times the pressure gradient by central differences at the vertices.

    2 % of a second-order difference on this grid.
    """
    model = model_of(share, 96)
    film = model.evaluate(at(0.5, axial=0.5)).film
    g, P, t = model.grid, film.oil.P, model.solver.H * C / SIGMA
    H = nominal_gap(t, 0.0)
    found = np.tensordot(film.loads.drag, P, 2)
    carried = (2.0 * share - 1.0) * SIGMA / C * shear_flow_factor(H, 1 / 9)
    slope = (np.roll(P, -1, 0) - np.roll(P, 1, 0)) / (2.0 * g.width_x[0])
    assert found[0] == pytest.approx(-np.sum(carried * slope * g.weight), rel=0.02)
    carried = (2.0 * share - 1.0) * SIGMA / C * shear_flow_factor(H, 9.0)
    across = np.gradient(P, g.z, axis=1)
    scale = np.sum(np.abs(carried * across) * g.weight)
    assert found[1] == pytest.approx(-np.sum(carried * across * g.weight), abs=0.02 * scale)


def heat(film):
    """Heat of shear and pressure flow, W, link by link."""
    s, g = film.solver, film.grid
    p, unit = film.oil.P * film.scales.pressure, C * R**2 / film.scales.pressure
    speed2 = (R * film.journal.omega) ** 2 + film.journal.axial_speed**2
    out = np.sum(MU * speed2 / (s.H * C) * film.share() * film.oil.ratio * g.weight * R**2)
    out += unit * np.sum(s.system.kx * (np.roll(p, -1, 0) - p) ** 2)
    return float(out + unit * np.sum(s.system.kz[:, :-1] * np.diff(p, axis=1) ** 2))


@pytest.mark.parametrize("share", [0.0, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("ends", [(0.0, 0.0), (1e5, 2e5)])
def test_power_becomes_heat_for_every_share(share, ends):
    """Without the uneven drag 1 to 2 % of the pressure flow's heat would be missing on every grid; with it what is
    left is the grid's
    second order, as with equal shares."""
    left = []
    for n in (48, 96):
        model = model_of(share, n, end_pressures=ends)
        film = model.evaluate(at(0.5, axial=0.0 if ends == (0.0, 0.0) else 0.3)).film
        left.append(abs(heat_and_exchange(film, 1.0)[0] / heat(film) - 1.0))
    assert left[0] < 8e-4 and left[1] < 0.3 * left[0]


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_both_walls_together_hold_the_pressure(share):
    """Torque on the journal about its own axis and on the bush: only e x F is between them, to rounding."""
    model = model_of(share, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    motion = at(0.7)
    evaluation = model.evaluate(motion)
    q, F = evaluation.quantities(), evaluation.wrench
    lever = motion[0] * F[1] - motion[1] * F[0]
    size = abs(q["friction_torque"])
    assert q["friction_torque"] + q["friction_torque_bush"] == pytest.approx(-lever, abs=1e-12 * size)


def test_a_rough_journal_is_pulled_along():
    """The pressure rises where the film is thick and falls where it is thin: there the rougher surface takes more."""
    found = {}
    for share in (0.0, 1.0):
        film = model_of(share).evaluate(at(0.5)).film
        found[share] = np.vdot(film.loads.drag[0], film.oil.P)
    assert found[0.0] < 0.0 < found[1.0]


LAWS = {
    "piezoviscous": {"pressure_law": ehd.BarusPressure(coefficient=2e-8)},
    "thinning": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)},
    "compressible": {"density_law": ehd.DowsonHigginson(), "pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
}


@pytest.mark.parametrize("share", [0.0, 1.0])
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("profile", [None, ehd.OutOfRound(order=3, amplitude=1e-6)])
def test_tangent_with_laws_of_the_oil(law, share, profile):
    """Against central differences of step 1e-6; below 1e-6 of each row's largest entry."""
    options = {"lubricant": ehd.Lubricant(viscosity=MU, **LAWS[law]), "end_pressures": (1e5, 3e5), "profile": profile}
    rough = ehd.PatirCheng(composite_roughness=SIGMA, pattern=1 / 3, journal_share=share)
    model = build_model(
        ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=C,
            roughness=rough,
            film=ehd.FiniteLength(n_theta=48, n_z=8),
            **options,
        )
    )
    motion = at(0.6, axial=0.3, tilt=(0.04 * C / L, -0.02 * C / L))
    scale = np.array([C, C, C / L, C / L, C * SPEED, C * SPEED, C / L * SPEED, C / L * SPEED, SPEED, R * SPEED])
    tangent, difference = model.evaluate(motion).tangent() * scale, np.empty((6, 10))
    for k in range(10):
        d = np.zeros(10)
        d[k] = 1e-6 * scale[k]
        difference[:, k] = (model.evaluate(motion + d).wrench - model.evaluate(motion - d).wrench) / 2e-6
    assert np.max(np.abs(tangent - difference) / np.abs(difference).max(axis=1, keepdims=True)) < 1e-6


def test_equal_shares_call_nothing(monkeypatch):
    def forbidden(*_):
        raise AssertionError("called for equally rough surfaces")

    monkeypatch.setattr("exudyn_ehd.joint.model.loads.drag_weights", forbidden)
    for name in ("drag_by_gap", "add_drag_by_pose"):
        monkeypatch.setattr(f"exudyn_ehd.joint.tangent.wrench.{name}", forbidden)
    model_of(0.5).evaluate(at(0.5)).tangent()
    with pytest.raises(AssertionError):
        model_of(0.8).evaluate(at(0.5))
