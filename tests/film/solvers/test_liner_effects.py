"""Liner with contact, mass-conserving cavitation, laws of the oil or flow
factors: Winkler elements, a readable twin solved by scipy, limits, balances."""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import brentq, root
from scipy.special import ndtr

import exudyn_ehd as ehd
from exudyn_ehd.film.banded.factors import number_cells, number_with_corners
from exudyn_ehd.film.banded.workspace import add_corners, add_tangents, assemble
from exudyn_ehd.film.cavitation.states import OIL
from exudyn_ehd.film.grid import bearing_grid
from exudyn_ehd.film.heat.energy import ViscosityField
from exudyn_ehd.film.lubricant.pressure_viscosity import PressureTransform
from exudyn_ehd.film.lubricant.shear_profile import EXACT, fluidity_table, gauss_points, profile
from exudyn_ehd.film.lubricant.shear_thinning import ShearThinning
from exudyn_ehd.film.reynolds.balance import film_slopes
from exudyn_ehd.film.solvers.solver import FilmSolver
from exudyn_ehd.film.solvers.winkler import Liner
from exudyn_ehd.film.solvers.winkler_kernels import Rates, add_gap_slopes
from exudyn_ehd.film.surfaces.contact import WallContact
from exudyn_ehd.film.surfaces.roughness import (
    AsperityContact,
    RoughFlow,
    greenwood_tripp_integral,
    pressure_flow_factor,
    shear_flow_factor,
)
from tests.sampling import sample

GRID = bearing_grid(0.02, 0.03, 32, 6)
SMALL = bearing_grid(0.02, 0.03, 16, 4)
SCALE, CLEARANCE = 1e5, 20e-6
WALL = ehd.RegularisedWall(onset=0.1 * CLEARANCE, pressure=4e8)
ROUGH = ehd.GreenwoodTripp(composite_roughness=0.03 * CLEARANCE, composite_modulus=2e11)
CONTACTS = {
    "none": lambda: None,
    "wall": lambda: WallContact(WALL, CLEARANCE),
    "asperities": lambda: AsperityContact(ROUGH, CLEARANCE),
}
CLOSURES = [ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.ElrodAdams()]
every_closure = pytest.mark.parametrize("closure", CLOSURES, ids=lambda c: type(c).__name__)
every_contact = pytest.mark.parametrize("contact", CONTACTS)
touching = pytest.mark.parametrize("contact", ["wall", "asperities"])
ENDS = (0.5, 1.0)
BARUS = ehd.BarusPressure(coefficient=2e-7)
THINNING = ehd.CarreauShear(relaxation_time=2e-6, exponent=0.6, residual=0.1)
UNEVEN = ehd.PatirCheng(composite_roughness=0.03 * CLEARANCE, journal_share=0.9)
WARM = 1.0 + 0.3 * np.sin(np.arange(80)).reshape(16, 5)


def gaps(grid, eps, angle=0.3, rate=0.0):
    """Gap at vertices and links and the gap's rate of a parallel journal."""

    def row(x):
        return np.outer(1.0 - eps * np.cos(x - angle), np.ones(grid.z.size))

    return np.array([row(grid.x), row(grid.x_face), -rate * np.outer(np.cos(grid.x), np.ones(grid.z.size))])


def flux_of(effect):
    """Flux effects of one bearing model."""
    if effect == "carreau":
        return (ShearThinning(THINNING, 0.02, CLEARANCE),)
    if effect == "rough":
        return (RoughFlow(UNEVEN, CLEARANCE, ROUGH.residual_film),)
    if effect == "warm":
        field = ViscosityField()
        field.set(WARM)
        return (field,)
    return ()


def solver_of(closure, contact, grid=GRID, effect="none"):
    surfaces = CONTACTS[contact]()
    oil = PressureTransform(BARUS) if effect == "barus" else None
    made = FilmSolver(grid, closure, flux_effects=flux_of(effect), liner=Liner(surfaces, surfaces, oil))
    made.pressure_scale = SCALE
    return made


def unknown(oil, p):
    """Scaled unknown of the film for scaled pressures."""
    return p if oil is None else oil.transform(np.asarray(p) * SCALE) / SCALE


def solve(solver, beta, eps=0.6, rate=0.0, cold=True, mass_old=None, delta_old=None, step=0.0):
    solver.elements.beta = beta
    solver.H[:], solver.HF[:], solver.H_t[:] = gaps(solver.grid, eps, rate=rate)
    solver.pressure[:, 0], solver.pressure[:, -1] = unknown(solver.elements.oil, ENDS)
    solver.elements.delta_old = delta_old
    if cold:
        solver.forget()
    status, _ = solver.solve(50.0, 3.0, solver.closure.cavity_pressure, mass_old, step)
    assert status is ehd.Status.CONVERGED
    return solver


def contact_twin(contact):
    """(pressure over the film's scale, gap that the film sees) as functions of
    one true gap, from the textbook formulas."""
    if contact == "none":
        return lambda g: 0.0, lambda g: g
    if contact == "wall":
        onset, a = WALL.onset / CLEARANCE, 1.0 - WALL.residual

        def seen(g):
            return g if g >= onset else onset * (1.0 - a * np.tanh((1.0 - g / onset) / a))

        return lambda g: WALL.pressure / SCALE * max(0.0, 1.0 - g / onset) ** 2, seen
    sigma = ROUGH.composite_roughness / CLEARANCE

    def mean(g):
        y = g / sigma - ROUGH.residual_film
        return sigma * (ROUGH.residual_film + y * ndtr(y) + np.exp(-0.5 * y * y) / np.sqrt(2.0 * np.pi))

    def pressure(g):
        # deeper than the tabulated integral reaches, by its leading power; beyond 8 sigma none
        u = g / sigma
        return 0.0 if u >= 8.0 else ROUGH.pressure_scale / SCALE * float(greenwood_tripp_integral(2.5, u))

    return pressure, mean


def link_twin(effect, vx, grid, Q):
    """(conductance, carrier) as functions of (i, j, axis, gap) from the textbook formulas; Q the film's unknown."""
    if effect == "carreau":
        k, oil = 2.0 * THINNING.relaxation_time * 0.02 / CLEARANCE, fluidity_table(THINNING)
        # gradients at the vertices, numpy's of second order
        along = np.gradient(np.pad(Q, ((1, 1), (0, 0)), mode="wrap"), grid.x[1] - grid.x[0], axis=0)[1:-1]
        across = np.gradient(Q, grid.z, axis=1)

        def thinned(i, j, axis, h):
            other = ((i + 1) % len(Q), j) if axis == 0 else (i, j + 1)
            # no gradient at all is a flow over its gradient in the limit
            own = (Q[other] - Q[i, j] or 1e-9) * (grid.link_x[i] if axis == 0 else grid.link_z[j])
            cross = across if axis == 0 else along
            G = 6.0 * k * h * np.array([own, 0.5 * (cross[i, j] + cross[other])])
            p = profile(k * vx / h, *(G if axis == 0 else G[::-1]), oil, gauss_points(6), 0.0, 0.0, EXACT)[0]
            return 12.0 * h**3 * (p.F_x if axis == 0 else p.F_z) / G[0], h

        return thinned
    if effect == "rough":
        sigma = UNEVEN.composite_roughness / CLEARANCE

        def rough(i, j, axis, h):
            # from above, where the average gap as a function of the nominal one is convex
            x, a = h / sigma, ROUGH.residual_film
            for _ in range(30):
                y = x - a
                share = 0.5 * (1.0 + math.erf(y / math.sqrt(2.0)))
                x -= (a + y * share + math.exp(-0.5 * y * y) / math.sqrt(2.0 * math.pi) - h / sigma) / share
            shear = (2.0 * UNEVEN.journal_share - 1.0) * float(shear_flow_factor(x, 1.0))
            return float(pressure_flow_factor(x, 1.0)) * (sigma * x) ** 3, h + sigma * shear

        return rough
    if effect == "warm":
        n = len(WARM)

        def warm(i, j, axis, h):
            other = WARM[(i + 1) % n, j] if axis == 0 else WARM[i, j + 1]
            return h**3 / (0.5 * (WARM[i, j] + other)), h

        return warm
    return lambda i, j, axis, h: (h**3, h)


def twin(grid, rigid, P, fill, beta, contact, vx, vz, inverse, delta_old, mass_old, closure, effect="none"):
    """Balance of every vertex, link by link, elements by bracketing; P the true pressures but where a film clips."""
    n, m = P.shape
    press, seen = contact_twin(contact)
    alpha = BARUS.coefficient * SCALE
    D, H, E, rate = (np.zeros((n, m)) for _ in range(4))
    for i, j in itertools.product(range(n), range(m)):
        p = max(P[i, j], 0.0) if closure.clips and not grid.fixed[i, j] else P[i, j]
        x = rigid[0, i, j] + beta * p
        top = x + beta * press(x) + 1e-12
        g = brentq(lambda g, x=x: g - x - beta * press(g), x, top, xtol=1e-15, rtol=1e-14)
        D[i, j], H[i, j] = g - rigid[0, i, j], seen(g)
        E[i, j] = H[i, j] - seen(rigid[0, i, j])
        slope = (seen(g + 1e-6) - seen(g - 1e-6)) / 2e-6
        rate[i, j] = slope * (rigid[2, i, j] + (D[i, j] - delta_old[i, j]) * inverse)
    # Barus: dp over the viscosity's ratio exp(alpha p), integrated along a link
    Q = (1.0 - np.exp(-alpha * P)) / alpha if effect == "barus" else P
    links = link_twin(effect, vx, grid, Q)
    r = np.zeros((n, m))
    for i, j in itertools.product(range(n), range(m)):
        k = (i + 1) % n
        h, d = seen(rigid[1, i, j] + 0.5 * (D[i, j] + D[k, j])), 0.5 * (E[k, j] - E[i, j])
        conductance, carrier = links(i, j, 0, h)
        q = vx * carrier * fill[i, j] - conductance * (1.0 + (d / h) ** 2) * grid.link_x[i] * (Q[k, j] - Q[i, j])
        r[i, j] += grid.width_z[j] * q
        r[k, j] -= grid.width_z[j] * q
        if j + 1 < m:
            h, d = 0.5 * (H[i, j] + H[i, j + 1]), 0.5 * (E[i, j + 1] - E[i, j])
            conductance, carrier = links(i, j, 1, h)
            q = vz * carrier * fill[i, j] - conductance * (1.0 + (d / h) ** 2) * grid.link_z[j] * (
                Q[i, j + 1] - Q[i, j]
            )
            r[i, j] += grid.width_x[i] * q
            r[i, j + 1] -= grid.width_x[i] * q
        gain = rate[i, j]
        if closure.conserves_mass:
            gain = fill[i, j] * rate[i, j] if mass_old is None else (fill[i, j] * H[i, j] - mass_old[i, j]) * inverse
        r[i, j] += grid.width_x[i] * grid.width_z[j] * gain
    return r


@touching
def test_elements_settle(contact):
    """``G = X + q p(G)`` to rounding for any X, compliance and start, and the slopes by central differences."""
    made = CONTACTS[contact]()
    X = np.linspace(-3.0, 1.5, 240).reshape(-1, 3)
    scratch, p = np.empty_like(X), np.empty_like(X)
    for compliance, start in itertools.product((1e-12, 1e-9, 1e-7), (-5.0, 0.0, 1.0)):
        G = np.full(X.shape, start)
        made.solve_gap(X, compliance * SCALE, SCALE, G, p, scratch)
        settled = p.copy(), SCALE * scratch
        made.pressure(G, p, scratch)
        for a, b in zip(settled, (p, scratch), strict=True):
            np.testing.assert_allclose(a, b, atol=1e-12 * np.abs(b).max())
        np.testing.assert_allclose(G - X, compliance * p, atol=1e-14 * (1.0 + np.abs(X).max()))
        assert np.all(np.diff(G.ravel()) > 0.0) and np.all(G >= X)
    G, up, down = X.copy(), X.copy(), X.copy()
    made.solve_gap(X, 1e-9, 1.0, G, p, scratch)
    made.solve_gap(X + 1e-5, 1e-9, 1.0, up, p, scratch)
    made.solve_gap(X - 1e-5, 1e-9, 1.0, down, p, scratch)
    made.pressure(G, p, scratch)
    np.testing.assert_allclose((up - down) / 2e-5, 1.0 / (1.0 - 1e-9 * scratch), atol=1e-5)


WITH_EFFECT = [
    ("none", "barus"),
    ("wall", "barus"),
    ("none", "carreau"),
    ("wall", "carreau"),
    ("asperities", "rough"),
    ("none", "warm"),
]
EVERY_EFFECT = [*((contact, "none") for contact in CONTACTS), *WITH_EFFECT]


@pytest.mark.parametrize(("contact", "effect"), EVERY_EFFECT)
@every_closure
def test_matrix_is_the_derivative_of_the_balance(closure, contact, effect):
    """Assembled from Newton's pieces against central differences of the solver's own balance, unknown by unknown."""
    rng = np.random.default_rng(4)
    s = solver_of(closure, contact, SMALL, effect)
    e, w = s.elements, s.work
    s.elements.beta, s.vx, s.vz = 0.02, 2.0, -1.0
    s.system.cavity_pressure = 0.1
    s.H[:], s.HF[:], s.H_t[:] = 0.2 + rng.random((3, *SMALL.shape))
    if contact != "none":
        s.H -= 0.25
    e.take_rigid()
    e.deflection_old[:] = 0.1 * rng.random(SMALL.shape)
    e.rates = Rates(mass=2.0 if closure.conserves_mass else 0.0, liner=3.0, pseudo=0.5, gap_rate=1.0)
    P, fill, full = e.P, e.fill, np.ones(SMALL.shape, dtype=np.bool_)
    P[:] = 1.0 + rng.normal(size=SMALL.shape)
    if closure.conserves_mass:
        full[:] = SMALL.fixed | (rng.random(SMALL.shape) < 0.6)
        fill[~full] = rng.random(SMALL.shape)[~full]
    e.balance()
    e.gradients()
    lower, upper = (np.zeros((P.size, 2 * SMALL.z.size + 6)) for _ in range(2))
    slopes = w.slopes
    thin = None if e.thin is None else e.thin.response()
    numbering = number_cells if thin is None else number_with_corners
    count, width = numbering(~SMALL.fixed, e.film.metric[0], w.order, w.number)
    sides = (P, fill, full) if e.kind == OIL else (P, None, None)
    film_slopes(*sides[1:], None, None, e.film.system.terms, slopes)
    if thin is not None:
        add_tangents(thin[0], e.film.system.terms.kx, e.film.system.terms.kz, sides[2], slopes)
    add_gap_slopes(*sides, None, e.film.system.terms, e.gap_slopes, e.load, e.rates, e.beta, e.by, slopes)
    assemble(e.film.metric[0], e.film.metric[1], slopes, w.number, w.order, count, lower, upper)
    if thin is not None:
        add_corners(thin[1], thin[2:], e.film.system.terms.kx, e.film.system.terms.kz, sides[2], w.number, lower, upper)
    A, B = np.zeros((count, count)), np.zeros((count, count))
    for k in range(count):
        for d in range(min(width, count - 1 - k) + 1):
            A[k, k + d] = upper[k, d]
            if d:
                A[k + d, k] = lower[k, d]
    at, h = w.order[:count], 1e-6
    for k in range(count):
        sides = []
        for sign in (1.0, -1.0):
            moved = P if full.ravel()[at[k]] else fill
            before = moved.copy()
            moved.ravel()[at[k]] += sign * h
            e.balance()
            moved[:] = before
            sides.append(e.residual.ravel()[at].copy())
        B[:, k] = (sides[0] - sides[1]) / (2.0 * h)
    # differences of smooth functions; the wall's curvature over its onset of a tenth makes them good to 1e-7
    np.testing.assert_allclose(A, B, atol=1e-6 * np.abs(B).max())


@every_closure
def test_steps_compiled_as_a_whole_find_the_same_film(closure):
    """One kernel, and balances by turns with `proceed`: 1e-11 of the peak, steady and with the liner's rate."""
    if closure.conserves_mass:
        return
    for eps, rate, step in ((0.6, 10.0, 0.0), (0.95, -4.0, 1e-3)):
        old = None if step == 0.0 else np.full(GRID.shape, 0.01)
        compiled, other = solver_of(closure, "none"), solver_of(closure, "none")
        other.elements.plain = False
        for made in (compiled, other):
            solve(made, 0.003, eps, rate, delta_old=old, step=step)
        peak = np.abs(compiled.pressure).max()
        np.testing.assert_allclose(other.pressure, compiled.pressure, atol=1e-11 * peak)
        np.testing.assert_allclose(other.H, compiled.H, atol=1e-11)
        assert other.elements.stored_power() == pytest.approx(compiled.elements.stored_power(), rel=1e-9, abs=1e-12)


CASES = [
    (c, t, e)
    for c in CLOSURES
    for t, e in EVERY_EFFECT
    if (c.conserves_mass or (t, e) != ("none", "none")) and (t, e) not in (("wall", "barus"), ("wall", "carreau"))
]
# a third of them; of those with shear thinning, which take the longest, one
QUICK = [k for k, case in enumerate(CASES) if k % 3 == 0 and (case[2] != "carreau" or case[0] == ehd.SwiftStieber())]


def pressures(solver):
    """Scaled pressures of the last film (n, m), below the cavity pressure where it is cut off."""
    q = solver.system.linear_pressure
    return q if solver.elements.oil is None else -np.log1p(-BARUS.coefficient * SCALE * q) / (BARUS.coefficient * SCALE)


@pytest.mark.parametrize("motion", ["steady", "step"])
@pytest.mark.parametrize(
    ("closure", "contact", "effect"),
    sample(CASES, *QUICK),
    ids=lambda v: v if isinstance(v, str) else type(v).__name__,
)
def test_scipy_finds_the_same_film(closure, contact, effect, motion):
    """The twin's equations on 16 x 4, solved by MINPACK from the rigid film; deep contact where there is one.

    One unknown u per vertex: the pressure above, and (minus) slack or missing oil below the
    cavity pressure. 1e-7 of the peak: MINPACK's tolerance and the bracketing of the elements;
    with asperities the tabulated contact pressure, good to 1e-6, and the tabulated flow factors.
    """
    g, beta = SMALL, 0.01
    eps = 0.7 if contact == "none" else 1.05
    if effect == "rough":
        # no deeper than the flow factors' fit reaches
        eps = 0.93
    step = 0.0 if motion == "steady" else 2e-3
    inverse = 0.0 if step == 0.0 else 1.0 / step
    rate = 5.0 if step > 0.0 and not closure.conserves_mass else 0.0
    rigid = gaps(g, eps, rate=rate)
    start = solve(solver_of(closure, contact, g, effect), beta, eps - 0.02)
    delta = start.elements.deflection
    mass = 0.97 * start.content if closure.conserves_mass and step > 0.0 else None
    s = solve(
        solver_of(closure, contact, g, effect),
        beta,
        eps,
        rate,
        mass_old=mass,
        delta_old=delta if step > 0.0 else None,
        step=step,
    )
    free = ~g.fixed
    complementary = np.isfinite(closure.cavity_pressure) and not closure.clips
    peak = max(np.abs(start.pressure).max(), 1.0)

    def parts(u):
        P, fill, slack = np.zeros(g.shape), np.ones(g.shape), np.zeros(g.shape)
        P[:, 0], P[:, -1] = ENDS
        P[free] = peak * u
        if complementary:
            below = np.minimum(u, 0.0)
            P[free] = peak * np.maximum(u, 0.0)
            if closure.conserves_mass:
                fill[free] = 1.0 + below
            else:
                slack[free] = 50.0 * below
        return P, fill, slack

    def equations(u):
        P, fill, slack = parts(u)
        r = twin(
            g,
            rigid,
            P,
            fill,
            beta,
            contact,
            50.0,
            3.0,
            inverse if mass is not None or not closure.conserves_mass else 0.0,
            delta if step > 0.0 and not closure.conserves_mass else np.zeros(g.shape),
            mass,
            closure,
            effect,
        )
        return (r + slack)[free]

    guess = pressures(start)[free] / peak
    if closure.conserves_mass:
        guess = guess + start.fill[free] - 1.0
    found = root(equations, guess, method="hybr", options={"xtol": 1e-12, "maxfev": 40000})
    P, fill, _ = parts(found.x)
    assert np.abs(equations(found.x)).max() < 1e-8, found.message
    tolerance = 2e-6 if contact == "asperities" else 1e-7
    np.testing.assert_allclose(pressures(s), P, atol=tolerance * np.abs(P).max())
    if closure.conserves_mass:
        np.testing.assert_allclose(s.fill, fill, atol=tolerance)


@every_contact
@every_closure
def test_stiff_liner_approaches_the_rigid_bore_at_first_order(closure, contact):
    made = CONTACTS[contact]()
    plain = FilmSolver(GRID, closure)
    rigid = gaps(GRID, 0.97 if made is not None else 0.6)
    plain.H[:], plain.HF[:], plain.H_t[:] = rigid
    if made is not None:
        made.limit(plain.H, plain.HF, plain.H_t, *np.empty((3, *GRID.shape)))
    plain.pressure[:, 0], plain.pressure[:, -1] = ENDS
    plain.solve(50.0, 3.0, closure.cavity_pressure)
    small = 1e-8 if made is not None else 1e-6
    errors = []
    for beta in (4 * small, 2 * small, small):
        s = solve(solver_of(closure, contact), beta, 0.97 if made is not None else 0.6)
        errors.append(np.abs(s.pressure - plain.pressure).max())
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.03)
    assert errors[-1] < 0.01 * np.abs(plain.pressure).max()


@touching
@every_closure
def test_surfaces_that_overlap_have_a_film(closure, contact):
    """Up to three clearances deep, at the ends too: the liner takes the overlap up, and the film's gap stays open.

    The deeper, the more of the overlap it is: contact stiffer than the liner.
    """
    s = solver_of(closure, contact)
    taken = []
    for eps in (0.9, 1.0, 1.2, 2.0, 4.0):
        solve(s, 0.02, eps, cold=eps == 0.9)
        assert s.H.min() > 0.0 and s.HF.min() > 0.0
        np.testing.assert_allclose(s.elements.true_gap - s.elements.rigid[0], s.elements.deflection, atol=1e-15)
        expected = s.elements.beta * (s.pressure + s.elements.contact_pressure / SCALE)
        np.testing.assert_allclose(s.elements.deflection, expected, atol=1e-12 * (1.0 + np.abs(expected).max()))
        taken.append(s.elements.deflection[:, 0].max())
    assert np.all(np.diff(taken) > 0.0) and taken[-1] > 2.0


@every_contact
@every_closure
def test_the_start_changes_no_result(closure, contact):
    """Cold, and warm from afar: 1e-12 of the peak, the error at which the iteration ends."""
    deep = 0.0 if contact == "none" else 0.35
    s = solver_of(closure, contact)
    cold = solve(s, 0.003, 0.7 + deep).pressure.copy()
    for eps in (0.1, 0.6 + deep):
        solve(s, 0.003, eps)
        again = solve(s, 0.003, 0.7 + deep, cold=False).pressure
        np.testing.assert_allclose(again, cold, atol=2e-12 * np.abs(cold).max())


@every_contact
def test_oil_is_kept_over_a_transient(contact):
    """An orbit through contact on a soft liner: what enters is what the content
    gains, to 1e-10 of the flows at every one of 200 steps, with fills from 0 to 1."""
    s, step = solver_of(ehd.ElrodAdams(), contact), 4e-4
    depth = 0.85 if contact == "none" else 1.0
    rest = solve(s, 0.01, 0.3)
    mass, delta = rest.H.copy(), rest.elements.deflection
    lowest = 1.0
    for k in range(200):
        eps = depth * (0.6 + 0.4 * np.sin(0.2 * k))
        solve(s, 0.01, eps, cold=False, mass_old=mass, delta_old=delta, step=step)
        inflow = s.inflow()
        gain = (s.content - mass) * s.area / step
        assert inflow.sum() == pytest.approx(gain.sum(), abs=1e-10 * (np.abs(inflow).sum() + np.abs(gain).sum()))
        assert s.fill.min() >= 0.0 and s.fill.max() <= 1.0
        lowest = min(lowest, s.fill.min())
        mass, delta = s.content, s.elements.deflection
    assert lowest < 0.8


def test_a_film_at_an_instant_keeps_deflection_and_content():
    """No time to deflect or to flow: content and deflection of the history, another gap's rate another pressure."""
    s = solve(solver_of(ehd.ElrodAdams(), "none"), 0.01, 0.5)
    mass, delta, before = s.content, s.elements.deflection, s.pressure.copy()
    after = solve(s, 0.01, 0.5, cold=False, mass_old=mass, delta_old=delta)
    np.testing.assert_allclose(after.content, mass, atol=1e-3)
    np.testing.assert_allclose(after.pressure, before, atol=1e-3 * before.max())
