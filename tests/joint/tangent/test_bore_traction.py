"""Shear and contact friction on the nodes of a bore.

A plain twin, resultants, exact tangent, an operator, Couette shear in closed form.
"""

from __future__ import annotations

import numpy as np
import pytest
from bore_states import BUSHES, OPTIONS, C, make_bearing, random_motion

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.tangent.nodes import BoreForces, traction
from exudyn_ehd.status import Status
from tests.sampling import but_slow

MORE = OPTIONS | {
    "asperity": {
        "asperity": ehd.GreenwoodTripp(
            composite_roughness=3e-6,
            composite_modulus=1e11,
            friction_coefficient=0.12,
        )
    },
    "recess": {"supply": (ehd.AxialGroove(angle=2.0, width_angle=0.5, length=0.04, pressure=1e5, depth=3e-4),)},
    "elrod thinning": {
        "cavitation": ehd.ElrodAdams(cavity_pressure=-1e5),
        "lubricant": ehd.Lubricant(viscosity=9e-3, shear_law=ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)),
    },
}


def evaluated(option, seed=1):
    model = build_model(make_bearing(BUSHES["nodal"], **MORE[option]))
    motion = random_motion(model.bore.size, seed)
    history = model.initial_history(0.9 * motion)
    step = 0.0 if history is None else 1e-4
    evaluation = model.evaluate(motion, history, step)
    assert evaluation.status is Status.CONVERGED
    return model, motion, history, step, evaluation, BoreForces(model.bore)


def plain(film):
    """Forces along theta and z at every vertex (2, n, m), from their definition."""
    g, R, c = film.grid, film.grid.reference_length, film.parts.bearing.radial_clearance
    mu = film.scales.shear * c / R**2
    p, h, share = film.oil.P * film.scales.pressure, film.solver.H * c, film.share()
    delta = film.extra.height * c
    ratio = 1.0 if film.oil.ratio is None else film.oil.ratio
    speeds = R * film.journal.omega, film.journal.axial_speed
    slopes = (
        lambda f: (np.roll(f, -1, axis=0) - np.roll(f, 1, axis=0)) / (2 * R * g.width_x[0]),
        lambda f: np.gradient(f, g.z * R, axis=1),
    )
    out = np.stack(
        [mu * v / h * share * ratio - 0.5 * h * by(p) - p * by(delta) for v, by in zip(speeds, slopes, strict=True)]
    )
    area = g.weight * R**2
    out *= area
    if film.parts.supply is not None:
        areas = zip(film.parts.bearing.supply, film.parts.supply.parts, strict=True)
        recesses = sum(part * R**2 * 4.0 / area.depth for area, part in areas if area.depth is not None)
        for k, v in enumerate(speeds):
            out[k] += mu * v * ((g.lands - g.weight) * R**2 / h * share * ratio + recesses)
    if film.pressing is not None:
        for (friction, transition), P in zip(film.pressing.friction, film.pressing.P, strict=True):
            v = np.array(speeds)
            slip = v / np.sqrt(v @ v + transition**2)
            out += friction * slip[:, None, None] * P * area
    return out


@pytest.mark.parametrize("option", but_slow(MORE, "line in its cells", "elrod in cells"))
def test_shear_is_that_of_its_definition_and_adds_up_to_the_torque_of_the_bearing(option):
    model, _, _, _, evaluation, forces = evaluated(option)
    film = evaluation.film
    expected, got = plain(film), traction(film, forces).reshape(2, *model.grid.shape)
    assert np.abs(got - expected).max() < 1e-12 * np.abs(expected).max()
    nodal = evaluation.nodal_forces()
    R = model.grid.reference_length
    if not option.endswith(("rough journal", "asperity")):
        # summed by parts there, by differences here: of the second order of the grid of 32 x 6
        assert got[0].sum() * R == pytest.approx(-evaluation.wrench[5], rel=0.03)
    # nodes at the bore's radius; the shape functions add up to one
    assert nodal[:, 2].sum() == pytest.approx(got[1].sum(), rel=1e-10, abs=1e-12 * np.abs(got).sum())


def test_shear_of_a_concentric_journal_is_that_of_petroff():
    model = build_model(make_bearing(BUSHES["nodal"], film=ehd.FiniteLength(n_theta=96, n_z=12)))
    motion = np.zeros(10)
    motion[8] = 300.0
    forces = BoreForces(model.bore)
    shear = traction(model.evaluate(motion).film, forces)
    R, mu = 0.03, 9e-3
    expected = mu * 300.0 * R / C * model.grid.weight.ravel() * R**2
    assert np.abs(shear[0] - expected).max() < 1e-12 * expected.max()
    assert not shear[1].any()
    nodal = forces.nodal(np.stack((np.zeros(shear.shape[1]), *shear)))
    place = BUSHES["nodal"].build_mesh().bore.positions
    # tangential at every node, up to the angle between a node and the vertices around it
    radial = np.einsum("ni,ni->n", nodal[:, :2], place[:, :2]) / R
    assert np.abs(radial).max() < 1e-10 * np.abs(nodal).max()


LATER = ("line in its cells", "elrod in cells", "gumbel", "full", "ends", "rough", "piezoviscous", "compressible")


@pytest.mark.parametrize("option", but_slow(MORE, *LATER))
def test_tangent_is_the_derivative_of_wrench_and_nodal_forces(option):
    model, motion, history, step, evaluation, _ = evaluated(option)
    probe = build_model(make_bearing(BUSHES["nodal"], **MORE[option]))
    k, active = model.bore.size, model.solver.work.active.copy()
    tangent = evaluation.nodal_tangent()
    wrench, nodal = tangent.whole()
    assert np.abs(wrench - evaluation.tangent()[:6]).max() < 1e-12 * np.abs(wrench).max()
    change = np.random.default_rng(4).normal(size=motion.size)
    unit = np.concatenate(([C, C, C / 0.03, C / 0.03, 0.01, 0.01, 0.3, 0.3, 300, 9.0], np.full(k, C), np.full(k, 0.01)))
    change *= unit
    rows, got = (part[..., 0] for part in tangent.changes(*np.split(change[:, None], (10, 10 + k))))
    # rounding of one film solve against another, in the largest force and the largest moment
    for part in (slice(3), slice(3, 6)):
        expected = wrench[part] @ change
        assert np.abs(rows[part] - expected).max() < 1e-10 * np.abs(expected).max()
    expected = nodal @ change
    for axis in range(3):
        # rounding of one film solve against another
        assert np.abs(got[:, axis] - expected[:, axis]).max() < 1e-9 * np.abs(expected[:, axis]).max()
    rows = np.abs(nodal * unit).max(axis=(0, 2))
    for j in [*range(10), *range(10, motion.size, 11)]:
        for size in (1e-5, 1e-6, 1e-7):
            ends, same = [], True
            for sign in (1.0, -1.0):
                moved = motion.copy()
                moved[j] += sign * size * unit[j]
                ends.append(probe.evaluate(moved, history, step).nodal_forces())
                same &= np.array_equal(probe.solver.work.active, active)
            if same:
                break
        else:
            raise AssertionError("not a smooth state: choose another one")
        numeric = (ends[0] - ends[1]) / (2.0 * size)
        # 1e-6 as in the test of the pressure's loads; shear alone acts along z, and is a thousandth of pressure
        # elsewhere
        error = np.abs(nodal[:, :, j] * unit[j] - numeric).max(axis=0)
        assert np.all(error < 1e-6 * rows), (j, size, error / rows)
