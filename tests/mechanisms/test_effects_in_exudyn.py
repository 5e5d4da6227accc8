"""One short transient per effect in Exudyn: Newton's iterations are those of the plain film, and the physics shows.

A rotor of 2 kg is dropped from the centre of its bearing under 600 N at 200 rad/s, in steps
of 0.1 ms. Each effect runs next to the film without it (same closure, supply and end pressures). The
laws of the lubricant and the temperature field have such runs in tests/coupling/test_rheology_run.py,
reduced films in tests/coupling/test_film_models_in_exudyn.py; here they get their physics.
"""

import functools

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from tests.sampling import sample

SPEED, LOAD, STEPS, STEP = 200.0, 600.0, 120, 1e-4
OIL = ehd.oil("ISO VG 46", temperature=323.15)
ASPERITY = ehd.GreenwoodTripp(composite_roughness=0.8e-6, composite_modulus=2e10)
ENDS = (2e4, 2e4)
# Mixed friction: gaps of about the roughness.
HEAVY, SLOW = 24000.0, 4.0


def bearing(laws=None, **options):
    oil = ehd.Lubricant(
        viscosity=OIL.viscosity, temperature=OIL.temperature, temperature_law=OIL.temperature_law, **(laws or {})
    )
    plain = {
        "journal_radius": 0.02,
        "length": 0.016,
        "radial_clearance": 20e-6,
        "lubricant": oil,
        "film": ehd.FiniteLength(n_theta=64, n_z=8),
    }
    return ehd.JournalBearing(**(plain | options))


@pytest.fixture(scope="module")
def run(planar_rotor):
    """History and Newton iterations per step of a bearing under a load; each is run once."""

    @functools.cache
    def run(made, load=LOAD, speed=SPEED):
        rotor = planar_rotor(made, mass=2.0, speed=speed, load=(0.0, -load))
        history = rotor.run(STEPS * STEP, STEP)
        return history, rotor.mbs.sys["dynamicSolver"].it.newtonStepsCount / (history.time.size - 1)

    return run


@pytest.fixture
def compare(run, measured, request):
    """Histories with and without an effect, once its iterations are those of the plain film."""

    def compare(with_effect, without, load=LOAD, speed=SPEED):
        (on, steps), (off, plain_steps) = run(with_effect, load, speed), run(without, load, speed)
        for history in (on, off):
            # under heavy loads the first steps may be halved
            assert STEPS + 1 <= history.time.size <= 1.1 * STEPS
            for name in ("motion", "force", "moment", "minimum_gap", "peak_pressure", "friction_torque", "power_loss"):
                assert np.all(np.isfinite(getattr(history, name))), name
        print(f"{request.node.name}: {steps:.2f} Newton iterations per step, plain film {plain_steps:.2f}")
        # the exact tangent: a quarter of an iteration more at most, where
        # surfaces touch (0.20) or cavities refill (0.09)
        measured("Newton iterations per step", steps, plain_steps + 0.25)
        # as the guide says
        assert 1.1 < steps < 2.6
        return on, off

    return compare


def test_pressure_thickens_the_oil(compare):
    law = {"pressure_law": ehd.BarusPressure(coefficient=2e-8)}
    on, off = compare(bearing(law), bearing(), 4 * LOAD)
    # a thicker oil carries the same load in a wider gap
    assert on.minimum_gap.min() > 1.02 * off.minimum_gap.min()


@pytest.mark.slow
def test_shear_thins_the_oil(compare):
    law = {"shear_law": ehd.CarreauShear(relaxation_time=5e-6, exponent=0.5, residual=0.1)}
    on, off = compare(bearing(law), bearing())
    assert on.minimum_gap.min() < 0.98 * off.minimum_gap.min()
    assert abs(on.friction_torque[-1]) < 0.9 * abs(off.friction_torque[-1])


@pytest.mark.parametrize("law", [ehd.NgPan(), ehd.Hirs()], ids=["Ng-Pan", "Hirs"])
def test_turbulence_lifts_and_drags(compare, law):
    size = {"journal_radius": 0.1, "length": 0.1, "radial_clearance": 2e-4}
    water = size | {"lubricant": ehd.Lubricant(viscosity=1e-3, density=998.0)}
    on, off = compare(bearing(**water, turbulence=law), bearing(**water), LOAD, 300.0)
    assert on.minimum_gap[-1] > 1.1 * off.minimum_gap[-1]
    assert abs(on.friction_torque[-1]) > 2.0 * abs(off.friction_torque[-1])


@pytest.mark.parametrize(
    "thermal",
    [ehd.LumpedThermal(supply_temperature=323.15), ehd.FilmEnergy(supply_temperature=323.15)],
    ids=["lumped", "field"],
)
def test_heat_thins_the_oil(compare, thermal):
    on, off = compare(bearing(thermal=thermal, end_pressures=ENDS), bearing(end_pressures=ENDS))
    # without a step back in time: the film warms up from its start
    assert np.all(np.diff(on.film_temperature[5:]) > -1e-3) and on.film_temperature[-1] > 323.15 + 0.5
    assert abs(on.friction_torque[-1]) < abs(off.friction_torque[-1])
    assert np.all(np.isnan(off.film_temperature))


@pytest.mark.parametrize("closure", [ehd.SwiftStieber(), ehd.ElrodAdams(cavity_pressure=-5e4)], ids=["swift", "elrod"])
@pytest.mark.parametrize(
    "thermal",
    [ehd.LumpedThermal(supply_temperature=323.15), ehd.FilmEnergy(supply_temperature=323.15)],
    ids=["lumped", "field"],
)
def test_heat_thins_compressible_oil(compare, thermal, closure):
    options = {"thermal": thermal, "end_pressures": ENDS, "cavitation": closure}
    on, off = compare(bearing({"density_law": ehd.DowsonHigginson()}, **options), bearing(**options))
    # some 10 MPa compress oil by half a per cent: the film warms up as one of
    # incompressible oil, but not to the same temperature
    rise, plain = on.film_temperature[-1] - 323.15, off.film_temperature[-1] - 323.15
    assert plain > 0.5 and 1e-6 < abs(rise / plain - 1.0) < 0.02


def test_elrod_adams_conserves_oil(compare):
    closure = ehd.ElrodAdams(cavity_pressure=-5e4)
    on, _ = compare(
        bearing(cavitation=closure, end_pressures=ENDS),
        bearing(cavitation=ehd.SwiftStieber(cavity_pressure=-5e4), end_pressures=ENDS),
    )
    assert on.minimum_gap.min() > 0.0


@pytest.mark.parametrize(
    "area",
    [
        ehd.AxialGroove(angle=0.5 * np.pi, width_angle=0.5, length=0.01, pressure=2e5),
        ehd.Hole(angle=0.5 * np.pi, diameter=0.006, pressure=2e5),
        ehd.Pocket(angle=0.5 * np.pi, width_angle=0.5, length=0.006, pressure=2e5),
    ],
    ids=lambda area: type(area).__name__,
)
def test_supply_feeds_the_film(compare, area):
    on, off = compare(bearing(supply=(area,)), bearing())
    assert np.all(on.supply_flow[10:] > 0.0) and np.all(np.isnan(off.supply_flow))
    # what is pressed in leaves at the ends
    assert on.leakage[-1] > off.leakage[-1]


def test_groove_in_the_loaded_part_costs_film(compare):
    groove = ehd.CircumferentialGroove(width=0.004, pressure=1e5)
    on, off = compare(bearing(supply=(groove,)), bearing())
    # two short bearings carry less than a long one
    assert on.minimum_gap.min() < 0.9 * off.minimum_gap.min()


def test_roughness_along_the_motion_seals_a_narrow_bearing(compare):
    rough = ehd.PatirCheng(composite_roughness=1.5e-6, pattern=9.0)
    on, off = compare(bearing(roughness=rough), bearing(), 2 * LOAD)
    # ridges along the motion hold back the oil that leaves at the ends
    assert on.minimum_gap.min() > 1.01 * off.minimum_gap.min()


def test_asperities_brake_a_slow_journal(compare):
    on, off = compare(bearing(asperity=ASPERITY), bearing(), HEAVY, SLOW)
    assert on.contact_load.max() > 0.005 * HEAVY
    # boundary friction: most of the friction, at a share of the load below a hundredth
    assert on.contact_torque[-1] < 0.8 * on.friction_torque[-1] < 0.0
    assert np.all(off.contact_torque == 0.0) and np.all(off.contact_load == 0.0)


def test_wear_deepens_the_bore(compare):
    worn = ehd.ArchardWear(wear_rate=1e-15, acceleration=1e6)
    on, off = compare(bearing(asperity=ASPERITY, wear=worn), bearing(asperity=ASPERITY), HEAVY, SLOW)
    # the journal sinks into the worn bore, and asperities carry less
    assert on.eccentricity_ratio[-1] > off.eccentricity_ratio[-1]
    assert on.contact_load[-1] < off.contact_load[-1]
    # nothing is put back; Archard's law, of the steps' ends as the film takes it; the contact's resultant is below the
    # sum of its pressures by a few per cent
    for worn_off in (on.wear_depth, on.worn_volume):
        assert np.all(np.diff(worn_off) >= 0.0) and worn_off[0] == 0.0 < worn_off[-1]
    slid = np.cumsum(np.diff(on.time) * 0.02 * np.abs(on.motion[1:, 8]) * on.contact_load[1:])
    np.testing.assert_allclose(on.worn_volume[1:], 1e-9 * slid, rtol=0.04)
    assert np.all(np.isnan(off.wear_depth)) and np.all(np.isnan(off.worn_volume))


def test_crown_costs_film(compare):
    on, off = compare(bearing(profile=ehd.Crown(drop=3e-6)), bearing())
    assert on.minimum_gap.min() < off.minimum_gap.min()


def test_oval_bore_costs_film_under_its_short_axis(compare):
    # less deep by 2 um on the y axis, along which the load acts
    on, off = compare(bearing(profile=ehd.OutOfRound(order=2, amplitude=2e-6)), bearing())
    assert 0.0 < off.minimum_gap.min() - on.minimum_gap.min() < 2e-6


def test_liner_lowers_the_peak(compare):
    liner = ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e9)
    on, off = compare(bearing(bush=liner), bearing(), 4 * LOAD)
    assert on.peak_pressure.max() < 0.97 * off.peak_pressure.max()
    # the bore deflects: the axis goes further than in a rigid one
    assert on.eccentricity_ratio.max() > off.eccentricity_ratio.max()


SOFT = ehd.ElasticLiner(thickness=0.002, youngs_modulus=1e9)


@pytest.mark.slow
@pytest.mark.parametrize(
    "contact",
    sample([{"contact": ehd.RegularisedWall(onset=2e-6)}, {"asperity": ASPERITY}], 0),
    ids=["wall", "asperities"],
)
def test_liner_spreads_a_contact(compare, contact):
    on, off = compare(bearing(bush=SOFT, **contact), bearing(**contact), HEAVY, SLOW)
    # the journal sinks into the liner by more than the clearance, at its ends
    # too, and film and contact share a wider spot
    assert on.largest_eccentricity_ratio.max() > 2.0 > off.largest_eccentricity_ratio.max()
    assert on.contact_load[-1] > 0.02 * HEAVY
    assert on.peak_pressure.max() < 0.6 * off.peak_pressure.max()
    assert on.force[-1, 1] == pytest.approx(HEAVY, rel=1e-3)


# Hard elastohydrodynamics: pressures that thicken the oil and open the liner
BEDDED = ehd.ElasticLiner(thickness=0.002, youngs_modulus=5e9)
LAWS_ON_LINERS = {
    "barus": {"laws": {"pressure_law": ehd.BarusPressure(coefficient=3e-8)}},
    "roelands": {"laws": {"pressure_law": ehd.RoelandsPressure(coefficient=3e-8)}},
    "carreau": {"laws": {"shear_law": ehd.CarreauShear(relaxation_time=1e-6, exponent=0.6, residual=0.2)}},
    "rough": {"roughness": ehd.PatirCheng(composite_roughness=0.8e-6)},
    "mixed": {"roughness": ehd.PatirCheng(composite_roughness=0.8e-6), "asperity": ASPERITY},
    "energy": {"thermal": ehd.FilmEnergy(supply_temperature=323.15)},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", sample(list(LAWS_ON_LINERS), 1, 4))
def test_laws_on_a_liner(compare, name):
    # hot oil carries less before the ends touch, which do not deflect
    load = (4 if name == "energy" else 10) * LOAD
    on, off = compare(bearing(bush=BEDDED, **LAWS_ON_LINERS[name]), bearing(), load)
    assert on.force[-1, 1] == pytest.approx(off.force[-1, 1], rel=0.05)
    plain, _ = compare(bearing(bush=BEDDED), bearing(), load)
    # thick oil lifts the journal, hot, thin and rough films let it sink
    sunk = on.eccentricity_ratio[-1] - plain.eccentricity_ratio[-1]
    assert sunk < 0.0 if name in ("barus", "roelands", "rough", "mixed") else sunk > 0.0


def test_soft_liner_conserves_oil(compare):
    closure = ehd.ElrodAdams(cavity_pressure=-5e4)
    made = bearing(bush=SOFT, cavitation=closure, end_pressures=ENDS)
    on, off = compare(made, bearing(cavitation=closure, end_pressures=ENDS), 2 * LOAD)
    assert on.minimum_gap.min() > 0.0
    assert on.peak_pressure.max() < 0.97 * off.peak_pressure.max()


def test_wall_carries_where_the_film_ends(compare):
    on, _ = compare(bearing(contact=ehd.RegularisedWall(onset=2e-6)), bearing(), 20 * LOAD, SLOW)
    acting = on.contact_load > 0.0
    assert acting[-1] and not acting[0]
    assert np.all(on.minimum_gap[acting] < 2e-6) and np.all(on.minimum_gap[~acting] >= 2e-6)


def test_squeeze_is_the_damping(run):
    wall = ehd.RegularisedWall(onset=2e-6)
    with_it, _ = run(bearing(contact=wall), 200.0)
    # a spring alone, so stiff that the integrator rings
    with pytest.warns(ehd.RingingWarning):
        without, _ = run(bearing(contact=wall, squeeze=False), 200.0)
    # without the film's damping the journal passes its equilibrium, as far as the wall
    assert with_it.contact_load.max() == 0.0 < without.contact_load.max()


@pytest.mark.parametrize("bush", [None, SOFT], ids=["rigid", "liner"])
def test_elrod_adams_loses_no_oil_over_a_run(run, measured, bush):
    made = bearing(cavitation=ehd.ElrodAdams(cavity_pressure=-5e4), end_pressures=ENDS, bush=bush)
    history, _ = run(made)
    model = build_model(made)
    volume = model.solver.area * model.parts.flow_scale
    start = memory = model.initial_history(history.motion[0])
    # the recorded steps once more, for the oil content that the joint does not show
    for motion, step in zip(history.motion[1:], np.diff(history.time), strict=True):
        memory = model.evaluate(motion, memory, step).history()
    gained = float(np.sum(volume * (memory.mass - start.mass)))
    lost = float(np.sum(history.leakage[1:] * np.diff(history.time)))
    # rounding over 120 steps; the record's flows are those of the joint's own films
    measured("oil balance over the content", abs(gained + lost) / float(np.sum(volume * start.mass)), 1e-10)
    assert memory.mass.min() >= 0.0 and abs(lost) > 0.0
