"""Films on one thrust face against closed forms, an independent film on a grid of its own, and difference quotients."""

import math

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

import exudyn_ehd as ehd
from exudyn_ehd.film.thrust.face import FACE_SIZE, FaceFilm

MU, RO, C = 0.03, 0.05, 40e-6
# of random motions: zeta, bx, by, their rates, omega, u_x, u_y
SCALE = np.array([C, C / RO, C / RO, 1e-3, 2e-2, 2e-2, 300.0, 0.01, 0.01])


def _faces(ratio=0.5, **options):
    return ehd.ThrustFaces(inner_radius=ratio * RO, outer_radius=RO, clearance=C, **options)


def _film(faces=None, side=1, closure=None, pressures=(0.0, 0.0)):
    return FaceFilm(faces or _faces(), side, closure or ehd.FullSommerfeld(), ehd.Lubricant(viscosity=MU), pressures)


def _motion(**parts):
    names = ("zeta", "bx", "by", "zeta_t", "bx_t", "by_t", "omega", "u_x", "u_y")
    return np.array([parts.get(name, 0.0) for name in names])


@pytest.mark.parametrize("side", (1, -1))
@pytest.mark.parametrize("ratio", (0.3, 0.5, 0.7, 0.9))
def test_washer(ratio, side):
    """Squeeze (3 pi / 2) mu hdot ro^4 / h^3 [1 - s^4 + (1 - s^2)^2 / ln s], drag (pi / 2) mu omega ro^4 (1 - s^4) / h.

    On any grid to rounding, as the scheme and its weights know the pressures r^2, ln r and 1.
    """
    film = _film(_faces(ratio, n_theta=16, n_r=6), side)
    zeta = 0.4 * C * side
    h, speed = C + side * zeta, 1e-3
    s = ratio
    squeeze = 1.5 * math.pi * MU * speed * RO**4 / h**3 * (1 - s**4 + (1 - s**2) ** 2 / math.log(s))
    found = film.evaluate(_motion(zeta=zeta, zeta_t=-speed * side))
    # rounding of thin rings is that of 1 - s^4 + ...: 1e-12
    assert found.wrench == pytest.approx([0, 0, side * squeeze, 0, 0, 0], rel=1e-11, abs=1e-9 * squeeze * RO)
    assert found.power_loss == pytest.approx(squeeze * speed, rel=1e-11)
    drag = 0.5 * math.pi * MU * 300.0 * RO**4 * (1 - s**4) / h
    found = film.evaluate(_motion(zeta=zeta, omega=300.0))
    assert found.wrench == pytest.approx([0, 0, 0, 0, 0, -drag], rel=1e-12, abs=1e-9 * drag / RO)


def test_pressures_at_the_edges():
    """p = p_i ln(r_o / r) / ln: force pi p_i [(r_o^2 - r_i^2) / (2 ln) - r_i^2], flow pi h^3 p_i / (6 mu ln)."""
    ri, p = 0.5 * RO, 2e5
    log = math.log(RO / ri)
    film = _film(pressures=(p, 0.0))
    found = film.evaluate(_motion())
    assert found.wrench[2] == pytest.approx(math.pi * p * ((RO**2 - ri**2) / (2 * log) - ri**2), rel=1e-12)
    flow = math.pi * C**3 * p / (6 * MU * log)
    assert film.flows() == pytest.approx((flow, flow), rel=1e-12)


def _tilting_moment(ratio, rate):
    """Exact moment of a parallel film against a rate of tilt: p = cos(theta) (A r + B / r + K r^3 / 8)."""
    ri, ro, K = ratio * RO, RO, -12 * MU * rate / C**3
    A, B = np.linalg.solve([[ri, 1 / ri], [ro, 1 / ro]], [-K * ri**3 / 8, -K * ro**3 / 8])
    primitive = np.polynomial.Polynomial([0, 0, B / 2, 0, A / 4, 0, K / 48])
    return math.pi * (primitive(ro) - primitive(ri))


@pytest.mark.parametrize(("ratio", "error"), ((0.3, 2.1e-3), (0.5, 9e-4), (0.7, 3e-4), (0.9, 3e-5)))
def test_tilting(ratio, error):
    """Closed form on the default grid, and order two."""
    exact = _tilting_moment(ratio, 0.1)
    errors = []
    for n_theta, n_r in ((48, 6), (96, 12), (192, 24)):
        found = _film(_faces(ratio, n_theta=n_theta, n_r=n_r)).evaluate(_motion(bx_t=0.1)).wrench
        assert np.abs(np.delete(found, 4)).max() < 1e-9 * abs(exact) / RO
        errors.append(abs(found[4] / -exact - 1))
    assert abs(_film(_faces(ratio)).evaluate(_motion(bx_t=0.1)).wrench[4] / -exact - 1) < error
    # 4, but for what the weights of the integrals add on the coarsest grid
    assert errors[0] / errors[1] > 3.4
    assert 3.3 < errors[1] / errors[2] < 4.4


def test_short_taper():
    """A narrow ring of tapers: p = 6 mu (omega / 2) (-dh/dtheta) y (w - y) / h^3, closed where the film breaks.

    N = pads mu w^3 omega r / 4 (1 / c^2 - 1 / (c + depth)^2) to the share width over length of a taper; 1 % of it.
    """
    depth, pads, omega = 60e-6, 2, 200.0
    profile = ehd.TaperLand(pads=pads, depth=depth, share=0.75)
    faces = _faces(0.97, profile=profile, n_theta=192)
    found = _film(faces, closure=ehd.SwiftStieber(line_in_cells=False)).evaluate(_motion(omega=omega))
    width, r = 0.03 * RO, 0.985 * RO
    force = pads * MU * width**3 * omega * r / 4 * (1 / C**2 - 1 / (C + depth) ** 2)
    # links end where the taper ends; the last vertex' gap is the mean of both sides
    assert found.wrench[2] == pytest.approx(force, rel=0.02)
    turned = _film(_faces(0.97, profile=ehd.TaperLand(pads=pads, depth=depth, share=0.75, reverse=True), n_theta=192))
    mirrored = _film(faces).evaluate(_motion(omega=omega)).wrench
    assert turned.evaluate(_motion(omega=-omega)).wrench[[2, 5]] == pytest.approx([mirrored[2], -mirrored[5]], rel=1e-9)


def reference_film(gap, rate, omega, n, m, *, ri, clips=False, parts=1, oil=None, turbulent=None):
    """Independent film of r and theta: cells between circles of equal distance, of one of ``parts`` that repeat.

    Links in theta join the half cells on their sides, whose gaps may differ at a step: the flow ``V h - a dp`` of both
    is the same. Returns the integrals of p, of p times y and of -p times x, and the torque of a collar without tilt,
    ``-int r (mu omega r / h + h / 2 dp/(r dtheta)) dA``.

    ``oil``: ratios of viscosity and density at pressures; ``turbulent``: factors k_x / 12, k_z / 12 and t at gaps and
    radii. Both act on links and cells as they are, until pressures no longer change.
    """
    oil = oil or (lambda p: (np.ones_like(p), np.ones_like(p)))
    turbulent = turbulent or (lambda h, r: np.ones((3, *np.broadcast(h, r).shape)))
    dr, dt = (RO - ri) / m, 2 * math.pi / (parts * n)
    r, theta = ri + dr * (np.arange(m) + 0.5), dt * (np.arange(n) + 0.5)
    cell, p, full = np.arange(n * m).reshape(n, m), np.zeros(n * m), np.ones(n * m, dtype=bool)
    before, behind = (gap(theta[:, None] + dt / 2 + side, r[None, :]) for side in (-1e-9, 1e-9))
    while True:
        last = full, p
        mu, rho = oil(p)
        field = p.reshape(n, m)
        link_mu, link_rho = oil(0.5 * (field + np.roll(field, -1, 0)))
        a, b = (
            2 * h**3 * dr / (r * dt) / (12 * MU * turbulent(h, r)[0]) * link_rho / link_mu for h in (before, behind)
        )
        flow = omega / 2 * r * dr * (b * before + a * behind) / (a + b) * link_rho
        squeeze = rate(theta[:, None], r[None, :]) * r * dr * dt * rho.reshape(n, m)
        rhs = (np.roll(flow, 1, 0) - flow - squeeze).ravel()
        links = [(cell.ravel(), np.roll(cell, -1, 0).ravel(), (a * b / (a + b)).ravel())]
        for j in range(m - 1):
            h, (link_mu, link_rho) = gap(theta, r[j] + dr / 2), oil(0.5 * (field[:, j] + field[:, j + 1]))
            g = h**3 * (r[j] + dr / 2) * dt / dr / (12 * MU * turbulent(h, r[j] + dr / 2)[1])
            links.append((cell[:, j], cell[:, j + 1], g * link_rho / link_mu))
        entries = [e for i, k, g in links for e in ((i, i, g), (k, k, g), (i, k, -g), (k, i, -g))]
        for j, edge in ((0, ri), (m - 1, RO)):
            h, (link_mu, link_rho) = gap(theta, edge), oil(0.5 * field[:, j])
            g = h**3 * edge * dt / (dr / 2) / (12 * MU * turbulent(h, edge)[1]) * link_rho / link_mu
            entries.append((cell[:, j], cell[:, j], g))
        rows, columns, values = (np.concatenate(part) for part in zip(*entries, strict=True))
        A, inside = coo_matrix((values, (rows, columns))).tocsr(), np.flatnonzero(full)
        p = np.zeros(n * m)
        p[inside] = spsolve(A[inside][:, inside].tocsc(), rhs[inside])
        full = np.where(full, p >= 0.0, A @ p < rhs) if clips else full
        if np.array_equal(last[0], full) and np.abs(p - last[1]).max() <= 1e-9 * np.abs(p).max():
            break
    p, mu = p.reshape(n, m), mu.reshape(n, m)
    area, X, Y = r * dr * dt, r * np.cos(theta)[:, None], r * np.sin(theta)[:, None]
    after, at = np.roll(p, -1, 0), gap(theta[:, None], r[None, :])
    on_edge = (omega / 2 * r * dr * (before - behind) + a * p + b * after) / (a + b)
    pull = 0.5 * ((before * (on_edge - p) + behind * (after - on_edge)) * dr * r).sum()
    torque = -(MU * mu * turbulent(at, r)[2] * omega * r**2 / at * area).sum() - pull
    return parts * np.array([(p * area).sum(), (p * area * Y).sum(), -(p * area * X).sum(), torque])


def extrapolated(*arguments, n, m, **options):
    coarse, fine = (reference_film(*arguments, k * n, k * m, **options) for k in (1, 2))
    return fine + (fine - coarse) / 3


@pytest.mark.parametrize("closure", ("full", pytest.param("swift", marks=pytest.mark.slow), "swift_in_cells"))
@pytest.mark.parametrize(("share", "error"), ((0.4, 1.4e-3), (0.8, 6e-3)))
def test_tilted_face(closure, share, error):
    """Wedge of a tilted collar that turns, sinks and tilts on: the default grid against an independent film."""
    b = share * C / RO * np.array([math.cos(0.3), math.sin(0.3)])
    b_t, omega, sink = np.array([0.03, -0.05]), 250.0, 5e-4
    motion = _motion(bx=b[0], by=b[1], bx_t=b_t[0], by_t=b_t[1], omega=omega, zeta_t=-sink)
    closures = {
        "full": ehd.FullSommerfeld(),
        "swift": ehd.SwiftStieber(line_in_cells=False),
        "swift_in_cells": ehd.SwiftStieber(line_in_cells=True),
    }
    found = _film(closure=closures[closure]).evaluate(motion).wrench

    def gap(theta, r):
        return C - r * (b[0] * np.cos(theta) + b[1] * np.sin(theta))

    def rate(theta, r):
        return -sink - r * (b_t[0] * np.cos(theta) + b_t[1] * np.sin(theta))

    expected = extrapolated(gap, rate, omega, n=64, m=16, ri=0.5 * RO, clips=closure != "full")
    # the torque of a tilted collar has the pressure on its slope besides
    expected[3] -= b[0] * expected[1] + b[1] * expected[2]
    assert found[2:] == pytest.approx(expected, rel=error)


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "error"), ((ehd.TaperLand, 8e-3), (ehd.StepLand, 3e-3)))
def test_pads(shape, error):
    """Pads on the default grid against an independent film, with cavities behind the steps; order two."""
    profile, omega = shape(pads=6, depth=40e-6, share=0.75), 250.0

    def independent(k):
        def gap(theta, r):
            return C + profile.depth_at(theta) + 0 * r

        return reference_film(
            gap, lambda theta, r: 0 * theta + 0 * r, omega, 32 * k, 24 * k, ri=RO / 2, clips=True, parts=6
        )

    # of order one, as its pressure starts from the middle of the first cell behind an edge
    expected = (2 * independent(2) - independent(1))[[0, 3]]
    errors = []
    for n_theta, n_r in ((96, 10), (192, 20)):
        faces = _faces(profile=profile, n_theta=n_theta, n_r=n_r)
        found = _film(faces, closure=ehd.SwiftStieber(line_in_cells=False)).evaluate(_motion(omega=omega)).wrench
        assert found[[0, 1, 3, 4]] == pytest.approx(np.zeros(4), abs=1e-9 * found[2])
        errors.append(np.abs(found[[2, 5]] / expected - 1.0))
    assert errors[0][0] < error
    assert errors[0][1] < 4e-3
    assert errors[0][0] > 3 * errors[1][0]


@pytest.mark.parametrize("shape", (ehd.TaperLand, ehd.StepLand))
def test_edges_between_equal_columns(shape):
    """Force, damping and torque of pads that fit into no equal columns against an independent film on their edges."""
    profile, omega, speed = shape(pads=7, depth=25e-6, share=0.7), 250.0, 1e-4

    def gap(theta, r):
        return C + profile.depth_at(theta) + 0 * r

    def independent(k, rate):
        return reference_film(
            gap, lambda theta, r: rate + 0 * theta + 0 * r, omega, 20 * k, 16 * k, ri=RO / 2, clips=True, parts=7
        )

    # of order one, as in `test_pads`
    still, up, down = (2 * independent(2, rate) - independent(1, rate) for rate in (0.0, speed, -speed))
    film = _film(_faces(profile=profile), closure=ehd.SwiftStieber())
    found = film.evaluate(_motion(omega=omega)).wrench
    assert found[[2, 5]] == pytest.approx(still[[0, 3]], rel=5e-3)
    # the grid is 0.8 % off, and the extrapolation 0.2 %
    assert film.tangent()[2, 3] == pytest.approx((up[0] - down[0]) / (2 * speed), rel=0.01)


CLOSURES = {
    "full": ehd.FullSommerfeld(),
    "gumbel": ehd.Gumbel(cavity_pressure=-2e4),
    "gumbel_in_cells": ehd.Gumbel(line_in_cells=True),
    "swift": ehd.SwiftStieber(cavity_pressure=-2e4, cavity_shear=0.4, line_in_cells=False),
    "swift_in_cells": ehd.SwiftStieber(line_in_cells=True),
}
PROFILES = {"plane": None, "taper": ehd.TaperLand(pads=4, depth=30e-6), "step": ehd.StepLand(pads=4, depth=30e-6)}


@pytest.mark.parametrize("profile", PROFILES)
@pytest.mark.parametrize("closure", CLOSURES)
def test_tangent(closure, profile):
    """Exact on random states, with and without a wall, both faces."""
    rng = np.random.default_rng(7)
    for wall, side in ((None, 1), (ehd.RegularisedWall(onset=15e-6, pressure=1e7), -1)):
        faces = _faces(profile=PROFILES[profile], contact=wall, n_theta=40, n_r=6)
        film = _film(faces, side, CLOSURES[closure], (2e5, 0.0))
        touched = 0
        for _ in range(4):
            motion = rng.uniform(-1, 1, FACE_SIZE) * SCALE * np.array([0.5, 0.3, 0.3, *[1.0] * 6])
            if wall is not None:
                motion[0] = -side * rng.uniform(0.6, 1.1) * C
            assert film.evaluate(motion).status is ehd.Status.CONVERGED
            touched += film.contact.any()
            tangent = film.tangent() * SCALE
            for _ in range(2):
                d = rng.normal(size=FACE_SIZE)
                plus, minus = (film.evaluate(motion + k * 1e-6 * d * SCALE).wrench for k in (1, -1))
                error = np.abs(tangent @ d - (plus - minus) / 2e-6)
                # truncation of central differences and rounding over 1e-6, of smooth states
                assert np.all(error < 1e-6 * np.abs(tangent).max(axis=1))
        assert wall is None or touched


@pytest.mark.parametrize("closure", CLOSURES)
def test_work_becomes_heat(closure):
    """The power of the collar's motion is ``power_loss`` to rounding, and the heat of shear and flow to 1 %."""
    rng = np.random.default_rng(11)
    for side in (1, -1):
        film = _film(_faces(n_theta=128, n_r=16), side, CLOSURES[closure])
        motion = rng.uniform(-1, 1, FACE_SIZE) * SCALE * np.array([0.5, 0.3, 0.3, *[1.0] * 6])
        found = film.evaluate(motion)
        _, bx, by, zeta_t, bx_t, by_t, omega, ux, uy = motion
        twist = np.array([ux, uy, zeta_t - bx * ux - by * uy, omega * bx - by_t, omega * by + bx_t, omega])
        assert -found.wrench @ twist == pytest.approx(found.power_loss, rel=1e-10)
        if closure != "full":
            continue
        a, p, h = film.annulus, film.pressure, film.gap
        r, (_, x, y) = a.scale * a.r, a.scale * a.moments
        shear = MU * ((ux - omega * y) ** 2 + (uy + omega * x) ** 2) / h
        around = np.gradient(np.vstack((p[-1:], p, p[:1])), 2 * math.pi / 128, axis=0)[1:-1]
        outward = np.gradient(p, a.grid.z, axis=1)
        flow = h**3 / (12 * MU) * (around**2 + outward**2) / r**2
        assert ((shear + flow) * a.weight).sum() * a.scale**2 == pytest.approx(found.power_loss, rel=0.01)


def test_turned_frame():
    """Turning tilt, rates and shift turns forces and moments: by columns to rounding, else to the grid's error."""
    motion = np.array([0.3, 0.3, -0.2, -0.5, 0.4, 0.6, 1.0, 1.0, -0.5]) * SCALE
    film = _film(closure=ehd.SwiftStieber(line_in_cells=True))
    first = film.evaluate(motion).wrench
    size = np.array([1e-3, 1e-3, 1.0, RO, RO, 1e-3 * RO]) * np.abs(first[2])
    for angle, error in ((5 * 2 * math.pi / 96, 1e-9), (1.234, 2e-3)):
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        turned = motion.copy()
        for at in (1, 4, 7):
            turned[at : at + 2] = turn @ motion[at : at + 2]
        expected = first.copy()
        expected[:2], expected[3:5] = turn @ first[:2], turn @ first[3:5]
        assert np.all(np.abs(film.evaluate(turned).wrench - expected) < error * size)


def test_shift_of_the_collar():
    """A tilted collar that is shifted along its slope is one that rises and sinks: u . grad h / 2 as a rate."""
    b = np.array([0.3, -0.2]) * C / RO
    u = np.array([0.02, 0.03])
    still, film = _motion(bx=b[0], by=b[1]), _film()
    shifted = film.evaluate(still + _motion(u_x=u[0], u_y=u[1])).wrench
    sunk = film.evaluate(still + _motion(zeta_t=-0.5 * float(u @ b))).wrench
    assert shifted[2:5] == pytest.approx(sunk[2:5], rel=1e-9)
    # in the plane the shear pulls against the shift
    assert shifted[:2] @ u < 0.0


def test_faces_mirror_each_other():
    """Both faces are the same film seen from either side: forces of opposite sign, torques of the same."""
    motion = np.array([0.3, 0.2, -0.3, 0.5, 0.4, 0.6, 1.0, 0.0, 0.0]) * SCALE
    upper, lower = (
        _film(side=1).evaluate(motion).wrench,
        _film(side=-1).evaluate(-motion * np.sign([*[1] * 6, -1, 1, 1])).wrench,
    )
    assert lower[2:5] == pytest.approx(-upper[2:5], rel=1e-10)
    assert lower[5] == pytest.approx(upper[5], rel=1e-10)


def test_no_film():
    film = _film()
    assert film.evaluate(_motion(zeta=-1.01 * C)).status is ehd.Status.NO_FILM
    walled = _film(_faces(contact=ehd.RegularisedWall(onset=5e-6, pressure=1e8)))
    found = walled.evaluate(_motion(zeta=-1.01 * C, omega=100.0))
    assert found.status is ehd.Status.CONVERGED
    area = math.pi * RO**2 * 0.75
    assert found.contact_load == pytest.approx(1e8 * (1 + 0.01 * C / 5e-6) ** 2 * area, rel=1e-9)
    assert found.wrench[2] == pytest.approx(found.contact_load, rel=1e-9)


@pytest.mark.parametrize(
    "wrong",
    (
        {"outer_radius": 0.02},
        {"clearance": 0.0},
        {"profile": "taper"},
        {"contact": ehd.RegularisedWall(onset=50e-6)},
        {"n_theta": 10},
        {"n_r": 3},
        {"lower": False, "upper": False},
        {"profile": ehd.TaperLand(pads=20, depth=1e-5)},
        {"outer_pressures": (0.0,)},
    ),
)
def test_refused(wrong):
    good = {"inner_radius": 0.025, "outer_radius": RO, "clearance": C}
    with pytest.raises(ehd.InputError, match="ThrustFaces"):
        ehd.ThrustFaces(**good | wrong)


def test_edges_beside_a_cavity_shear_what_it_holds():
    """0.4 %: the error of second order on ten rows; edges that are full there make 3 %."""
    losses = []
    for rows in (10, 40):
        film = _film(_faces(0.65, n_r=rows), closure=ehd.SwiftStieber(cavity_shear=0.0))
        losses.append(film.evaluate(_motion(bx=0.6 * C / RO, omega=300.0)).power_loss)
    assert losses[0] == pytest.approx(losses[1], rel=0.004)
