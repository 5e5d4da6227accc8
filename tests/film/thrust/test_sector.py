"""Films of tilting thrust pads: independent films on sectors, the plane slider, difference quotients, balances."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.integrate import quad

import exudyn_ehd as ehd
from exudyn_ehd.film.thrust.face import FACE_SIZE, FaceFilm
from tests.reference.sector_film import sector_film

MU, RO, C = 0.03, 0.1, 50e-6
OIL = ehd.Lubricant(viscosity=MU)
SCALE = np.array([C, C / RO, C / RO, 1e-3, 1e-2, 1e-2, 300.0, 0.01, 0.01])


def _pads(**options):
    size = {"inner_radius": 0.5 * RO, "outer_radius": RO, "pads": 2, "extent": 0.65, "pivot_radius": 0.77 * RO}
    body = {"pivot_angle": 0.39, "clearance": C, "lubricant": OIL, "pad_mass": 1.0, "pad_inertia": (1e-4, 1e-4)}
    return ehd.TiltingThrustPads(**size | body | options)


def _film(pads):
    return FaceFilm(pads, 1, pads.cavitation, ehd.Lubricant(viscosity=MU), (0.0, 0.0))


def _random(rng, **options):
    """Pads of a random shape, and a motion (9,) that tilts their gaps to 1.2 to 4 times the smallest one, 30 um."""
    ratio, extent = rng.uniform(0.4, 0.8), rng.uniform(0.3, 1.0)
    pivot = {
        "pivot_radius": RO * (ratio + (1 - ratio) * rng.uniform(0.3, 0.7)),
        "pivot_angle": extent * rng.uniform(0.3, 0.7),
    }
    pads = _pads(inner_radius=ratio * RO, extent=extent, **pivot | options)
    theta, r = np.meshgrid(pads.grid[2], np.linspace(ratio * RO, RO, 5))
    angle = rng.uniform(0.0, 2.0 * math.pi)
    along = r * np.cos(theta - angle)
    tilt = (rng.uniform(1.2, 4.0) - 1.0) * 30e-6 / np.ptp(along)
    rates = np.array([rng.uniform(-2.0, 0.2) * 1e-3, *rng.uniform(-1e-2, 1e-2, 2)])
    spin = rng.choice([-1.0, 1.0]) * rng.uniform(50.0, 300.0)
    pose = [30e-6 + tilt * along.max() - C, tilt * math.cos(angle), tilt * math.sin(angle)]
    return pads, np.array([*pose, *rates, spin, 0.0, 0.0])


def test_sectors():
    """Load, its place and torque of ten random sectors with tilts, squeeze and both senses of rotation.

    The place is measured in the pad's own size. The independent film is extrapolated from two grids.
    """
    rng, found = np.random.default_rng(5), []
    while len(found) < 10:
        pads, motion = _random(rng, crown=rng.choice([0.0, 10e-6]))
        size = {"inner": pads.inner_radius, "outer": RO, "first": -pads.pivot_angle, "extent": pads.extent}
        size |= {"clearance": C, "viscosity": MU, "crown": pads.crown}
        coarse, fine = (sector_film(motion[:7], **size, shape=shape) for shape in ((61, 31), (121, 61)))
        load, mx, my, torque, *_ = fine + (fine - coarse) / 3.0
        length, width = RO * pads.extent, RO - pads.inner_radius
        if load < 0.02 * MU * abs(motion[6]) * RO * length * width * min(length, width) / (30e-6) ** 2:
            continue  # torn all over: nothing is carried that a share could be of
        wrench = _film(pads).evaluate(motion).wrench
        places = (wrench[3] / wrench[2] - mx / load) / length, (wrench[4] / wrench[2] - my / load) / width
        found.append([wrench[2] / load - 1.0, *places, wrench[5] / torque - 1.0])
    errors = np.abs(found).max(axis=0)
    assert np.all(errors < [1.5e-3, 3e-4, 3e-4, 1.5e-3]), errors
    assert np.median(np.abs(found), axis=0)[0] < 1e-3


def test_plane_slider():
    """Wide sector: W = 6 mu U B^2 / h2^2 [ln a - 2 (a - 1) / (a + 1)] / (a - 1)^2 of every strip, and its centre.

    p = 6 mu U B (h1 - h) (h - h2) / ((h1^2 - h2^2) h^2) between the gaps h1 and h2, a = h1 / h2. Width over length is
    150; the ends carry less over some 0.6 lengths.
    """
    ri, ro, B, omega = 1.0, 1.6, 0.004, 40.0
    extent, tilt = B / 1.3, 40e-6 / B
    pads = _pads(inner_radius=ri, outer_radius=ro, extent=extent, pivot_radius=1.3, pivot_angle=0.5 * extent, n_r=200)

    def strip(r):
        half = 0.5 * r * extent
        h1, h2 = C + tilt * half, C - tilt * half
        a, scale = h1 / h2, 6 * MU * omega * r * 2 * half

        def pressure(y):
            h = C - tilt * y
            return scale * (h1 - h) * (h - h2) / ((h1**2 - h2**2) * h**2)

        load = scale * 2 * half / h2**2 * (math.log(a) - 2 * (a - 1) / (a + 1)) / (a - 1) ** 2
        assert quad(pressure, -half, half, epsrel=1e-10)[0] == pytest.approx(load, rel=1e-8)
        return load, quad(lambda y: y * pressure(y), -half, half)[0]

    load, moment = (quad(lambda r, k=k: strip(r)[k], ri, ro)[0] for k in (0, 1))
    found = _film(pads).evaluate(np.array([0, 0, tilt, 0, 0, 0, omega, 0, 0])).wrench
    assert found[2] == pytest.approx(load, rel=0.01)
    assert found[3] / found[2] == pytest.approx(moment / load, abs=0.01 * B)


@pytest.mark.parametrize("closure", (ehd.SwiftStieber(cavity_pressure=-2e4), ehd.FullSommerfeld(), ehd.Gumbel()))
def test_tangent(closure):
    """Exact on random states, with and without crown and wall."""
    rng = np.random.default_rng(7)
    for options in ({}, {"crown": 10e-6, "contact": ehd.RegularisedWall(onset=40e-6, pressure=1e6)}):
        touched = 0
        for _ in range(4):
            pads, motion = _random(rng, cavitation=closure, **options)
            motion[7:] = rng.normal(size=2) * SCALE[7:]
            film = _film(pads)
            assert film.evaluate(motion).status is ehd.Status.CONVERGED
            touched += film.contact.any()
            tangent, d = film.tangent() * SCALE, rng.normal(size=FACE_SIZE)
            plus, minus = (film.evaluate(motion + k * 1e-6 * d * SCALE).wrench for k in (1, -1))
            assert np.all(np.abs(tangent @ d - (plus - minus) / 2e-6) <= 1e-6 * np.abs(tangent).max(axis=1))
        assert bool(touched) == ("contact" in options)


def test_balances():
    """Oil of a steady film and work of any motion, to rounding; mirrored pads."""
    rng = np.random.default_rng(2)
    for _ in range(3):
        pads, motion = _random(rng, cavitation=ehd.FullSommerfeld())
        film = _film(pads)
        _, bx, by, zeta_t, bx_t, by_t, omega, ux, uy = motion
        found = film.evaluate(motion)
        twist = np.array([ux, uy, zeta_t - bx * ux - by * uy, omega * bx - by_t, omega * by + bx_t, omega])
        assert -found.wrench @ twist == pytest.approx(found.power_loss, rel=1e-10)
        motion[3:6] = 0.0
        first = film.evaluate(motion).wrench
        (inner, outer), (ahead, behind) = film.flows(), film.flows_along()
        assert inner + ahead == pytest.approx(outer + behind, abs=1e-12 * abs(ahead))
        # seen in a mirror through the radial line of the pivot
        mirrored = dataclasses.replace(pads, pivot_angle=pads.extent - pads.pivot_angle)
        other = _film(mirrored).evaluate(motion * np.array([1, 1, -1, 1, 1, 1, -1, 1, 1])).wrench
        assert other * [1, -1, 1, -1, 1, -1] == pytest.approx(first, rel=1e-9, abs=1e-9 * abs(first[2]))


@pytest.mark.parametrize(
    ("wrong", "message"),
    (
        ({"pads": 10}, "10 pads of 0.65 rad overlap"),
        ({"pivot_radius": 0.04}, "the pivot must be under its pad"),
        ({"pivot_angle": 0.7}, "pivot_angle is an angle, not a share"),
        ({"inner_radius": 0.0999}, "inner_radius must be below 0.99"),
        ({"pad_inertia": (1e-4, 0.0)}, "pad_inertia must be two numbers > 0"),
        ({"pad_mass": 0.0}, "pad_mass must be > 0"),
        ({"pivot_stiffness": -1.0}, "pivot_stiffness must be > 0"),
        ({"cavitation": ehd.ElrodAdams()}, "does not go with cavitation=ElrodAdams"),
        ({"cavitation": ehd.Gumbel(cavity_pressure=1e4)}, "does not go with a cavity_pressure above 0 Pa"),
        (
            {
                "lubricant": dataclasses.replace(OIL, pressure_law=ehd.BarusPressure(coefficient=1e-8)),
                "turbulence": ehd.NgPan(),
            },
            r"turbulence=NgPan\(\) does not go with Lubricant.pressure_law",
        ),
        ({"contact": ehd.RegularisedWall(onset=2 * C)}, "onset must be below the clearance"),
        ({"extent": 7.0}, "extent must be between"),
    ),
)
def test_refused(wrong, message):
    with pytest.raises(ehd.InputError, match=rf"TiltingThrustPads.*{message}"):
        _pads(**wrong)
