"""Films on elastic journals: symmetry with bores, an independent coupled solution, tangents, frames, torque."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from bore_states import OPTIONS, STEEL, C, make_bearing, random_motion
from scipy.sparse import csr_matrix

import exudyn_ehd as ehd
from exudyn_ehd.joint.bore.equilibrium import Elasticity
from exudyn_ehd.joint.bore.shapes import ModalBore
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.model.flexible import ElasticBearingModel
from exudyn_ehd.solid.journal import journal_modes
from exudyn_ehd.status import Status
from tests.sampling import but_slow, sample

BOSSES = ehd.HeldBands(bands=((-0.08, -0.04), (0.04, 0.08)))
# An overhung pin has no mid-plane: its modes are neither even nor odd.
OVERHUNG = ehd.HeldBands(bands=((0.04, 0.08),))
PINS = {
    "free": ehd.ElasticJournal(material=STEEL, span=(-0.04, 0.05), held=None, tolerance=0.2),
    "bosses": ehd.ElasticJournal(material=STEEL, span=(-0.08, 0.08), held=BOSSES, inner_radius=0.018, tolerance=0.2),
    "overhung": ehd.ElasticJournal(material=STEEL, span=(-0.035, 0.08), held=OVERHUNG, tolerance=0.2),
}
CYLINDER = ehd.HollowCylinder(inner_radius=0.03, thickness=0.02, length=0.066, axial=2, radial=1, circumferential=12)
BUSHES = {"rigid": None, "modal": ehd.ModalBush(mesh=CYLINDER, material=STEEL, tolerance=0.2)}
SCENES = [("free", "rigid"), ("bosses", "modal"), ("overhung", "rigid")]


class AsFaces:
    """The surface of a journal as that of a bore: its "nodes" are its modes."""

    rims, count = np.zeros((0, 4)), 1

    def __init__(self, modes):
        self.modes, self.cuts = modes, (np.zeros(0), modes.edges)

    def interpolation(self, theta, z):
        return csr_matrix(self.modes.around(theta) * self.modes.along(z))


@pytest.mark.parametrize("pin", sample(PINS, 0))
def test_equal_compliance_in_bore_or_journal_gives_the_same_film(pin):
    bearing = make_bearing(None, journal=PINS[pin], end_pressures=(3e5, 1e5))
    modes = journal_modes(bearing.journal, bearing.journal_radius, bearing.length)
    as_bore = SimpleNamespace(
        count=modes.count,
        stiffness=modes.stiffness,
        faces=AsFaces(modes),
        radial_of=lambda values, theta, z: values.toarray(),
    )
    other = ElasticBearingModel(
        dataclasses.replace(bearing, journal=None),
        lambda grid: ModalBore(as_bore, grid),
        elasticity=Elasticity(np.diag(modes.stiffness)),
    )
    motion = np.array([0.5 * C, 0.75 * C, 1e-4, -1e-4, 0.0, 0.0, 0.0, 0.0, 300.0, 0.0])
    mine, its = build_model(bearing).evaluate_steady(motion), other.evaluate_steady(motion)
    assert mine.status is its.status is Status.CONVERGED
    assert np.abs(mine.bore.displacement).max() > 0.05
    for a, b in (
        (mine.wrench[:3], its.wrench[:3]),
        (mine.wrench[3:], its.wrench[3:]),
        (mine.film.oil.P, its.film.oil.P),
    ):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-10 * np.abs(b).max())


@pytest.mark.parametrize("option", but_slow(OPTIONS, *set(OPTIONS) - {"swift", "wall", "ends"}))
@pytest.mark.parametrize(("pin", "bush"), SCENES)
def test_tangent(pin, bush, option):
    """d (wrench, Q) / d motion against central differences, in directions at random."""
    bearing = make_bearing(BUSHES[bush], journal=PINS[pin], **OPTIONS[option])
    model, probe = build_model(bearing), build_model(bearing)
    k = model.bore.size
    motion = random_motion(k, 1)
    history = model.initial_history(0.9 * motion)
    step = 0.0 if history is None else 1e-4
    evaluation = model.evaluate(motion, history, step)
    assert evaluation.status is Status.CONVERGED
    tangent, active = evaluation.tangent(), model.solver.work.active.copy()
    unit = np.concatenate(([C, C, C / 0.03, C / 0.03, 0.01, 0.01, 0.3, 0.3, 300, 9.0], np.full(k, C), np.full(k, 0.01)))
    scale = np.abs(tangent * unit).max(axis=1)
    rng, checked = np.random.default_rng(2), 0
    for _ in range(6):
        change = rng.normal(size=unit.size) * unit / np.sqrt(unit.size)
        for size in (1e-5, 1e-6, 1e-7):
            loads, same = [], True
            for sign in (1.0, -1.0):
                e = probe.evaluate(motion + sign * size * change, history, step)
                loads.append(np.concatenate((e.wrench, e.bore.load)))
                same &= np.array_equal(probe.solver.work.active, active)
            if same:
                break
        else:
            continue
        checked += 1
        numeric = (loads[0] - loads[1]) / (2.0 * size)
        # as in tests/joint/tangent/test_bore.py
        assert np.all(np.abs(numeric - tangent @ change) <= 1e-6 * scale + 1e-300)
    assert checked > 3


@pytest.mark.parametrize(("pin", "bush"), [SCENES[1], *(pytest.param(*s, marks=pytest.mark.slow) for s in SCENES[::2])])
def test_stiffness_and_damping_of_an_equilibrium(pin, bush):
    bearing = make_bearing(BUSHES[bush], journal=PINS[pin])
    found = ehd.equilibrium(bearing, speed=300.0, load=(0.0, -1e4))
    assert found.film.bore_coordinates.size == build_model(bearing).bore.size
    model = build_model(bearing)
    for place, matrix in ((0, found.stiffness), (4, found.damping)):
        for i in range(2):
            forces = []
            for size in np.array([1.0, -1.0]) * (1e-9 if place == 0 else 1e-6):
                motion = found.film.motion[:10].copy()
                motion[place + i] += size
                forces.append(_following(model, motion, i, size if place else 0.0)[:2])
            numeric = -(forces[0] - forces[1]) / (2.0 * abs(size))
            # differences of forces whose balance is found to 1e-11
            np.testing.assert_allclose(numeric, matrix[:, i], rtol=0.0, atol=1e-4 * np.abs(matrix).max())


def _following(model, motion, i, rate):
    """Wrench of the steady film, or with a rate of the position and the rate of q that follows it."""
    if not rate:
        return model.evaluate_steady(motion).wrench
    at_rest = motion.copy()
    at_rest[4:8] = 0.0
    q, h = [], 1e-10
    for sign in (1.0, -1.0):
        moved = at_rest.copy()
        moved[i] += sign * h
        q.append(model.evaluate_steady(moved).bore.coordinates.copy())
    q_t = (q[0] - q[1]) / (2.0 * h) * rate
    # the bore is in balance with the moving film
    q, stiffness = model.evaluate_steady(at_rest).bore.coordinates.copy(), model.elasticity.stiffness
    for _ in range(8):
        e = model.evaluate(np.concatenate((motion, q, q_t)))
        q = q + np.linalg.solve(stiffness - e.combined_tangent(1.0, 0.0)[6:, 10:], e.bore.load - stiffness @ q)
    return model.evaluate(np.concatenate((motion, q, q_t))).wrench


def test_turning_the_scene_turns_the_film():
    """By steps of the grid: nothing of a pin knows an angle."""
    bearing = make_bearing(None, journal=PINS["overhung"])
    films = []
    for turn in (0, 5):
        angle = 2.0 * np.pi * turn / 32
        R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        motion = np.concatenate((R @ (0.3 * C, 0.6 * C), R @ (1e-4, 2e-4), np.zeros(4), [300.0, 0.0]))
        e = build_model(bearing).evaluate_steady(motion)
        assert e.status is Status.CONVERGED
        films.append((np.roll(e.film.oil.P, -turn, axis=0), R.T @ e.wrench[:2], R.T @ e.wrench[3:5], e.wrench[5]))
    for a, b in zip(*films, strict=True):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-9 * np.abs(b).max())


@pytest.mark.parametrize(("pin", "bush"), SCENES)
def test_pressure_does_not_turn_a_deflected_pin(pin, bush):
    """Int p d(C p)/d theta vanishes for a compliance C that turns with the pressure: all torque is the shear's."""
    model = build_model(make_bearing(BUSHES[bush], journal=PINS[pin]))
    bore = model.bore
    e = model.evaluate_steady(np.array([0.5 * C, 0.75 * C, 1e-4, -1e-4, 0.0, 0.0, 0.0, 0.0, 300.0, 0.0]))
    q = e.bore.coordinates
    waves, phases = bore.journal.waves, bore.journal.phases
    # a quarter of a wave further, times the wave's number: cos to sin, sin to -cos, of the same profile
    turned = np.zeros_like(q)
    for n in np.unique(waves[waves > 0]):
        cos, sin = (bore.own + np.flatnonzero((waves == n) & (phases > 0.1) == kind) for kind in (False, True))
        cos = cos[waves[cos - bore.own] == n]
        turned[cos], turned[sin] = n * q[sin], -n * q[cos]
    work = e.bore.load * turned
    # of the pin's modes; 1e-9 of the balance that the search leaves
    assert abs(work[bore.own :].sum()) < 1e-9 * np.abs(work[bore.own :]).sum()


def test_modes_of_an_ideal_film_grid_have_the_loads_of_the_pressure():
    """Uniform end pressures press all of the film's area: with the ends' loads, n = 0 alone moves, as by Lamé."""
    pin = ehd.ElasticJournal(material=STEEL, span=(-0.033, 0.033), held=None, tolerance=0.2)
    bearing = make_bearing(None, journal=pin, end_pressures=(4e7, 4e7))
    e = build_model(bearing).evaluate_steady(np.array([0.0] * 8 + [1.0, 0.0]))
    moved = e.bore.displacement * C
    # plane stress at free ends, p a (1 - nu) / E, for a cylinder pressed over all of its length
    np.testing.assert_allclose(moved, 4e7 * 0.03 * 0.7 / 2.1e11, rtol=2e-3)


@pytest.mark.slow
def test_against_a_coupled_solution_on_hexahedra():
    """A hollow pin in two bosses: compliance of a mesh on the film's vertices, coupled by a damped fixed point."""
    from exudyn_ehd.solid.mesh import HollowCylinder
    from exudyn_ehd.solid.total_lagrange import TotalLagrange, sparse_factor

    radius, length, c = 0.01, 0.02, 12e-6
    mesh = HollowCylinder(
        inner_radius=0.004, thickness=0.006, length=0.06, axial=24, radial=2, circumferential=32
    ).mesh()
    grid = ehd.bearing_grid(radius, length, n_theta=96, n_z=12)
    fixed = np.zeros(len(mesh.nodes), dtype=bool)
    fixed[mesh.outer.nodes[np.abs(mesh.outer.z) > 0.015 - 1e-9]] = True
    free = np.repeat(~fixed, 3)
    K = TotalLagrange(mesh=mesh, material=STEEL).tangent(np.zeros_like(mesh.nodes))[free][:, free]
    factor = sparse_factor(K)
    T, Z = np.meshgrid(grid.x, grid.z * grid.reference_length, indexing="ij")
    rows = mesh.outer.radial_interpolation(T.ravel(), Z.ravel()).tocoo()
    columns = 3 * mesh.outer.nodes[rows.col // 3] + rows.col % 3
    H = csr_matrix((rows.data, (rows.row, columns)), shape=(T.size, free.size))[:, free]
    area = (grid.weight * grid.reference_length**2).ravel()
    speed, place, tilt = 100.0, (0.2 * c, 0.8 * c), (0.0, 1e-4)
    lubricant, rigid = ehd.Lubricant(viscosity=9e-3), c - (place[0] + tilt[0] * Z) * np.cos(T)
    rigid = rigid - (place[1] + tilt[1] * Z) * np.sin(T)
    inwards = np.zeros(T.shape)
    for _ in range(60):
        film = ehd.solve_film(grid, rigid + inwards, surface_speed=(speed * radius, 0.0), lubricant=lubricant)
        moved = (H @ factor.solve(H.T @ (film.pressure.ravel() * area))).reshape(T.shape)
        change = np.abs(moved - inwards).max()
        inwards = inwards + 0.3 * (moved - inwards)
    assert change < 1e-3 * np.abs(inwards).max() < 1e-8
    held = ehd.HeldBands(bands=((-0.03, -0.015), (0.015, 0.03)))
    pin = ehd.ElasticJournal(material=STEEL, span=(-0.03, 0.03), held=held, inner_radius=0.004, tolerance=0.005)
    bearing = ehd.JournalBearing(
        journal_radius=radius,
        length=length,
        radial_clearance=c,
        lubricant=lubricant,
        film=ehd.FiniteLength(n_theta=96, n_z=12),
        cavitation=ehd.SwiftStieber(line_in_cells=False),
        journal=pin,
    )
    motion = np.array([*place, *tilt, 0.0, 0.0, 0.0, 0.0, speed, 0.0])
    e = build_model(bearing).evaluate_steady(motion)
    assert e.status is Status.CONVERGED
    pressure, gap = e.film.oil.P * e.film.scales.pressure, e.film.solver.H * c
    # the pin yields by half of the gap; the hexahedra are too stiff by 3 % beside the bosses, as in
    # tests/solid/test_harmonics.py
    assert pressure.max() == pytest.approx(film.pressure.max(), rel=0.01)
    assert gap.min() == pytest.approx((rigid + inwards).min(), rel=0.01)
    assert np.abs(gap - rigid - inwards).max() < 0.04 * np.abs(inwards).max()
