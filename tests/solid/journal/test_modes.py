"""Modes of elastic journals: what they lack, what they leave to the body, what is refused."""

import numpy as np
import pytest
from scipy.sparse.linalg import splu

import exudyn_ehd as ehd
from exudyn_ehd.solid.journal import modes
from exudyn_ehd.solid.journal.harmonics import Cylinder
from exudyn_ehd.solid.journal.modes import _Reduction, journal_modes
from tests.reference.elastic_rings import cylinder_yielding

STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
RADIUS, LENGTH = 0.011, 0.022
BOSSES = ehd.HeldBands(bands=((-0.03, -0.012), (0.012, 0.03)))
HELD = {"bosses": BOSSES, "ends": ehd.HeldEnds(), "free": None}


def pin(held="bosses", **options):
    given = {"material": STEEL, "span": (-0.03, 0.03), "held": HELD[held]} | options
    return ehd.ElasticJournal(**given)


def bearing(journal, **options):
    given = {
        "journal_radius": RADIUS,
        "length": LENGTH,
        "radial_clearance": 12e-6,
        "lubricant": ehd.Lubricant(viscosity=0.012),
        "journal": journal,
    }
    return ehd.JournalBearing(**(given | options))


@pytest.mark.parametrize(("tolerance", "measured"), [(0.02, {8: 2e-4, 24: 5.5e-3}), (0.08, {8: 6e-3})])
def test_elements_through_a_solid_pin_yield_as_closed_forms_do(tolerance, measured):
    """Errors that `exudyn_ehd.solid.journal.modes` names, in plane strain on one row of elements with many along z."""
    r = _Reduction(pin(tolerance=tolerance), RADIUS, LENGTH).body.r
    body = Cylinder(r, np.linspace(0.0, 0.02 * RADIUS, 2), STEEL.lame)
    for n, error in measured.items():
        free = np.ones(body.size, dtype=bool)
        free[2::3] = False
        load, u = body.load(n, np.ones((1, *body.places.shape)))[:, 0], np.zeros(body.size)
        u[free] = splu(body.stiffness(n)[free][:, free]).solve(load[free])
        found = u[3 * body.surface[1]] * 2.1e11 / RADIUS / cylinder_yielding(n, 0.0, RADIUS, 0.3) - 1.0
        assert -1.15 * error < found < 0.0


@pytest.mark.parametrize("held", HELD)
@pytest.mark.parametrize("inner", [0.0, pytest.param(0.005, marks=pytest.mark.slow)])
def test_compliance_of_the_modes_is_that_of_the_elements(held, inner):
    """Smooth pressures displace the modes as they displace the elements.

    The error of 0.08 is a root mean square over the films; the largest of this steeper one at a place is 1.3 times it.
    """
    journal = pin(held, inner_radius=inner, tolerance=0.08)
    found, reduced = journal_modes(journal, RADIUS, LENGTH), _Reduction(journal, RADIUS, LENGTH)
    assert found.error <= 0.08
    assert np.abs(found.profiles).max(axis=1) == pytest.approx(1.0)
    body, zeta = reduced.body, reduced.zeta
    for n in range(4):
        for shape, tolerance in ((1.0 - zeta**2, 0.02), (np.cos(0.5 * np.pi * zeta) ** 3 * np.exp(zeta), 0.13)):
            pressure = (shape * reduced.loaded)[None]
            load = body.load(n, pressure)
            exact = body.solve(n, load, reduced.held)[reduced.surface, 0]
            cos = (found.waves == n) & (found.phases == 0.0)
            # loads of a mode: its profile under the same pressure
            Q = found.profiles[cos] @ load[reduced.surface, 0]
            q = Q / found.stiffness[cos]
            assert np.abs(q @ found.profiles[cos] - exact).max() < tolerance * np.abs(exact).max()


def test_modes_are_kept_on_disk(monkeypatch):
    journal = pin("ends", tolerance=0.2)
    first = journal_modes(journal, RADIUS, LENGTH)
    monkeypatch.setattr(modes, "_Reduction", None)
    second = journal_modes(journal, RADIUS, LENGTH)
    for name in ("waves", "phases", "profiles", "stiffness", "edges"):
        assert np.array_equal(getattr(first, name), getattr(second, name))


@pytest.mark.slow
@pytest.mark.parametrize(("held", "inner"), [("bosses", 0.0), ("free", 0.005)])
def test_films_of_the_default_tolerance(held, inner):
    """Aligned, within 0.1 % of the peak and 0.5 % of the thinnest film; the table of solid/README.md."""
    films = [
        ehd.steady(bearing(pin(held, inner_radius=inner, tolerance=tolerance)), speed=400.0, eccentricity_ratio=0.9)
        for tolerance in (0.02, 0.005)
    ]
    assert films[0].peak_pressure == pytest.approx(films[1].peak_pressure, rel=1e-3)
    assert films[0].minimum_gap == pytest.approx(films[1].minimum_gap, rel=5e-3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: pin(span=(-0.01, 0.03)), r"span must reach beyond the film, 0\.022 m"),
        (lambda: pin(inner_radius=0.0109), r"inner_radius must be at most 0\.95 of the journal radius"),
        (lambda: pin(held="free", span=(-0.02, 0.03), tilted=False), "tilted must be True.*not symmetric"),
        (lambda: pin(span=(-0.02, 0.03)), "bands must lie on the pin"),
    ],
)
def test_pins_that_are_not_the_films(make, message):
    with pytest.raises(ehd.InputError, match=message):
        bearing(make())


@pytest.mark.parametrize("bands", [((-0.03, -0.012), (0.005, 0.03)), ((0.012, 0.04),)])
def test_bands_beside_the_film_on_the_pin(bands):
    with pytest.raises(ehd.InputError, match="bands must lie on the pin"):
        bearing(ehd.ElasticJournal(material=STEEL, span=(-0.03, 0.03), held=ehd.HeldBands(bands=bands)))


def test_descriptions_that_can_not_be_meant():
    for bands in ((), None, ((0.03, 0.012),), (0.012, 0.03)):
        with pytest.raises(ehd.InputError, match=r"HeldBands\.bands must be"):
            ehd.HeldBands(bands=bands)
    with pytest.raises(ehd.InputError, match=r"held must be HeldEnds\(...\) or HeldBands\(...\) or None"):
        ehd.ElasticJournal(material=STEEL, span=(-0.03, 0.03), held=BOSSES.bands)


def test_films_and_bushes_that_do_not_know_it():
    cylinder = ehd.HollowCylinder(inner_radius=RADIUS, thickness=0.006, length=LENGTH)
    for bush in (
        ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e10),
        ehd.ANCFBush(mesh=cylinder, material=STEEL),
        ehd.ModalBush(mesh=cylinder, material=STEEL, dynamics=True),
    ):
        with pytest.raises(ehd.InputError, match=rf"rigid bore or a ModalBush.*bush={type(bush).__name__}"):
            bearing(pin(), bush=bush)
    with pytest.raises(ehd.InputError, match=r"journal needs film=FiniteLength.*got LongBearing"):
        bearing(pin(), film=ehd.LongBearing(), inlet=ehd.MaximumGap())
    with pytest.raises(ehd.InputError, match="elastic journal"):
        bearing(pin(), cavitation=ehd.ElrodAdams(line_in_cells=True))
    with pytest.raises(ehd.InputError, match="ElasticJournal"):
        bearing("steel")
