"""Speed of the film: growth of the short one with its grid, equilibrium, and the ratio to SOR.

Run with ``pytest -m benchmark tests/benchmarks``; compilation is apart. The journal moves along an
orbit, 1 degree and a small change of eccentricity per evaluation (a time step of 3 degrees with three evaluations), so
that the active set has to follow as in a time integration.
"""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from numba import njit

import exudyn_ehd as ehd
from exudyn_ehd.film.loads import pressure_integrals
from exudyn_ehd.film.reynolds.balance import right_hand_side
from exudyn_ehd.film.reynolds.gap import rigid_gap
from exudyn_ehd.film.reynolds.links import set_links
from exudyn_ehd.joint.model.build import build_model
from tests.benchmarks.accuracy.costs import effects

pytestmark = pytest.mark.benchmark

SPEED = 100.0
GRIDS = [(64, 16), (128, 12), (96, 24)]


def _orbit(bearing):
    return effects.orbit(bearing.radial_clearance, SPEED, 720)


class _Follower:
    """Evaluates one state of the orbit after the other."""

    def __init__(self, bearing):
        self.model, self.motions, self.k = build_model(bearing), _orbit(bearing), 0

    def __call__(self):
        evaluation = self.model.evaluate(self.motions[self.k % len(self.motions)])
        self.k += 1
        return evaluation.wrench, evaluation.tangent()


def _median_ms(function, rounds=240):
    for _ in range(20):
        function()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return 1e3 * float(np.median(times))


def test_short_bearing_grows_less_than_its_grid(make_bearing):
    """Four times the grid in 2.3 times the time: half of a small one is what every evaluation pays."""
    films = {n: ehd.ShortBearing(n_theta=n) for n in (64, 256)}
    models = {n: build_model(make_bearing(0.25, film=film)) for n, film in films.items()}
    times = effects.block(models, _orbit(models[64].bearing)[:60], 12)
    factor = times[256][0] / times[64][0]
    print(f"{factor:.2f}")
    assert factor < 2.6


@pytest.mark.parametrize("So", (0.1, 3.0, 30.0))
def test_equilibrium_with_stiffness_and_damping(make_bearing, So):
    """In evaluations with tangent along an orbit: 16 to 22, a start from nowhere included."""
    bearing = make_bearing(1.0)
    load = (0.0, -So * bearing.reference_force(SPEED))
    model, states, best = build_model(bearing), _orbit(bearing)[:60], math.inf
    evaluation = math.inf
    for _ in range(10):
        start = time.process_time()
        ehd.equilibrium(bearing, speed=SPEED, load=load)
        best = min(best, time.process_time() - start)
        evaluation = min(evaluation, effects.block({"film": model}, states, 1)["film"][0])
    print(f"{1e3 * best:.2f} ms, {best / evaluation:.1f} evaluations")
    assert best / evaluation < 26.0


@njit(cache=True)
def _sor(kx, kz, b, pc, relax, tolerance, P):
    """Projected successive over-relaxation of the rows 1 .. m - 2; returns the sweeps."""
    n, m = b.shape
    for sweep in range(100000):
        change = 0.0
        peak = 1e-300
        for i in range(n):
            up = i + 1 if i + 1 < n else 0
            down = i - 1 if i > 0 else n - 1
            for j in range(1, m - 1):
                east, west, north, south = kx[i, j], kx[down, j], kz[i, j], kz[i, j - 1]
                new = (b[i, j] + east * P[up, j] + west * P[down, j] + north * P[i, j + 1] + south * P[i, j - 1]) / (
                    east + west + north + south
                )
                new = max(pc, P[i, j] + relax * (new - P[i, j]))
                change = max(change, abs(new - P[i, j]))
                peak = max(peak, abs(new))
                P[i, j] = new
        if change < tolerance * peak:
            return sweep + 1
    return -1


class _RelaxedFilm:
    """A film solved by SOR from the last pressure, its tangent by forward differences of all ten components."""

    def __init__(self, bearing, relax, tolerance):
        self.model, self.relax, self.tolerance = build_model(bearing), relax, tolerance
        self.P = np.zeros(self.model.grid.shape)
        self.motions, self.k = _orbit(bearing), 0
        c, R, L = bearing.radial_clearance, bearing.journal_radius, bearing.length
        slope = 2 * c / L
        self.steps = 1e-4 * np.array(
            [c, c, slope, slope, c * SPEED, c * SPEED, slope * SPEED, slope * SPEED, SPEED, R * SPEED]
        )

    def loads(self, motion, P):
        m, s, g = self.model.parts, self.model.solver, self.model.grid
        pose, rate = motion[:4] * m.pose_scale, motion[4:8] * m.pose_scale
        vx, vz = 0.5 * motion[8], 0.5 * motion[9] / g.reference_length
        cos_x, sin_x, cos_f, sin_f, z = g.directions
        rigid_gap(pose, cos_x, sin_x, z, 1.0, s.H)
        rigid_gap(pose, cos_f, sin_f, z, 1.0, s.HF)
        rigid_gap(rate, cos_x, sin_x, z, 0.0, s.H_t)
        y = s.system
        set_links(s.H, s.HF, None, s.metric, vx, vz, y.fields)
        right_hand_side(y.fx, y.fz, True, s.H_t, s.area, y.b)
        sweeps = _sor(y.kx, y.kz, y.b, 0.0, self.relax, self.tolerance, P)
        out = np.empty(4)
        pressure_integrals(P, g.weight, g.gap_shapes, out)
        return out * self.model.scales.force, sweeps

    def __call__(self):
        motion = self.motions[self.k % len(self.motions)]
        self.k += 1
        base, self.sweeps = self.loads(motion, self.P)
        tangent = np.empty((4, 10))
        for k in range(10):
            moved = motion.copy()
            moved[k] += self.steps[k]
            tangent[:, k] = (self.loads(moved, self.P.copy())[0] - base) / self.steps[k]
        return base, tangent


@pytest.mark.parametrize(("n_theta", "n_z"), GRIDS)
def test_against_sor(make_bearing, n_theta, n_z, capsys):
    """The film is at least 15 times faster than SOR with its best relaxation and a difference tangent, in one run.

    SOR stops when the largest change in a sweep falls below a share of the peak. The ratio counts at the loosest
    tolerance that keeps the force's error below 1e-8, which an implicit solver with a Newton tolerance of 1e-6 needs
    (the direct solution is at rounding, and its tangent is exact). All tolerances are printed.
    """
    bearing = make_bearing(1.0, film=ehd.FiniteLength(n_theta=n_theta, n_z=n_z))

    def sweeps(relax):
        film = _RelaxedFilm(bearing, relax, 1e-8)
        return film.loads(film.motions[0], film.P)[1]

    best = float(min(np.arange(1.5, 1.99, 0.02), key=sweeps))
    exact_film = _RelaxedFilm(bearing, best, 1e-14)
    exact = exact_film.loads(exact_film.motions[0], exact_film.P)[0][:2]
    wrench, tangent = _Follower(bearing)()
    size, stiff = float(np.hypot(*exact)), float(abs(tangent[:2, :2]).max())
    error_ours = float(np.hypot(*(wrench[:2] + exact))) / size
    fast = _median_ms(_Follower(bearing))
    lines, ratio = (
        [f"{n_theta} x {n_z}: direct {fast:.3f} ms, force error {error_ours:.1e}; SOR, relaxation {best:.2f}:"],
        0.0,
    )
    for tolerance in (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
        force, difference = _RelaxedFilm(bearing, best, tolerance)()
        error_force = float(np.hypot(*(force[:2] - exact))) / size
        error_tangent = float(abs(difference[:2, :2] + tangent[:2, :2]).max()) / stiff
        slow = _median_ms(_RelaxedFilm(bearing, best, tolerance), rounds=20)
        lines.append(
            f"  tolerance {tolerance:.0e}: {slow:.2f} ms, force error {error_force:.1e}, "
            f"stiffness error {error_tangent:.1e}, "
            f"factor {slow / fast:.0f}"
        )
        assert error_ours < error_force
        if ratio == 0.0 and error_force < 1e-8:
            ratio = slow / fast
    with capsys.disabled():
        print("\n" + "\n".join(lines))
    assert ratio >= 15.0
