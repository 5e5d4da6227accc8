"""Films on a journal whose modes turn under them: shapes at any angle, derivatives, power."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.mesh import patch
from exudyn_ehd.solid.turning_journal import TurningJournal
from exudyn_ehd.status import InputError, Status
from tests.sampling import sample

R, L, C = 0.03, 0.04, 30e-6


def journal(displacement, around=24, along=4, turn=0.0):
    """Cylinder of radius R with modes ``displacement(theta, z)`` (n, 3, k), radial, tangential and axial, turned by
    hand."""
    theta = 2.0 * np.pi * np.arange(2 * around) / (2 * around)
    z = np.linspace(-0.5 * L, 0.5 * L, 2 * along + 1)
    number = {}
    for i in range(2 * around):
        for j in range(2 * along + 1):
            if i % 2 == 0 or j % 2 == 0:
                number[i, j] = len(number)
    places = np.array([(theta[i], z[j]) for i, j in number])
    pattern = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    faces = np.array(
        [
            [number[(2 * i + a) % (2 * around), 2 * j + b] for a, b in pattern]
            for i in range(around)
            for j in range(along)
        ]
    )
    T, Z = places.T
    at = T + turn
    local = displacement(T, Z)
    cos, sin, zero = np.cos(at), np.sin(at), np.zeros_like(at)
    frame = np.array([[cos, -sin, zero], [sin, cos, zero], [zero, zero, zero + 1.0]])
    positions = np.stack([R * cos, R * sin, Z], axis=1)
    return TurningJournal(
        surface=ReducedBore(
            faces=patch(positions, faces),
            displacements=np.einsum("ijn,njk->nik", frame, local),
            stiffness_matrix=np.diag(np.full(local.shape[2], 1e9)),
            radius=R,
            length=L,
        ),
        mass=np.zeros(local.shape[2]),
    )


def waves(theta, z):
    """Modes of a cylinder under pressures cos(n theta) and sin(n theta), some odd along z, some of no symmetry."""
    zeta = 2.0 * z / L
    radial = [
        np.cos(2 * theta) * (1 - zeta**2),
        np.sin(2 * theta) * (1 - zeta**2),
        np.cos(3 * theta + 0.4) * zeta,
        1.0 - 0.5 * zeta**2,
        np.sin(theta) * zeta**2 + 0.3 * np.cos(4 * theta) * (1 + zeta),
    ]
    out = np.zeros((theta.size, 3, len(radial)))
    out[:, 0] = np.stack(radial, axis=1)
    out[:, 1, 0] = -0.5 * np.sin(2 * theta)
    out[:, 2, 2] = 0.2 * np.cos(theta)
    return out


def model_of(pin, film=None, **options):
    given = {"journal_radius": R, "length": L, "radial_clearance": C, "lubricant": ehd.Lubricant(viscosity=0.01)}
    given |= {"film": ehd.FiniteLength(n_theta=48, n_z=8) if film is None else film, "journal": pin}
    return build_model(ehd.JournalBearing(**(given | options)))


def turned(motion, angle):
    """A motion in a frame turned by an angle about z."""
    out, (c, s) = motion.copy(), (np.cos(angle), np.sin(angle))
    A = np.array([[c, s], [-s, c]])
    for first in range(0, 8, 2):
        out[first : first + 2] = A @ motion[first : first + 2]
    return out


def random_motion(rng, k):
    return np.concatenate(
        (
            0.25 * C * rng.normal(size=2),
            2e-4 * rng.normal(size=2),
            2e-3 * rng.normal(size=2),
            2e-2 * rng.normal(size=2),
            [300.0 * rng.uniform(-1, 1), 0.01 * rng.normal()],
            1.5e-6 * rng.normal(size=k),
            1e-3 * rng.normal(size=k),
        )
    )


@pytest.mark.parametrize("steps", [1, 17, -9])
def test_journal_and_frame_turned_by_the_same_angle_are_the_same_film(steps):
    """By whole columns of the film, so that its grid is the same."""
    model, rng = model_of(journal(waves)), np.random.default_rng(steps + 20)
    motion, angle = random_motion(rng, 5), 2.0 * np.pi * steps / 48
    there = model.evaluate(motion, spin=angle)
    found = [there.wrench, there.bore.load, there.film.extra.height.copy(), there.minimum_gap]
    here = model.evaluate(turned(motion, angle), spin=0.0)
    back = np.concatenate([turned(np.tile(found[0][a : a + 2], 4), angle)[:2] for a in (0, 3)])
    for own, other in (
        (back, here.wrench[[0, 1, 3, 4]]),
        (found[0][[2, 5]], here.wrench[[2, 5]]),
        (found[1], here.bore.load),
        (np.roll(found[2], -steps, axis=0), here.film.extra.height),
    ):
        assert np.abs(own - other).max() < 1e-9 * np.abs(other).max()
    assert found[3] == pytest.approx(here.minimum_gap, rel=1e-9)


@pytest.mark.parametrize("share", [7, 50, 101])
def test_body_turned_by_hand_is_the_journal_at_that_angle(share):
    """Nodes and modes turned as numbers, at angles between the film's columns."""
    angle = 2.0 * np.pi * share / 144
    motion = random_motion(np.random.default_rng(share), 5)
    here = model_of(journal(waves)).evaluate(motion, spin=angle)
    there = model_of(journal(waves, turn=angle)).evaluate(motion, spin=0.0)
    for own, other in ((here.wrench, there.wrench), (here.bore.load, there.bore.load)):
        assert np.abs(own - other).max() < 1e-9 * np.abs(other).max()
    np.testing.assert_allclose(here.film.extra.height, there.film.extra.height, atol=1e-9 * 0.2)


def test_single_mode_is_the_plain_field_of_its_angle(measured):
    """Gap, its rate, modal load and moment against the mode itself at theta - phi.

    What is left is of the means that a film takes along its stretched grid: 6e-3, 1e-3, 4e-4 with 8, 16, 32 slices.
    """
    pin = journal(lambda t, z: waves(t, z)[..., 1:2], around=48)
    model = model_of(pin, ehd.FiniteLength(n_theta=96, n_z=32))
    rng, angle, grid = np.random.default_rng(4), 0.77, model.grid
    motion = random_motion(rng, 1)
    found = model.evaluate(motion, spin=angle)
    q, q_t, omega = motion[10], motion[11], motion[8]
    T, Z = np.meshgrid(grid.x - angle, grid.z * R * 2.0 / L, indexing="ij")
    S, slope = -np.sin(2 * T) * (1 - Z**2), -2.0 * np.cos(2 * T) * (1 - Z**2)
    gap = model.bearing.radial_clearance
    measured("gap", np.abs(found.film.extra.height * gap - S * q).max() / abs(q), 1e-3)
    rate = S * q_t - omega * slope * q
    measured("rate", np.abs(model._rate * gap - rate).max() / np.abs(rate).max(), 1e-3)
    force = found.film.oil.P * found.film.scales.pressure * grid.weight * R**2
    measured("load", abs(found.bore.load[0] / np.sum(force * S) - 1.0), 1e-3)
    moment = np.sum(force * -slope * q)
    measured("moment", abs(found.moment / moment - 1.0), 1e-3)


THINS = ehd.ReynoldsTemperature(point=(313.15, 0.01), coefficient=0.03)
OPTIONS = {
    "plain": {},
    "no cavity": {"cavitation": ehd.FullSommerfeld()},
    "Gumbel": {"cavitation": ehd.Gumbel()},
    "mass": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "Gumbel, in cells": {"cavitation": ehd.Gumbel(line_in_cells=True)},
    "mass, line in its cells": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5, line_in_cells=True)},
    "wall": {"contact": ehd.RegularisedWall(onset=15e-6)},
    "asperities": {"asperity": ehd.GreenwoodTripp(composite_roughness=1e-6, composite_modulus=1e11)},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=1e-6, journal_share=0.9)},
    "heat": {
        "lubricant": ehd.Lubricant(viscosity=0.01, temperature_law=THINS),
        "thermal": ehd.FilmEnergy(supply_temperature=313.15),
    },
    "pressure": {
        "lubricant": ehd.Lubricant(viscosity=0.01, pressure_law=ehd.RoelandsPressure(coefficient=2e-8)),
    },
    "shear": {
        "lubricant": ehd.Lubricant(viscosity=0.01, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6)),
    },
    "density": {"lubricant": ehd.Lubricant(viscosity=0.01, density_law=ehd.DowsonHigginson())},
    "turbulent": {"turbulence": ehd.NgPan()},
    "groove": {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.4, pressure=1e5),)},
    "ends": {"end_pressures": (1e5, 3e4)},
    "oval": {"profile": ehd.OutOfRound(order=2, amplitude=3e-6)},
    "short": {"film": ehd.ShortBearing()},
}


@pytest.mark.parametrize("name", sample(list(OPTIONS), 0))
def test_tangent_is_the_derivative(name):
    """Derivatives of wrench and loads to motion, modes, rates and angle.

    Differences over 1e-6 of the scales have errors of 1e-7 where films are thin; a film whose set of cavities changes
    within them would show as 1e-3. Fills at a line inside its cells bend more: truncation 3e-6 there, 3e-7 over 3e-7.
    """
    size_of = 3e-7 if name.endswith("line in its cells") else 1e-6
    model, rng, checked = model_of(journal(waves), **OPTIONS[name]), np.random.default_rng(8), 0
    k = 5
    unit = np.concatenate(([C, C, 1e-3, 1e-3, 0.1, 0.1, 1.0, 1.0, 300.0, 1.0], np.full(k, C), np.full(k, 0.1), [1.0]))
    while checked < 4:
        motion, spin = random_motion(rng, k), rng.uniform(-3, 3)
        history = model.initial_history(motion)
        here = model.evaluate(motion, history, 1e-4, spin)
        if here.status is not Status.CONVERGED:
            continue
        exact = here.derivatives * unit
        scale = np.abs(exact).max(axis=1)
        numeric = np.empty_like(exact)
        for i, size in enumerate(unit):
            ends = []
            for h in (size_of, -size_of):
                at = np.append(motion, spin)
                at[i] += h * size
                found = model.evaluate(at[:-1], history, 1e-4, at[-1])
                ends.append(np.concatenate((found.wrench, found.bore.load)))
            numeric[:, i] = (ends[0] - ends[1]) / (2.0 * size_of)
        errors = np.abs(numeric - exact) / scale[:, None]
        assert errors.max() < 2e-6
        checked += 1


def test_combined_tangent_is_the_sum_of_its_parts():
    model = model_of(journal(waves))
    found = model.evaluate(random_motion(np.random.default_rng(1), 5), spin=0.4)
    whole = found.tangent()
    np.testing.assert_allclose(
        found.combined_tangent(0.3, 2.0)[:, 10:], 0.3 * whole[:, 10:15] + 2.0 * whole[:, 15:], rtol=1e-12
    )


def test_power_of_all_coordinates_is_what_the_film_dissipates(measured):
    """A film without cavities between ends at no pressure: heat of shear and of pressure flow, summed over the cells
    of a fine grid, is the power of wrench and modal loads to 6e-5. The moment of the pressure on the deflected journal
    is 9e-3 of it."""
    pin = journal(waves)
    model = model_of(pin, ehd.FiniteLength(n_theta=144, n_z=40), cavitation=ehd.FullSommerfeld())
    rng = np.random.default_rng(5)
    motion = random_motion(rng, 5)
    motion[8:10], motion[10:15] = (250.0, 0.0), 1.5e-6 * rng.normal(size=5)
    found, g = model.evaluate(motion, spin=1.1), model.grid
    x, y, bx, by, x_t, y_t, bx_t, by_t, omega, _ = motion[:10]
    F, axis = found.wrench, np.array([bx, by, 1.0]) / np.sqrt(1.0 + bx**2 + by**2)
    centre = np.array([x, y, 0.0])
    about = F[3:] - np.cross(centre, F[:3])
    power = -(F[0] * x_t + F[1] * y_t - F[3] * by_t + F[4] * bx_t + omega * (about @ axis))
    power -= found.bore.load @ motion[15:]
    mu, h, p = 0.01, model.solver.H * C, found.film.oil.P * found.film.scales.pressure
    width = g.width_x[0] * R
    along_x = (np.roll(p, -1, axis=0) - p) / width
    face = 0.5 * (h + np.roll(h, -1, axis=0))
    z = g.z * R
    along_z = np.diff(p, axis=1) / np.diff(z)
    side = 0.5 * (h[:, 1:] + h[:, :-1])
    area_z = g.weight_z * R
    heat = np.sum(g.weight * R**2 * mu * (R * omega) ** 2 / h)
    heat += np.sum(face**3 / (12 * mu) * along_x**2 * width * area_z)
    heat += np.sum(side**3 / (12 * mu) * along_z**2 * width * np.diff(z))
    measured("power", abs(power / heat - 1.0), 2e-4)
    assert abs(found.moment * omega) > 0.005 * heat
    assert found.quantities()["power_loss"] == pytest.approx(power, rel=1e-5)


def test_shape_that_stands_is_the_same_at_any_angle(measured):
    """A journal that is the same in all directions settles under the film as one that does not turn does."""

    def same(theta, z):
        out = np.zeros((theta.size, 3, 4))
        profile = 1 - (2.0 * z / L) ** 2
        for i, wave in enumerate((np.cos(2 * theta), np.sin(2 * theta), np.cos(3 * theta), np.sin(3 * theta))):
            out[:, 0, i] = wave * profile
        return out

    pin = journal(same, around=36)
    model = model_of(pin)
    motion = np.array([0.2 * C, -0.6 * C, 0, 0, 0, 0, 0, 0, 200.0, 0])
    found = [model.evaluate_steady(motion, spin=spin) for spin in (0.0, 0.9)]
    assert np.abs(found[0].bore.coordinates).max() > 1e-8
    for name in ("minimum_gap", "wrench"):
        own, other = (np.array(getattr(state, name)) for state in found)
        measured(name, np.abs(own - other).max() / np.abs(own).max(), 1e-3)


def test_description_refuses_what_it_does_not_carry():
    pin = journal(waves)
    with pytest.raises(InputError, match="itemNumbers\\[1\\]"):
        model_of(ehd.FEJournal(fem=dataclasses.make_dataclass("Fem", ["elements"])([])))
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    cylinder = ehd.HollowCylinder(inner_radius=R + C, thickness=0.01, length=L, axial=2, radial=1, circumferential=12)
    bush = ehd.ModalBush(mesh=cylinder, material=steel)
    with pytest.raises(InputError, match="rigid bore"):
        model_of(ehd.FEJournal(fem=dataclasses.make_dataclass("Fem", ["elements"])([])), bush=bush)
    with pytest.raises(InputError, match="FEMinterface"):
        ehd.FEJournal(fem=None)
    assert pin.count == 5
