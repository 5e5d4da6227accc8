"""`equilibrium` of lobed bearings and tilting pads under loads over four decades: found, or refused with the reason.

Cases drawn by seed, with loads in all directions and both senses of rotation. Of the first 400 lobed bearings 39 have
no equilibrium: 300 damped searches from all over the bore found none in any of them either. Of the first 200 bearings
with tilting pads four are refused; soft pivots leave their pads hardly any load.
"""

import math

import numpy as np
import pytest

import exudyn_ehd as ehd

# in these the journal lies deep inside a lobe, far from where a round bearing has it
FAR = (5, 64, 379)
ON_EDGES = (11, 28, 84, 93, 140)
OIL = ehd.Lubricant(viscosity=0.02)


def lobed(seed):
    """A lobed bearing, its speed and its load (2,)."""
    rng = np.random.default_rng(seed)
    kind, preload, offset = rng.integers(4), rng.uniform(0.0, 0.8), rng.uniform(0.5, 0.65)
    R = 0.05
    L = 2.0 * R * rng.choice([0.3, 0.5, 1.0])
    c = R * rng.choice([0.7e-3, 1e-3, 2e-3])
    if kind == 0:
        arcs = ehd.two_lobe(preload=preload, offset=offset)
    elif kind == 1:
        arcs = ehd.three_lobe(preload=preload, offset=offset)
    elif kind == 2:
        arcs = ehd.offset_halves(preload=preload)
    else:
        depth, step = c * rng.uniform(0.5, 4.0), math.radians(rng.uniform(90.0, 150.0))
        track = 0.3 * L if rng.random() < 0.5 else None
        arcs = ehd.pressure_dam(depth=depth, step_angle=step, length=0.6 * L, track_length=track)
    speed, share = rng.choice([-1, 1]) * 10 ** rng.uniform(1.5, 3.0), 10 ** rng.uniform(-2.5, 1.5)
    closure = ehd.ElrodAdams() if seed % 4 == 3 else ehd.SwiftStieber()
    bearing = ehd.JournalBearing(
        journal_radius=R, length=L, radial_clearance=c, lubricant=OIL, arcs=arcs, cavitation=closure
    )
    size, angle = share * bearing.reference_force(speed), rng.uniform(0.0, 2.0 * math.pi)
    return bearing, speed, size * np.array([math.cos(angle), math.sin(angle)])


@pytest.mark.filterwarnings("ignore::exudyn_ehd.GridWarning", "ignore:equilibrium. the load is carried at:UserWarning")
@pytest.mark.parametrize("seed", [*FAR, *range(20, 28), *range(30, 40)])
def test_lobes_carry(seed):
    bearing, speed, load = lobed(seed)
    rest = ehd.equilibrium(bearing, speed=speed, load=tuple(load))
    direction = math.atan2(rest.position[1], rest.position[0])
    film = ehd.steady(bearing, speed=speed, eccentricity_ratio=rest.eccentricity_ratio, direction=direction)
    assert np.abs(film.force[:2] + load).max() < 1e-8 * np.hypot(*load)
    assert film.minimum_gap > 1e-3 * bearing.radial_clearance


@pytest.mark.parametrize("seed", ON_EDGES)
def test_a_load_that_presses_the_journal_onto_an_edge_is_refused_with_the_edge(seed):
    bearing, speed, load = lobed(seed)
    message = r"onto the (leading|trailing) edge of arcs\[\d\] at theta = -?\d"
    with pytest.raises(ehd.FilmError, match=message) as caught:
        ehd.equilibrium(bearing, speed=speed, load=tuple(load))
    angle = float(str(caught.value).split("theta = ")[1].split(" rad")[0])
    ends = [end for arc in bearing.arcs for end in (arc.start, arc.start + arc.extent)]
    assert min(abs(math.remainder(angle - end, 2.0 * math.pi)) for end in ends) < 1e-3


def tilting(seed):
    """A bearing with tilting pads, its speed and its load (2,)."""
    rng = np.random.default_rng(1000 + seed)
    n, preload, offset = int(rng.choice([3, 4, 5, 6])), rng.uniform(0.0, 0.8), rng.uniform(0.5, 0.65)
    R = 0.05
    L = 2.0 * R * rng.choice([0.3, 0.5, 1.0])
    c = R * rng.choice([0.7e-3, 1e-3, 2e-3])
    speed = rng.choice([-1, 1]) * 10 ** rng.uniform(1.5, 3.0)
    share, flexible = 10 ** rng.uniform(-2.5, 1.5), rng.random() >= 0.6
    # a share of the clearance, or three, by which the load moves a pivot
    yields = c * 10 ** rng.uniform(-1.5, 0.5)
    pads = ehd.TiltingPads(
        journal_radius=R,
        length=L,
        radial_clearance=c,
        lubricant=OIL,
        pads=n,
        extent=1.6 * math.pi / n,
        preload=preload,
        pivot_offset=offset if speed > 0.0 else 1.0 - offset,
        pad_thickness=0.015,
        load_between_pads=bool(rng.integers(2)),
    )
    size = share * pads.pad(0).reference_force(speed) / (1.0 - preload) ** 2
    if flexible:
        pads = ehd.TiltingPads(**{**vars(pads), "pivot_stiffness": size / yields})
    return pads, speed, np.array([0.0, -size])


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("seed", [*range(2, 14), 21, 33, 39, 59, 69, 90, 91, 98])
def test_tilting_pads_carry(seed):
    pads, speed, load = tilting(seed)
    rest = ehd.equilibrium(pads, speed=speed, load=tuple(load))
    on_journal = 0j
    for film, tilt in zip(rest.films, rest.tilts, strict=True):
        # in frames that turn with the pads, with the resultant of a shear that is even over the pad
        arc = film.bearing.arc
        shear = (np.exp(1j * (arc.start + arc.extent)) - np.exp(1j * arc.start)) / arc.extent
        on_journal += (complex(*film.force[:2]) + shear * film.moment[2] / pads.journal_radius) * np.exp(1j * tilt)
    assert abs(on_journal + complex(*load)) < 1e-8 * np.hypot(*load)
    if pads.pivot_stiffness is not None:
        springs, left = pads.pivot_stiffness * rest.pivot_displacements, 1e-9 * np.hypot(*load)
        np.testing.assert_allclose(rest.pad_forces, springs, rtol=0.0, atol=left)


def test_pivots_too_soft_for_their_pads_are_named():
    pads, speed, load = tilting(24)
    with pytest.raises(ehd.FilmError, match=r"a pivot yields by 133 µm, more than the clearance.*pivot_stiffness"):
        ehd.equilibrium(pads, speed=speed, load=tuple(load))
