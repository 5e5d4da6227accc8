"""A ball in its socket against closed forms, a plain reference of other coordinates, and what physics asks of it."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import spsolve

import exudyn_ehd as ehd
from exudyn_ehd.joint.spherical.model import PLACE, SIZE, SPIN, VELOCITY, SphericalModel
from exudyn_ehd.joint.spherical.steady import result_of
from exudyn_ehd.status import Status

R, C, MU = 0.015, 30e-6, 0.1
CUP, RING = (0.0, 0.5 * math.pi), (0.3, 2.2)
WALL = ehd.RegularisedWall(onset=5e-6, pressure=1e8)
CLOSURES = (ehd.FullSommerfeld(), ehd.Gumbel(), ehd.SwiftStieber(), ehd.SwiftStieber(cavity_pressure=-1e5))
IN_CELLS = tuple(
    kind(line_in_cells=True, cavity_pressure=p) for kind in (ehd.Gumbel, ehd.SwiftStieber) for p in (0.0, -1e5)
)


BARUS, ROELANDS = ehd.BarusPressure(coefficient=2e-8), ehd.RoelandsPressure(coefficient=2e-8)


def model(law=None, **options):
    oil = ehd.Lubricant(viscosity=MU, pressure_law=law)
    return SphericalModel(ehd.SphericalBearing(ball_radius=R, radial_clearance=C, lubricant=oil, **options))


def motion(place=(0, 0, 0), velocity=(0, 0, 0), spin=(0, 0, 0)):
    out = np.zeros(SIZE)
    out[PLACE], out[VELOCITY], out[SPIN] = place, velocity, spin
    return out


def states(rng, count, largest=0.95):
    """Random places within ``largest`` clearances, and rates."""
    for _ in range(count):
        way = rng.normal(size=3)
        place = way / np.linalg.norm(way) * C * largest * rng.uniform()
        yield motion(place, 1e-3 * rng.normal(size=3), 30.0 * rng.normal(size=3))


def squeeze(e, V):
    """F = 6 pi mu R^4 V / (c^3 e) {[ln(1 - e) + 1 / (1 - e) - 1] / e^2 - 1/2} of the hemispherical cup."""
    return 6 * math.pi * MU * R**4 * V / (C**3 * e) * ((math.log(1 - e) + 1 / (1 - e) - 1) / e**2 - 0.5)


def test_squeeze_formula_is_that_of_the_axisymmetric_equation():
    """dp/dchi = -6 mu R^2 V sin(chi) / h^3 from the flow through a circle, integrated twice by quadrature."""
    for e in (0.05, 0.5, 0.95):

        def force_by_slope(x, e=e):
            """By parts: a slope of the pressure acts on the disc inside its circle."""
            slope = 6 * MU * R**2 * math.sin(x) / (C * (1 - e * math.cos(x))) ** 3
            return slope * math.pi * R**2 * math.sin(x) ** 2

        force = quad(force_by_slope, 0, 0.5 * math.pi, epsrel=1e-11)[0]
        assert force == pytest.approx(squeeze(e, 1.0), rel=1e-7)


def test_squeeze_of_the_cup_converges_with_second_order():
    for e, bound in ((0.1, 2e-4), (0.5, 5e-5), (0.8, 2e-3), (0.9, 5e-3)):
        errors = []
        for n in (24, 48, 96):
            wrench = model(n_chi=n, n_phi=16).evaluate(motion((0, 0, e * C), (0, 0, 1e-3))).wrench
            errors.append(wrench[2] / squeeze(e, -1e-3) - 1)
            assert np.abs(wrench[[0, 1, 3, 4, 5]]).max() < 1e-9 * abs(wrench[2])
        # the first grid is the default one in chi
        assert abs(errors[0]) < bound
        # at 0.5 the errors of pole and edge cancel
        assert e == 0.5 or (3.6 < errors[0] / errors[1] < 4.2 and 3.6 < errors[1] / errors[2] < 4.2)


@pytest.mark.slow
@pytest.mark.parametrize("angles", [CUP, (0.0, 2.3), (0.7, math.pi - 0.7)])
@pytest.mark.parametrize(("ratio", "bound"), [(0.8, 0.01), (0.9, 0.025)])
def test_errors_of_the_default_grid(angles, ratio, bound):
    """Errors that `SphericalBearing` states, for random motions against a grid of twice as many rows and columns, which
    has a quarter of the error."""
    rng, film, fine = (
        np.random.default_rng(8),
        model(socket_angles=angles),
        model(socket_angles=angles, n_phi=96, n_chi=48),
    )
    for state in states(rng, 6):
        state[PLACE] *= ratio * C / np.linalg.norm(state[PLACE])
        found, best = film.evaluate(state).film, fine.evaluate(state).film
        for mine, exact, most in (
            (found.loads.wrench[:3], best.loads.wrench[:3], bound),
            (found.loads.torque, best.loads.torque, 0.005),
        ):
            assert np.linalg.norm(mine - exact) < most * np.linalg.norm(exact)


def test_friction_of_the_centred_cup_holds_to_rounding():
    """(4 pi / 3) mu omega R^4 / c about any axis, and mu omega R^3 / c pi across it by the half that is missing."""
    film = model(n_phi=16, n_chi=4)
    for spin in np.eye(3):
        wrench = film.evaluate(motion(spin=spin)).wrench
        assert wrench[3:] == pytest.approx(-4 * math.pi / 3 * MU * R**4 / C * spin, rel=1e-13, abs=1e-18)
        assert wrench[:3] == pytest.approx(-math.pi * MU * R**3 / C * np.cross(spin, (0, 0, 1)), rel=1e-13, abs=1e-15)


def reference(angles, place, velocity, spin, n_phi, n_chi):
    """Force and torque about the ball's centre of a full film, in colatitude and longitude, with the Couette flows over
    all faces and the shear at the ball's surface as they are; no Mercator, no integration by parts."""
    width, step = (angles[1] - angles[0]) / n_chi, 2 * math.pi / n_phi
    chi, phi = angles[0] + width * (np.arange(n_chi) + 0.5), step * np.arange(n_phi)

    def at(x, f):
        n = np.array([math.sin(x) * math.cos(f), math.sin(x) * math.sin(f), math.cos(x)])
        south = np.array([math.cos(x) * math.cos(f), math.cos(x) * math.sin(f), -math.sin(x)])
        east = np.array([-math.sin(f), math.cos(f), 0.0])
        return n, south, east, C - place @ n

    rows, cols, data, b = [], [], [], np.zeros(n_phi * n_chi)
    for i in range(n_phi):
        for j in range(n_chi):
            me = i * n_chi + j
            n, _, _, _ = at(chi[j], phi[i])
            b[me] += velocity @ n * R**2 * math.sin(chi[j]) * width * step
            for x, f, length, gap, other, side in (
                (chi[j] - width / 2, phi[i], math.sin(chi[j] - width / 2) * step, width, j - 1, -1),
                (chi[j] + width / 2, phi[i], math.sin(chi[j] + width / 2) * step, width, j + 1, 1),
                (chi[j], phi[i] - step / 2, width, math.sin(chi[j]) * step, None, -1),
                (chi[j], phi[i] + step / 2, width, math.sin(chi[j]) * step, None, 1),
            ):
                n, south, east, h = at(x, f)
                normal = side * (east if other is None else south)
                b[me] -= h * 0.5 * np.cross(spin, R * n) @ normal * R * length
                edge = other is not None and not 0 <= other < n_chi
                k = h**3 / (12 * MU) * length / (gap * (0.5 if edge else 1.0))
                rows.append(me), cols.append(me), data.append(k)
                if not edge:
                    neighbour = (i + side) % n_phi * n_chi + j if other is None else i * n_chi + other
                    rows.append(me), cols.append(neighbour), data.append(-k)
    p = spsolve(csr_matrix((data, (rows, cols))), b).reshape(n_phi, n_chi)
    along = (np.roll(p, -1, 0) - np.roll(p, 1, 0)) / (2 * step)
    padded = np.concatenate([-p[:, :1], p, -p[:, -1:]], axis=1)
    across = (padded[:, 2:] - padded[:, :-2]) / (2 * width)
    force, torque = np.zeros(3), np.zeros(3)
    for i in range(n_phi):
        for j in range(n_chi):
            n, south, east, h = at(chi[j], phi[i])
            area = R**2 * math.sin(chi[j]) * width * step
            gradient = (across[i, j] * south + along[i, j] / math.sin(chi[j]) * east) / R
            slip = velocity + np.cross(spin, R * n)
            couette = -MU / h * (slip - n * (n @ slip))
            force += (couette - p[i, j] * n) * area
            torque += np.cross(R * n, couette - 0.5 * h * gradient) * area
    return force, torque


def test_film_is_that_of_a_plain_reference_in_other_coordinates():
    place, velocity, spin = np.array([0.3, -0.2, 0.4]) * C, np.array([2e-4, 1e-4, -3e-4]), np.array([5.0, -8.0, 12.0])
    coarse, fine = (reference(RING, place, velocity, spin, n, n // 2) for n in (24, 48))
    film = model(socket_angles=RING, n_phi=96, n_chi=48, cavitation=ehd.FullSommerfeld())
    found = film.evaluate(motion(place, velocity, spin)).film
    for k, mine in enumerate((found.loads.wrench[:3], found.loads.torque)):
        best = fine[k] + (fine[k] - coarse[k]) / 3
        # the grid's own error and that of the reference, of second order both
        assert np.abs(mine - best).max() < 2e-3 * np.abs(best).max()


@pytest.mark.parametrize("closure", CLOSURES)
@pytest.mark.parametrize("angles", [CUP, RING])
def test_turned_and_mirrored_motions_have_turned_and_mirrored_wrenches(closure, angles):
    """Turns about the socket's axis by whole columns, and the reflection of y: exact on the grid."""
    rng, film = np.random.default_rng(2), model(cavitation=closure, socket_angles=angles, contact=WALL)
    turn = 2 * math.pi * 5 / 48
    rotation = np.array([[math.cos(turn), -math.sin(turn), 0], [math.sin(turn), math.cos(turn), 0], [0, 0, 1]])
    mirror = np.diag([1.0, -1.0, 1.0])
    for state in states(rng, 4):
        wrench = film.evaluate(state).wrench
        size = np.repeat([np.linalg.norm(wrench[:3]), np.linalg.norm(wrench[3:])], 3)
        for q, axial in ((rotation, rotation), (mirror, -mirror)):
            moved = motion(q @ state[PLACE], q @ state[VELOCITY], axial @ state[SPIN])
            other = film.evaluate(moved).wrench
            assert np.abs(other - np.concatenate([q @ wrench[:3], axial @ wrench[3:]])) / size == pytest.approx(
                0.0, abs=1e-9
            )


def test_a_common_turn_of_ball_and_socket_is_no_motion():
    """A frame with the socket at rest sees -W x e for a ball whose centre stands still: the film of a fixed place under
    w is that of an orbit under w against a socket that turns with half of it, squeeze alone."""
    film, place, spin = (
        model(socket_angles=RING, cavitation=ehd.FullSommerfeld()),
        np.array([5e-6, 9e-6, 4e-6]),
        np.array([3.0, -2.0, 7.0]),
    )
    turning = film.evaluate(motion(place, spin=spin)).film.pressure
    squeezed = film.evaluate(motion(place, 0.5 * np.cross(place, spin))).film.pressure
    assert np.abs(turning - squeezed).max() < 1e-12 * np.abs(turning).max()


def numerical(film, state):
    out = np.zeros((6, SIZE))
    for k in (0, 1, 2, 4, 5, 6, 8, 9, 10):
        # small against what changes the set of cavitated vertices
        step = (3e-8 * C, 1e-10, 1e-6)[k // 4]
        more, less = state.copy(), state.copy()
        more[k] += step
        less[k] -= step
        out[:, k] = (film.evaluate(more).wrench - film.evaluate(less).wrench) / (2 * step)
    return out


@pytest.mark.parametrize("closure", CLOSURES + IN_CELLS)
@pytest.mark.parametrize("angles", [CUP, RING])
@pytest.mark.parametrize("wall", [None, WALL])
def test_tangent_is_exact(closure, angles, wall):
    rng, film = (
        np.random.default_rng(4),
        model(n_phi=24, n_chi=8, cavitation=closure, socket_angles=angles, contact=wall),
    )
    for state in states(rng, 6, 0.95 if wall is None else 1.03):
        tangent, other = film.evaluate(state).tangent(), numerical(film, state)
        for rows in (slice(0, 3), slice(3, 6)):
            for columns in (PLACE, VELOCITY, SPIN):
                size = np.abs(other[rows, columns]).max()
                # rounding of the forces over the steps of the differences
                assert np.abs(tangent - other)[rows, columns].max() < 2e-5 * size


def test_squeeze_with_barus_law_is_that_of_the_transformed_pressure():
    """q = 3 mu R^2 V / (c^3 e) [1 / (1 - e u)^2 - 1], u = cos(chi), as with a constant viscosity; p = -ln(1 - alpha q)
    / alpha, integrated by quadrature; and no pressure carries a film with alpha q > 1, whose force leads back."""
    e, V, alpha = 0.8, 5e-4, BARUS.coefficient

    def q(u, V=V):
        return 3 * MU * R**2 * V / (C**3 * e) * (1 / (1 - e * u) ** 2 - 1)

    assert 0.7 < alpha * q(1.0) < 1.0
    force = 2 * math.pi * R**2 * quad(lambda u: -math.log(1 - alpha * q(u)) / alpha * u, 0, 1, epsrel=1e-10)[0]
    found = model(BARUS, n_phi=16).evaluate(motion((0, 0, e * C), (0, 0, V)))
    assert -found.wrench[2] == pytest.approx(force, rel=3e-3)
    assert force > 1.2 * -squeeze(e, -V)
    # the pole is half an interval from the first row
    assert found.quantities()["peak_pressure"] == pytest.approx(-math.log(1 - alpha * q(1.0)) / alpha, rel=0.05)
    thrown = model(BARUS, n_phi=16).evaluate(motion((0, 0, e * C), (0, 0, 2 * V)))
    assert thrown.status is Status.NO_PRESSURE and -thrown.wrench[2] > 2.0 * force
    with pytest.raises(ehd.FilmError, match="NO_PRESSURE"):
        result_of(thrown, "test")


@pytest.mark.parametrize("law", [BARUS, ROELANDS])
@pytest.mark.parametrize("closure", CLOSURES + IN_CELLS)
@pytest.mark.parametrize("wall", [None, WALL])
def test_tangent_is_exact_with_a_pressure_law(law, closure, wall):
    rng, film = (
        np.random.default_rng(9),
        model(law, n_phi=24, n_chi=8, cavitation=closure, socket_angles=RING, contact=wall),
    )
    highest = 0.0
    for state in states(rng, 4, 0.8 if wall is None else 1.0):
        state[SPIN] *= 10.0
        found = film.evaluate(state)
        if found.status is Status.NO_PRESSURE:
            continue
        highest = max(highest, found.quantities()["peak_pressure"])
        tangent, other = film.evaluate(state).tangent(), numerical(film, state)
        for rows in (slice(0, 3), slice(3, 6)):
            for columns in (PLACE, VELOCITY, SPIN):
                assert np.abs(tangent - other)[rows, columns].max() < 5e-5 * np.abs(other[rows, columns]).max()
    # 0.1 to 0.4 of 1 / alpha
    assert highest > 5e6


@pytest.mark.parametrize("closure", CLOSURES[:3])
@pytest.mark.parametrize("wall", [None, WALL])
@pytest.mark.parametrize("law", [None, BARUS])
def test_work_is_heat(closure, wall, law):
    """-(F v + T w) is the heat of the links and of the Couette shear, and what the wall takes up."""
    rng = np.random.default_rng(5)
    film = model(law, cavitation=closure, socket_angles=RING, contact=wall)
    solver, patch = film.solver, film.patch
    for state in states(rng, 5, 0.95 if wall is None else 1.02):
        state[VELOCITY] *= 1.0 if law is None else 0.1
        found = film.evaluate(state)
        q, H, P = solver.system.linear_pressure, solver.H.copy(), found.film.oil.P
        thick = 1.0 if found.film.oil.ratio is None else found.film.oil.ratio
        slip = state[VELOCITY][:, None, None] + R * np.cross(state[SPIN], patch.normals, axisb=0, axisc=0)
        slip -= patch.normals * (slip * patch.normals).sum(0)
        couette = float((MU * R**2 / C * (slip**2).sum(0) * patch.area * thick / H).sum())
        kx, kz = solver.system.kx, solver.system.kz
        links = (kx * (P - np.roll(P, -1, 0)) * (q - np.roll(q, -1, 0))).sum()
        links += (kz[:, :-1] * np.diff(P, axis=1) * np.diff(q, axis=1)).sum()
        heat = film.scales.force * C * float(links) + couette
        loss = found.quantities()["power_loss"]
        assert loss > 0.0
        if not closure.clips:
            # the products of the normals are integrated, their squares are taken at the vertices: couette to 1 %
            assert loss == pytest.approx(heat, abs=0.01 * couette + 1e-9 * heat)


@pytest.mark.parametrize("angles", [CUP, RING])
def test_a_line_in_the_cells_makes_derivatives_smoother(angles):
    """Stiffness and damping on the default grid against one of twice as many rows and columns."""
    rng, misses = np.random.default_rng(8), []
    for in_cells in (False, True):
        closure = ehd.SwiftStieber(line_in_cells=in_cells)
        films, own, rng = [], [], np.random.default_rng(8)
        for factor in (1, 2):
            films.append(model(cavitation=closure, socket_angles=angles, n_phi=48 * factor, n_chi=24 * factor))
        for state in states(rng, 5, 0.8):
            state[VELOCITY], state[SPIN] = 0.0, 3.0 * state[SPIN]
            coarse, fine = (film.evaluate(state).tangent()[:3] for film in films)
            own += [np.abs(coarse - fine)[:, at].max() / np.abs(fine[:, at]).max() for at in (PLACE, VELOCITY)]
        misses.append(max(own))
    assert misses[1] < 0.012 and misses[1] < 0.6 * misses[0], misses


def test_films_do_not_depend_on_what_was_asked_before():
    rng = np.random.default_rng(6)
    for closure in CLOSURES:
        used = model(cavitation=closure, socket_angles=RING)
        for state in states(rng, 5):
            fresh = model(cavitation=closure, socket_angles=RING).evaluate(state).wrench
            assert np.abs(used.evaluate(state).wrench - fresh).max() <= 1e-12 * np.abs(fresh).max()


def test_sockets_beyond_the_equator_hold_the_ball_both_ways():
    cup, held = model(), model(socket_angles=(0.0, 2.4))
    in_, out = motion((0, 0, 0.5 * C), (0, 0, 1e-3)), motion((0, 0, -0.5 * C), (0, 0, -1e-3))
    assert held.evaluate(in_).wrench[2] < 0.0 < held.evaluate(out).wrench[2]
    assert cup.evaluate(out).wrench[2] == pytest.approx(0.0, abs=1e-4 * abs(cup.evaluate(in_).wrench[2]))


def test_wall_carries_a_ball_that_presses_through_the_film():
    film = model(contact=ehd.RegularisedWall(onset=5e-6))
    found = film.evaluate(motion((0, 0, 1.01 * C)))
    assert found.status is Status.CONVERGED and found.quantities()["contact_load"] > 1e3
    assert found.wrench[2] == pytest.approx(-found.quantities()["contact_load"])
    assert found.minimum_gap == pytest.approx(-0.01 * C)


def test_states_without_a_film_say_so():
    film = model()
    assert film.evaluate(motion((0, 0, 1.01 * C))).status is Status.NO_FILM
    # the cup is open there
    assert film.evaluate(motion((0, 0, -1.5 * C))).status is Status.CONVERGED
    state = motion()
    state[0] = math.nan
    found = film.evaluate(state)
    assert found.status is Status.NOT_FINITE and np.isnan(found.wrench).all() and np.isnan(found.tangent()).all()
    old = film.evaluate(motion())
    film.evaluate(motion(spin=(0, 0, 1)))
    with pytest.raises(RuntimeError, match="another state since"):
        old.tangent()


def test_smallest_gap_is_that_of_the_patch():
    rng = np.random.default_rng(7)
    for angles in (CUP, RING, (1.0, 1.3)):
        film = model(socket_angles=angles, n_phi=240, n_chi=120)
        for state in states(rng, 10):
            place = state[PLACE]
            gaps = C - np.tensordot(place, film.patch.normals, 1)
            # rows and columns are 1.5 degrees apart; closed caps have none at the pole
            assert 0.0 <= gaps.min() - film.bearing.smallest_gap(place) < 4e-4 * C


def test_the_edge_beside_a_cavity_shears_what_it_holds():
    """0.5 %: the error of second order on the default rows; an edge that is full there makes 1 %."""
    ball, losses = (
        {"ball_radius": 0.02, "radial_clearance": 30e-6, "cavitation": ehd.SwiftStieber(cavity_shear=0.0)},
        [],
    )
    for options in ({}, {"n_chi": 96}):
        b = ehd.SphericalBearing(**ball, lubricant=ehd.Lubricant(viscosity=0.02), **options)
        film = ehd.steady_spherical(b, place=(18e-6, 0.0, 5e-6), angular_velocity=(0.0, 0.0, 300.0))
        losses.append(film.power_loss)
    assert losses[0] == pytest.approx(losses[1], rel=0.005)
