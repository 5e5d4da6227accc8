"""The audit: every finding flips where its effect begins to matter, whatever film model and closure a bearing has."""

import dataclasses
import itertools
import math
import pickle
import re

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.audit.audit import audit_record
from exudyn_ehd.joint.audit.case import Case, Change
from exudyn_ehd.joint.audit.findings import LIMITS
from exudyn_ehd.joint.audit.resolution import intervals_at_half
from exudyn_ehd.joint.audit.samples import RecordedSteps, sources, squeeze_rate, squeeze_share, tilt_loss, worst_steps
from exudyn_ehd.joint.audit.switches import steel_ring
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.solved_film import History
from tests.sampling import but_slow, sample

C, SPEED = 20e-6, 300.0
LAWS = {
    "piezoviscosity": {"pressure_law": ehd.RoelandsPressure(coefficient=2e-8)},
    "shear thinning": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.7)},
}
ASPERITY = ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=2e10)
SUPPLIED = (1e5, 1e5)


def bearing(**options):
    oil = {"viscosity": 0.02, **{k: options.pop(k) for k in ("pressure_law", "shear_law") if k in options}}
    plain = {"journal_radius": 0.02, "length": 0.02, "radial_clearance": C, "lubricant": ehd.Lubricant(**oil)}
    return ehd.JournalBearing(**(plain | options))


def audit(made, eps=0.5, speed=SPEED, **where):
    look = {k: where.pop(k) for k in ("liner", "measure_time") if k in where}
    return ehd.steady(made, speed=speed, eccentricity_ratio=eps, **where).audit(**look)


def check_readable(found):
    """No nan anywhere, one line per finding, advice for whatever is neglected or unneeded."""
    text = str(found)
    assert "nan" not in text
    assert all(math.isfinite(f.value) and f.value >= 0.0 for f in found.findings)
    table = text.split("\n\n")[0].splitlines()
    assert len(table) == 2 + len(found.findings)
    for f in found.findings:
        assert f.effect in text and f.indicator in text
        assert not (f.unneeded and f.matters)
    for f in (*found.neglected, *found.unneeded):
        assert f.advice and f"{f.effect}: {f.advice}" in text
    # a line of the table fits a wide terminal
    assert max(map(len, table)) < 140


# effect: (a position where it does not matter, one where it does), with whatever else the bearing needs
FLIPS = {
    "misalignment": ({}, {"tilt": (3e-4, 0.0)}),
    "piezoviscosity": ({"eps": 0.1}, {"eps": 0.9}),
    "shear thinning": ({"eps": 0.1}, {"eps": 0.9, "speed": 1000.0}),
    "roughness": ({"eps": 0.8}, {"eps": 0.95}),
    "contact": ({"eps": 0.8}, {"eps": 0.95}),
    "squeeze": ({}, {"velocity": (1e-3, 0.0)}),
    "heating": ({"speed": 0.1}, {"speed": 300.0}),
    "grid around": ({"eps": 0.8}, {"eps": 0.99}),
    "grid along": ({}, {"tilt": (9.8e-4, 0.0)}),
}


@pytest.mark.parametrize("effect", but_slow(FLIPS, "contact", "grid around", "grid along", "misalignment"))
def test_findings_flip_with_the_position(effect):
    calm, hard = (audit(bearing(), **where) for where in FLIPS[effect])
    assert not calm[effect].matters and hard[effect].matters
    for found in (calm, hard):
        check_readable(found)
    assert hard[effect] in hard.matters
    if not hard[effect].on:
        assert hard[effect] in hard.neglected


@pytest.mark.parametrize(
    ("effect", "small", "large"),
    sample(
        [
            ("Taylor vortices", {"viscosity": 0.02}, {"viscosity": 1e-4}),
            ("turbulence", {"viscosity": 0.02}, {"viscosity": 4e-5}),
            ("fluid inertia", {"viscosity": 0.02}, {"viscosity": 4e-5}),
        ],
        1,
    ),
)
def test_thin_liquids_leave_the_laminar_film(effect, small, large):
    # 12 m/s in a film of 20 um: Re = 9 for an oil, 1700 and 4300 for gas-like liquids
    for oil, matters in ((small, False), (large, True)):
        found = audit(bearing(lubricant=ehd.Lubricant(**oil)), speed=900.0)
        assert found[effect].matters is matters
        check_readable(found)
    assert found[effect].on is (False if effect == "turbulence" else None) and found[effect].advice


def test_taylor_and_reynolds_numbers():
    found = audit(bearing(lubricant=ehd.Lubricant(viscosity=0.01, density=1000.0)))
    reynolds = 1000.0 * SPEED * 0.02 * C / 0.01
    # the model's own scales give the viscosity back to rounding
    assert found["turbulence"].value == pytest.approx(reynolds, rel=1e-12)
    assert found["Taylor vortices"].value == pytest.approx(reynolds * math.sqrt(1e-3), rel=1e-12)
    assert found["fluid inertia"].value == pytest.approx(reynolds * 1e-3, rel=1e-12)


def test_full_sommerfeld_is_told_of_its_tension():
    closure = ehd.FullSommerfeld()
    assert audit(bearing(cavitation=closure), eps=0.8)["cavitation"].matters
    flooded = audit(bearing(cavitation=closure, end_pressures=(5e7, 5e7)), eps=0.1)
    assert not flooded["cavitation"].matters
    broken = audit(bearing(), eps=0.8)["cavitation"]
    assert broken.on and broken.matters and 0.2 < broken.value < 0.6


@pytest.mark.slow
def test_supply_asks_for_mass_conservation():
    groove = ehd.AxialGroove(angle=math.pi, width_angle=0.3, pressure=1e5)
    assert (
        audit(bearing(supply=(groove,)), eps=0.8)["mass conservation"]
        in audit(bearing(supply=(groove,)), eps=0.8).neglected
    )
    elrod = ehd.ElrodAdams()
    assert not audit(bearing(supply=(groove,), cavitation=elrod), eps=0.8).unneeded
    flooded = audit(bearing(end_pressures=(1e7, 1e7), cavitation=elrod), eps=0.5)
    assert flooded["mass conservation"].unneeded


def test_effects_with_which_no_film_carries_the_load_are_named():
    # between rigid surfaces no film of Roelands' oil carries a mean pressure beyond 1 / coefficient, 50 MPa
    film = ehd.steady(bearing(), speed=2000.0, eccentricity_ratio=0.97)
    assert np.hypot(*film.force[:2]) / 8e-4 > 1e8
    found = film.audit()
    check_readable(found)
    law = found["piezoviscosity"]
    assert law.matters and not law.change.found and law.change.size == math.inf
    assert law.advice.endswith("No film was found that carries this load then.")
    assert "no film" in str(found).split("\n\n")[0] and "no film found that carries the same load" in str(law.change)


def test_an_effect_without_which_no_film_is_found_is_not_called_needless(monkeypatch):
    """However small its indicator."""
    made = bearing(asperity=ASPERITY)
    lost = Change(load=math.nan, minimum_gap=math.nan, peak_pressure=math.nan, power_loss=math.nan)
    assert audit(made)["contact"].unneeded
    monkeypatch.setitem(LIMITS, "contact", LIMITS["contact"]._replace(nothing=0.0))
    monkeypatch.setattr(Case, "change", lambda case, switch: lost)
    found = audit(made)["contact"]
    assert found.change is lost and not found.unneeded and not found.advice


# Cases that a cavitated share times a squeeze share called nothing: light and heavy, on the move and at rest.
CAVITIES = [
    ((0.02, 0.02, 25e-6), 0.02, 300.0, 0.5),
    ((0.05, 0.05, 60e-6), 0.02, 300.0, 0.5),
    ((0.0092, 0.021, 12.1e-6), 0.032, 609.0, 0.715),
    ((0.0415, 0.103, 16.9e-6), 0.084, 22.0, 0.675),
]


def sized(sizes, viscosity, **options):
    R, L, c = sizes
    oil = ehd.Lubricant(viscosity=viscosity)
    return ehd.JournalBearing(journal_radius=R, length=L, radial_clearance=c, lubricant=oil, **options)


@pytest.mark.parametrize(("sizes", "viscosity", "speed", "eps"), sample(CAVITIES, 0))
def test_cavities_that_keep_their_oil_are_solved_for(sizes, viscosity, speed, eps):
    made = sized(sizes, viscosity)
    film = ehd.steady(made, speed=speed, eccentricity_ratio=eps)
    finding = film.audit()["mass conservation"]
    keeping = dataclasses.replace(made, cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    same_place = ehd.steady(keeping, speed=speed, eccentricity_ratio=eps)
    true = ehd.equilibrium(keeping, speed=speed, load=tuple(-film.force[:2])).film
    assert finding in film.audit().neglected
    change = finding.change
    assert change.load == pytest.approx(np.hypot(*same_place.force[:2]) / np.hypot(*film.force[:2]) - 1.0, abs=1e-9)
    for name in ("minimum_gap", "peak_pressure", "power_loss"):
        assert getattr(change, name) == pytest.approx(getattr(true, name) / getattr(film, name) - 1.0, abs=1e-3)
    # followed, the advice ends
    followed = film.audit().improved(made)
    assert followed.cavitation == keeping.cavitation
    on = ehd.steady(keeping, speed=speed, eccentricity_ratio=eps).audit()["mass conservation"]
    assert on.matters and not on.advice


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "eps"), sample([(628.0, 0.85), (314.0, 0.4)], 0))
def test_steel_gives_way(speed, eps):
    made = sized((0.03, 0.066, 30e-6), 9e-3)
    film = ehd.steady(made, speed=speed, eccentricity_ratio=eps)
    finding = film.audit()["elasticity"]
    ring = steel_ring(made)
    true = ehd.equilibrium(ring, speed=speed, load=tuple(-film.force[:2])).film
    peak, gap = (getattr(true, n) / getattr(film, n) - 1.0 for n in ("peak_pressure", "minimum_gap"))
    assert finding.matters is (max(abs(peak), abs(gap)) > 0.03) and finding.on is False
    # by a coarse ring
    assert finding.change.peak_pressure == pytest.approx(peak, abs=0.01 + 0.1 * abs(peak))
    assert finding.change.minimum_gap == pytest.approx(gap, abs=0.01 + 0.1 * abs(gap))


def test_half_sommerfeld_is_compared_with_the_rupture_that_keeps_the_flow():
    found = audit(bearing(cavitation=ehd.Gumbel()), eps=0.8)["rupture"]
    assert found.matters and "SwiftStieber" in found.advice
    assert found.change.peak_pressure < -0.03 or found.change.minimum_gap > 0.03
    with pytest.raises(KeyError):
        audit(bearing())["rupture"]


@pytest.mark.slow
def test_coarse_areas_of_supply_are_told():
    narrow = ehd.AxialGroove(angle=math.pi, width_angle=0.2, pressure=3e6)
    film = ehd.FiniteLength(n_theta=32, n_z=6)
    coarse = audit(bearing(supply=(narrow,), film=film), eps=0.6)["supply resolution"]
    groove = ehd.AxialGroove(angle=math.pi, width_angle=0.5, pressure=1e5)
    fine = audit(bearing(supply=(groove,), film=ehd.FiniteLength(n_theta=144, n_z=12)), eps=0.6)["supply resolution"]
    assert coarse.change.size > 2.0 * fine.change.size
    assert not fine.matters


@pytest.mark.slow
def test_elasticity_of_a_journal_named_and_not():
    """A steel pin is nothing under little load and much under more; a bush that knows no journal has no row of it."""
    light, heavy = (audit(bearing(), eps=eps)["journal elasticity"] for eps in (0.1, 0.9))
    assert light.on is False and light.change is None and not light.matters
    assert heavy.on is False and heavy.change.size > 0.03 and heavy.remedy(bearing()).journal is not None
    steel = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
    half = 0.5 * bearing().length
    pin = ehd.ElasticJournal(material=steel, span=(-half, half), held=None, tolerance=0.08)
    named = audit(bearing(journal=pin), eps=0.9)
    assert named["journal elasticity"].on and named["journal elasticity"].matters
    assert named["elasticity"].on is False
    idle = audit(bearing(journal=pin), eps=0.1)["journal elasticity"]
    assert idle.unneeded and idle.remedy(bearing(journal=pin)).journal is None
    with pytest.raises(KeyError):
        audit(bearing(bush=ehd.ElasticLiner(thickness=0.002, youngs_modulus=2e11)))["journal elasticity"]


def test_elasticity_of_a_liner_given_and_asked_about():
    soft, stiff = (ehd.ElasticLiner(thickness=0.002, youngs_modulus=E) for E in (2e9, 2e11))
    assert not audit(bearing())["elasticity"].matters and "steel ring" in audit(bearing())["elasticity"].indicator
    asked = audit(bearing(), eps=0.8, liner=soft)
    assert asked["elasticity"] in asked.neglected
    assert not audit(bearing(), eps=0.5, liner=stiff)["elasticity"].matters
    named = audit(bearing(bush=soft), eps=0.8)
    assert named["elasticity"].matters and named["elasticity"].on and not named["elasticity"].advice
    # a soft liner lowers the peak and widens the gap: Winkler elements under the rigid film's pressure overestimate
    assert 0.1 < named["elasticity"].value < asked["elasticity"].value
    assert audit(bearing(bush=stiff), eps=0.5)["elasticity"].unneeded
    with pytest.raises(ehd.InputError, match="liner must be ElasticLiner"):
        audit(bearing(), liner=2e11)


ON = {
    **LAWS,
    "heating": {"thermal": ehd.LumpedThermal(supply_temperature=313.15), "lubricant": ehd.oil("ISO VG 46")},
    "roughness": {"roughness": ehd.PatirCheng(composite_roughness=0.4e-6)},
    "contact": {"asperity": ASPERITY},
    "wear": {"asperity": ASPERITY, "wear": ehd.ArchardWear(wear_rate=1e-16)},
    "elasticity": {"bush": ehd.ElasticLiner(thickness=0.002, youngs_modulus=2e11)},
    "profile": {"profile": ehd.Crown(drop=0.1e-6)},
    "mass conservation": {"cavitation": ehd.ElrodAdams(), "end_pressures": SUPPLIED},
}


@pytest.mark.parametrize("effect", list(ON))
def test_effects_that_do_not_matter_are_unneeded(effect):
    # slow and nearly concentric: no pressure, no heat, a thick film
    found = audit(bearing(**ON[effect]), eps=0.05, speed=0.1, measure_time=True)
    finding = found[effect]
    assert finding.on and finding.unneeded and finding in found.unneeded
    assert finding.time_share is not None and 0.0 <= finding.time_share < 1.0
    check_readable(found)
    assert f"{finding.time_share:.0%}" in str(found)


@pytest.mark.parametrize("across", sample([1, 2], 0))
def test_fields_of_temperature_are_compared_with_finer_grids(across):
    """They settle there anew; the audit ended with an error of numpy."""
    thermal = ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=2e3, conductivity=0.13, across=across)
    made = bearing(thermal=thermal, lubricant=ehd.oil("ISO VG 46"), film=ehd.FiniteLength(n_theta=48, n_z=6))
    found = audit(made, eps=0.8)
    for name, sizes in (("grid around", (96, 6)), ("grid along", (48, 12))):
        finer = dataclasses.replace(made, film=ehd.FiniteLength(n_theta=sizes[0], n_z=sizes[1]))
        loads = [np.hypot(*ehd.steady(b, speed=SPEED, eccentricity_ratio=0.8).force[:2]) for b in (made, finer)]
        assert found[name].change.load == pytest.approx(loads[1] / loads[0] - 1.0, abs=1e-6)


@pytest.mark.slow
def test_heat_into_walls():
    """Off: what walls of steel would change. On: the shares of the heat that they take."""
    made = bearing(thermal=ehd.FilmEnergy(supply_temperature=313.15), lubricant=ehd.oil("ISO VG 46"))
    found = audit(made, eps=0.8)
    walls = found["walls"]
    check_readable(found)
    assert walls.on is False and walls.matters and walls in found.neglected
    steel = walls.remedy(made)
    film = ehd.steady(steel, speed=SPEED, eccentricity_ratio=0.8)
    found = film.audit()
    check_readable(found)
    thermal, model = steel.thermal, build_model(steel)
    history = History(temperature=film.walls.behind(film.temperature))
    balance = model.effects.thermal.balance(model.evaluate(film.motion, history).film, history.temperature)
    given = thermal.bush.conductance * (film.walls.bush[:, -1].mean() - 313.15) + balance["journal"]
    assert found["walls"].on and found["walls"].matters
    assert found["walls"].value == pytest.approx(given / balance["heat_in"], rel=1e-6)
    # given temperatures say where the heat goes
    fixed = dataclasses.replace(made.thermal, bush_coefficient=1e3)
    assert "walls" not in [f.effect for f in audit(dataclasses.replace(made, thermal=fixed), eps=0.5).findings]


HARD = {
    "piezoviscosity": {"eps": 0.7},
    "shear thinning": {"eps": 0.955},
    "roughness": {"eps": 0.955},
    "contact": {"eps": 0.98, "speed": 10.0},
    "wear": {"eps": 0.955, "speed": 10.0},
    "heating": {"eps": 0.8},
    "mass conservation": {"eps": 0.8, "velocity": (0.0, 2e-3)},
}


@pytest.mark.parametrize("effect", list(HARD))
def test_effects_that_matter_are_neither_neglected_nor_unneeded(effect):
    found = audit(bearing(**ON[effect]), **HARD[effect])
    assert found[effect].on and found[effect].matters
    assert found[effect] not in (*found.neglected, *found.unneeded)


@pytest.mark.parametrize("eps", sample([0.2, 0.5, 0.9], 0))
def test_heat_that_halves_the_viscosity_is_not_solved_without(eps, monkeypatch):
    """Its film without heat is another one by far more than the limit."""
    for speed in (10.0, 100.0, 900.0):
        plain = audit(bearing(**ON["heating"]), eps=eps, speed=speed)["heating"]
        with monkeypatch.context() as patch:
            patch.setitem(LIMITS, "heating", LIMITS["heating"]._replace(much_on=math.inf))
            solved = audit(bearing(**ON["heating"]), eps=eps, speed=speed)["heating"]
        much = plain.value > LIMITS["heating"].much_on
        assert (plain.change is None) == much
        assert plain.matters == solved.matters
        if much:
            assert solved.change.size > 0.5 and not plain.unneeded


def test_profile_matters_in_thin_films():
    assert audit(bearing(profile=ehd.Crown(drop=2e-6)), eps=0.8)["profile"].matters


@pytest.mark.slow
def test_time_is_only_measured_when_asked():
    assert all(f.time_share is None for f in audit(bearing(asperity=ASPERITY)).findings)
    measured = audit(bearing(asperity=ASPERITY), measure_time=True)
    assert [f.effect for f in measured.findings if f.time_share is not None] == ["contact"]
    # journals in contact have no film to compare with
    assert audit(bearing(asperity=ASPERITY), eps=1.005, measure_time=True)["contact"].time_share is None


GROOVE = (ehd.AxialGroove(angle=math.pi, width_angle=0.3),)
MODELS = {
    "short": {"film": ehd.ShortBearing()},
    "long": {"film": ehd.LongBearing(), "inlet": ehd.MaximumGap()},
    "long with a groove": {"film": ehd.LongBearing(), "supply": GROOVE},
    "classic": {"film": ehd.ClassicSOR(n_theta=48, n_z=8), "cavitation": ehd.Gumbel()},
    "map": {"film": ehd.ImpedanceMap()},
    "maximum gap": {"inlet": ehd.MaximumGap()},
    "field": {
        "thermal": ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=2e3),
        "lubricant": ehd.oil("ISO VG 46"),
    },
    "wall": {"contact": ehd.RegularisedWall(onset=1e-6)},
    "sommerfeld": {"cavitation": ehd.FullSommerfeld()},
    "gumbel": {"cavitation": ehd.Gumbel()},
    "elrod": {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    "all laws": {**LAWS["piezoviscosity"], **LAWS["shear thinning"], "asperity": ASPERITY},
}


# every film once, the even ones in their centre
@pytest.mark.parametrize(
    ("eps", "name"), sample(itertools.product([0.0, 0.7], MODELS), *range(0, 12, 2), *range(13, 24, 2))
)
def test_every_film_model_and_closure(name, eps):
    found = audit(bearing(**MODELS[name]), eps=eps, measure_time=True)
    check_readable(found)
    effects = [f.effect for f in found.findings]
    assert len(set(effects)) == len(effects)
    assert "long" not in name or "grid along" not in effects
    assert name != "map" or found["misalignment"].on is False


def test_equilibrium_has_an_audit():
    result = ehd.equilibrium(bearing(), speed=SPEED, load=(0.0, -1000.0))
    check_readable(result.film.audit())


@pytest.mark.parametrize(
    "name", sample([name for name in MODELS if name not in ("long", "long with a groove", "classic")], 0, 3, -1)
)
def test_audits_go_to_other_processes(name):
    """And their switches work there; the three left out have none for the steel that gives way."""
    made = bearing(**MODELS.get(name, {}))
    found = audit(made, eps=0.7)
    sent = pickle.loads(pickle.dumps(found))
    assert str(sent) == str(found)
    assert repr(sent.improved(made)) == repr(found.improved(made))


def test_standstill_has_an_audit():
    check_readable(audit(bearing(), eps=0.0, speed=0.0))


def test_unknown_effect_lists_the_known_ones():
    with pytest.raises(KeyError, match="misalignment"):
        audit(bearing())["phlogiston"]


def record(made, motion, time):
    films = [build_model(made).evaluate(m) for m in motion]
    q, force = [film.quantities() for film in films], np.array([film.wrench[:3] for film in films])
    known = {"time": time, "motion": motion, "force": force}
    names = [f.name for f in dataclasses.fields(RecordedSteps) if f.name not in known]
    return RecordedSteps(**known, **{n: np.array([row.get(n, np.nan) for row in q]) for n in names})


def orbit(n, radius=0.6, whirl=150.0):
    angle = 2.0 * math.pi * np.arange(n + 1) / n
    motion = np.zeros((n + 1, 10))
    motion[:, :2] = radius * C * np.column_stack((np.cos(angle), np.sin(angle)))
    motion[:, 4:6] = whirl * radius * C * np.column_stack((-np.sin(angle), np.cos(angle)))
    motion[:, 8] = SPEED
    return motion, angle / whirl


@pytest.mark.parametrize(
    "cavitation", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5)], ids=["swift", "elrod"]
)
def test_step_of_a_record_against_the_gap(cavitation):
    made = bearing(cavitation=cavitation)
    found = []
    for error in (0.07, 0.01):
        steps = record(made, *orbit(80))
        # the first states know no error
        found.append(audit_record(made, dataclasses.replace(steps, step_error=np.r_[[np.nan] * 3, np.full(78, error)])))
    coarse, fine = found
    assert coarse["time step"].matters and not fine["time step"].matters
    assert (coarse["time step"].value, fine["time step"].value) == (0.07, 0.01)
    # 2 % at errors of second order; the whirl takes two turns of the journal
    assert "take 75 steps per turn of the journal" in coarse["time step"].advice
    assert fine["squeeze"].value == pytest.approx(0.5)
    for found in (coarse, fine):
        assert not found["ringing"].matters
        check_readable(found)


def test_inertia_of_a_flow_that_swings_between_plates():
    """The limit of the row holds: inertia takes Re / 10 of the viscous pressure, for Re = rho w h^2 / mu up to 1."""
    for reynolds in (1e-3, 1.0):
        k = 0.5 * np.sqrt(1j * reynolds)  # velocity profile 1 - cosh(k y) / cosh(k) over the half height
        pressure = 1j * reynolds / (1.0 - np.tanh(k) / k) / 12.0  # over that of the viscous flow
        # the next terms of the series: of size Re^2
        assert pressure == pytest.approx(1.0 + 0.1j * reynolds, abs=2e-3 * reynolds**2)


@pytest.mark.slow
def test_dampers_have_the_inertia_of_their_squeeze():
    """Whirls and vibrations of any ellipse, with any spin: at an instant, and over a run."""
    rng = np.random.default_rng(3)
    for k in range(40):
        c, mu, w = 10.0 ** rng.uniform(-5.0, -3.8), 10.0 ** rng.uniform(-3.0, -1.0), 10.0 ** rng.uniform(1.0, 3.5)
        made = bearing(radial_clearance=c, lubricant=ehd.Lubricant(viscosity=mu), cavitation=ehd.FullSommerfeld())
        eps, per_rate = rng.uniform(0.1, 0.9), 870.0 * c * c / mu
        if k < 3:
            # an audit solves many films, all for one product
            whirl = audit(made, eps=eps, speed=0.0, velocity=(0.0, eps * c * w))["fluid inertia"]
            assert whirl.value == pytest.approx(per_rate * w, rel=1e-9)
            assert whirl.matters is (per_rate * w > 1.0)
        # means over two turns of an ellipse less the first and last of 400 steps
        t = np.linspace(0.0, 4.0 * math.pi / w, 401)
        motion, axes, tilted = np.zeros((401, 10)), rng.uniform(0.0, 0.5, 2) * eps * c, rng.integers(2)
        swing = np.column_stack((axes[0] * np.cos(w * t), axes[1] * np.sin(w * t)))
        speed = w * np.column_stack((-axes[0] * np.sin(w * t), axes[1] * np.cos(w * t)))
        first, per = (2, 0.5 * made.length) if tilted else (0, 1.0)
        motion[:, first : first + 2], motion[:, first + 4 : first + 6] = swing / per, speed / per
        assert squeeze_rate(sources(made, motion), c, t) == pytest.approx(w, rel=0.01)
        # velocities that an integrator throws to and fro from step to step count as velocities alone
        thrown = motion.copy()
        thrown[:, first + 4 : first + 6] += 0.3 * w * axes / per * (-1.0) ** np.arange(401)[:, None]
        assert 0.8 * w < squeeze_rate(sources(made, thrown), c, t) < 1.01 * w
        # beside a wedge: by the share of the squeeze in the sources
        motion[:, 8] = rng.uniform(-4.0, 4.0) * w
        moving, wedge = np.linalg.norm(speed, axis=1), 0.5 * abs(motion[0, 8]) * np.linalg.norm(swing, axis=1)
        share = np.trapezoid(moving, t) / np.trapezoid(moving + wedge, t)
        assert squeeze_rate(sources(made, motion), c, t) == pytest.approx(w * share, rel=0.01)


def test_worst_states_are_found():
    made = bearing()
    motion, time = orbit(20)
    motion[7, :2] *= 1.5
    motion[11, 2] = 5e-4
    motion[15, 8] = 2000.0
    assert {7, 11, 15} <= set(worst_steps(made, record(made, motion, time)))


def test_tilt_and_squeeze_shares():
    made = bearing()
    motion = np.zeros((1, 10))
    assert tilt_loss(made, motion) == squeeze_share(sources(made, motion)) == 0.0
    motion[0, :3] = 0.5 * C, 0.0, 0.1 * C / 0.01
    assert tilt_loss(made, motion) == pytest.approx(0.2)
    motion[0, 4] = 1e-3
    assert squeeze_share(sources(made, motion)) == 1.0  # nothing turns
    motion[0, 8] = 2e-3 / (0.6 * C)
    assert squeeze_share(sources(made, motion)) == pytest.approx(0.5)


def test_intervals_at_half_height():
    x = np.linspace(-1.0, 1.0, 41)
    # a triangle of half width 0.5: linear interpolation is exact
    assert intervals_at_half(np.maximum(0.0, 1.0 - np.abs(x)), 20) == pytest.approx(20.0)
    assert intervals_at_half(np.zeros(8), 3) == 8.0
    assert intervals_at_half(np.ones(8), 3) == 7.0


def load(made, eps):
    return float(np.hypot(*ehd.steady(made, speed=SPEED, eccentricity_ratio=eps).force[:2]))


@pytest.mark.parametrize(("n_theta", "eps"), sample([(48, 0.95), (64, 0.98), (48, 0.98), (192, 0.1), (256, 0.4)], 0, 3))
def test_advised_grids_carry_the_load(n_theta, eps, measured):
    """Both "too coarse" and "finer than needed" name a grid that is neither."""
    made = bearing(film=ehd.FiniteLength(n_theta=n_theta, n_z=12))
    advised = int(re.search(r"n_theta=(\d+)", audit(made, eps=eps)["grid around"].advice)[1])
    followed = bearing(film=ehd.FiniteLength(n_theta=advised, n_z=12))
    finding = audit(followed, eps=eps)["grid around"]
    assert not finding.matters and not finding.unneeded
    fine = load(bearing(film=ehd.FiniteLength(n_theta=512, n_z=12)), eps)
    # the threshold stands for 1 % of the load
    measured("load against 512 columns", abs(load(followed, eps) / fine - 1.0), 0.01)


@pytest.mark.slow
@pytest.mark.parametrize("eps", [0.6, 0.8])
def test_thresholds_stand_for_a_few_per_cent(eps, measured):
    plain = ehd.steady(bearing(), speed=SPEED, eccentricity_ratio=eps)
    at_threshold = 0.1 / plain.peak_pressure
    thick = bearing(pressure_law=ehd.BarusPressure(coefficient=at_threshold))
    compliance = 0.1 * plain.minimum_gap / plain.peak_pressure
    unit = ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e10).compliance
    soft = bearing(bush=ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e10 * unit / compliance))
    rough = bearing(roughness=ehd.PatirCheng(composite_roughness=plain.minimum_gap / 3.0))
    for made in (thick, soft, rough):
        film = ehd.steady(made, speed=SPEED, eccentricity_ratio=eps)
        change = abs(film.peak_pressure / plain.peak_pressure - 1.0)
        # between "nobody would see it" and "a wrong film"
        assert 0.02 < change < 0.12, (made, change)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*the bush strains by")
def test_films_that_narrow_within_the_last_interval_ask_for_more_rows():
    """A thin soft bush: the film is twice as thick one interval before its end, where it is 7 % too thin."""
    R, L = 0.02, 0.02
    mesh = ehd.HollowCylinder(inner_radius=R + 50e-6, thickness=1e-3, length=L, axial=4, radial=1, circumferential=24)
    rubber = ehd.SaintVenantKirchhoff(youngs_modulus=5e6, poisson_ratio=0.3, density=1200.0)
    thin = {}
    for n_z in (10, 24):
        described = ehd.JournalBearing(
            journal_radius=R,
            length=L,
            radial_clearance=50e-6,
            lubricant=ehd.Lubricant(viscosity=0.02),
            film=ehd.FiniteLength(n_theta=48, n_z=n_z),
            bush=ehd.ModalBush(mesh=mesh, material=rubber, tolerance=0.02, tilted=False),
        )
        film = ehd.steady(described, speed=100.0 * np.pi, eccentricity_ratio=0.9)
        found = film.audit()["grid along"]
        assert found.matters == (n_z == 10)
        assert not found.matters or "narrows too fast" in found.advice
        thin[n_z] = film.minimum_gap
    assert thin[10] < 0.95 * thin[24]
