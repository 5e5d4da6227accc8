"""The audit of a joint: from its accepted steps, without touching it."""

import dataclasses
import math

import elastic_scene
import exudyn.itemInterface as eii
import numpy as np
import pytest
import scenes

import exudyn_ehd as ehd
from exudyn_ehd.joint.audit.samples import RecordedSteps, recorded_states
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

SPEED = 300.0
SMALL_MAP = ehd.ImpedanceMap(n_theta=64, n_z=8, n_eccentricity=12, n_direction=17, largest_eccentricity_ratio=0.9)


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("EXUDYN_EHD_CACHE", str(tmp_path_factory.getbasetemp() / "maps"))


def _joint(load=2000.0, assemble=True, **options):
    bearing = ehd.JournalBearing(
        **(
            {
                "journal_radius": 0.02,
                "length": 0.02,
                "radial_clearance": 20e-6,
                "lubricant": ehd.Lubricant(viscosity=0.02),
                "film": ehd.FiniteLength(n_theta=48, n_z=6),
            }
            | options
        )
    )
    mbs = scenes.new_system()
    ground = scenes.add_body(mbs, "ground")
    body = scenes.add_body(mbs, "2D", spin=(0, 0, SPEED))
    centre = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))
    mbs.AddLoad(eii.LoadForceVector(markerNumber=centre, loadVector=[0.0, -load, 0.0]))
    joint = ehd.CreateLubricatedJoint(mbs, "rotor", [ground, body], [0, 0, 0], [0, 0, 1], bearing)
    if assemble:
        mbs.Assemble()
    return mbs, joint


def _run(mbs, end=5e-3, steps=50):
    mbs.SolveDynamic(ehd.ConfigureSolver(scenes.settings(end, steps)))


def test_a_joint_without_steps_says_so():
    _, joint = _joint(assemble=False)
    with pytest.raises(ehd.InputError, match="'rotor' has no accepted steps"):
        joint.audit()


@pytest.mark.parametrize(
    "options",
    sample(
        [
            {},
            {"film": SMALL_MAP},
            {"film": ehd.ShortBearing()},
            {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
            {"asperity": ehd.GreenwoodTripp(composite_roughness=0.4e-6, composite_modulus=2e10)},
            {"bush": ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e10)},
            {"thermal": ehd.FilmEnergy(supply_temperature=320.0), "lubricant": ehd.oil("ISO VG 46", temperature=320.0)},
            {"supply": (ehd.AxialGroove(angle=1.0, width_angle=0.4, pressure=1e5, rotating=True, length=0.015),)},
        ],
        0,
        4,
    ),
    ids=["plain", "map", "short", "elrod", "asperity", "liner", "field", "turning groove"],
)
def test_every_joint_can_be_audited(options):
    mbs, joint = _joint(**options)
    _run(mbs)
    evaluations, record = joint.element.evaluations, joint.history.force.copy()
    found = joint.audit()
    assert "nan" not in str(found)
    assert all(math.isfinite(f.value) for f in found.findings)
    assert {"time step", "heating", "squeeze", "contact"} <= {f.effect for f in found.findings}
    # nothing of the joint has moved: neither its film nor its record
    assert joint.element.evaluations == evaluations
    assert np.array_equal(joint.history.force, record)


def test_fields_of_a_film_that_remembers_are_those_of_the_run():
    mbs, joint = _joint(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    _run(mbs)
    found = joint.audit()
    law = 2e-8  # the coefficient that the audit takes where none is named
    peak = np.max(joint.history.peak_pressure[1:])
    # The record starts flooded and is run again from its first step: the same films, up to Newton's tolerance of the
    # run.
    assert found["piezoviscosity"].value == pytest.approx(law * peak, rel=1e-6)


def test_load_and_step_show():
    light, heavy = _joint(load=200.0), _joint(load=2e5)
    for mbs, _ in (light, heavy):
        _run(mbs)
    calm, hard = light[1].audit(), heavy[1].audit()
    for effect in ("piezoviscosity", "grid around"):
        assert not calm[effect].matters and hard[effect].matters, effect
    assert hard["time step"].value > calm["time step"].value
    assert calm["squeeze"].matters  # dropped from the centre


@pytest.mark.slow
def test_contact_is_counted_over_the_steps():
    mbs, joint = _joint(contact=ehd.RegularisedWall(onset=1e-6))
    _run(mbs)
    finding = joint.audit()["contact"]
    assert finding.unneeded and "acting in 0% of the steps" in finding.indicator
    assert "most at" not in finding.indicator
    mbs, joint = _joint(load=2e5, contact=ehd.RegularisedWall(onset=1e-5))
    _run(mbs)
    finding, history = joint.audit()["contact"], joint.history
    assert finding.matters
    first, most = history.time[np.argmax(history.contact_load > 0)], history.time[np.argmax(history.contact_load)]
    assert f", {first:.4g} to {history.time[-1]:.4g} s, most at {most:.4g} s" in finding.indicator
    mbs, joint = _joint(contact=ehd.RegularisedWall(onset=1e-6))
    _run(mbs)
    share = joint.audit(measure_time=True)["contact"].time_share
    assert share is not None and 0.0 <= share < 1.0


ALUMINIUM = ehd.SaintVenantKirchhoff(youngs_modulus=7e10, poisson_ratio=0.3, density=2700.0)
FLEXIBLE = {
    "modal": ehd.ModalBush(mesh=elastic_scene.CYLINDER, material=ALUMINIUM, tolerance=0.2),
    "nodal": ehd.ANCFBush(mesh=elastic_scene.CYLINDER, material=ALUMINIUM),
}


@pytest.mark.parametrize(
    ("kind", "cavitation"),
    sample(
        [
            (kind, closure)
            for kind in FLEXIBLE
            for closure in (ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-1e5))
        ],
        1,
    ),
    ids=[f"{kind}-{closure}" for kind in FLEXIBLE for closure in ("swift", "elrod")],
)
def test_a_flexible_bore_is_audited_as_deformed(kind, cavitation):
    """Against the films that the run kept. Indicators of the field are those of a settled bore, the others those of the
    run."""
    scene = elastic_scene.Scene(elastic_scene.bearing(FLEXIBLE[kind], cavitation=cavitation))
    joint = scene.joint
    joint.record_films(period=0.0)
    scene.run(scenes.settings(4e-3, 40, tolerance=1e-7), ehd.SolveDynamicSparse if kind == "nodal" else None)
    found, history = joint.audit(measure_time=True), joint.history
    largest = [float(np.abs(film.bore_displacement).max()) for film in joint.films]
    np.testing.assert_allclose(history.bore_displacement, largest, rtol=1e-3)
    value = float(np.max(history.bore_displacement / history.minimum_gap))
    assert value > 0.1 and found["elasticity"].matters
    assert found["elasticity"].value == pytest.approx(value, rel=1e-12)
    assert found["piezoviscosity"].value == pytest.approx(2e-8 * np.max(history.peak_pressure), rel=1e-12)
    assert 0.0 < found["elasticity"].time_share < 1.0


def test_a_liner_can_be_asked_about():
    mbs, joint = _joint()
    _run(mbs)
    soft = joint.audit(liner=ehd.ElasticLiner(thickness=0.002, youngs_modulus=5e8))
    assert soft["elasticity"] in soft.neglected


def test_an_audit_says_the_same_again():
    mbs, joint = _joint(cavitation=ehd.ElrodAdams(cavity_pressure=-1e5))
    _run(mbs)
    assert str(joint.audit()) == str(joint.audit())


@pytest.mark.parametrize("control", [None, ehd.StepControl(error=0.002)], ids=["equal", "chosen"])
def test_heat_is_averaged_over_the_time_of_a_run(control):
    mbs, joint = _joint()
    ehd.SolveDynamic(mbs, ehd.ConfigureSolver(scenes.settings(5e-3, 50)), stepControl=control)
    h, oil = joint.history, joint.bearing.lubricant
    loss, flow = (np.trapezoid(values, h.time) for values in (h.power_loss, h.leakage))
    rise = loss / (oil.density * oil.specific_heat * flow)
    assert joint.audit()["heating"].value == pytest.approx(0.03 * rise, rel=1e-12)
    # small steps at the start are many of the rows and little of the time
    assert control is None or abs(np.mean(h.power_loss) / np.mean(h.leakage) * flow / loss - 1.0) > 0.01


@pytest.mark.parametrize(
    "options",
    [
        {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
        {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=1e9)},
    ],
    ids=["elrod", "liner"],
)
def test_films_that_remember_are_those_of_the_run_whatever_its_steps(options):
    """A flooded, undeformed start is forgotten within a turn, of which sixty small steps are little."""
    mbs, joint = _joint(**options)
    _run(mbs, end=4.0 * math.pi / SPEED, steps=2000)
    history, model = joint.history, build_model(joint.bearing)
    record = RecordedSteps(**{field.name: getattr(history, field.name) for field in dataclasses.fields(RecordedSteps)})
    late = [state for state in recorded_states(model, record) if state.recorded > 200]
    assert late
    for state in late:
        force = history.force[state.recorded]
        assert np.linalg.norm(state.evaluate(model).wrench[:3] - force) < 0.05 * np.linalg.norm(force)


def test_heat_of_a_thermal_run_is_its_own():
    lumped = {
        "thermal": ehd.LumpedThermal(supply_temperature=320.0),
        "lubricant": ehd.oil("ISO VG 46", temperature=320.0),
    }
    mbs, joint = _joint(**lumped)
    _run(mbs)
    finding, law = joint.audit()["heating"], joint.bearing.lubricant.temperature_law
    rise = np.max(joint.history.film_temperature) - 320.0
    slope = math.log(law.viscosity(319.0, 879.0) / law.viscosity(321.0, 879.0)) / 2.0
    # the film of a step has the temperature of its start, and so has the audited one
    assert finding.on and finding.value == pytest.approx(slope * rise, rel=0.1)
