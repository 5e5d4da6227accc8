"""Fast thin liquids in rotors, swings, cranks and tilted rotors, drawn at random: every run goes through."""

import warnings

import numpy as np
import pytest

import exudyn_ehd as ehd
from tests.fuzz.mixed_runs import Model, Scene

POLYMER = ehd.ElasticLiner(thickness=2e-3, youngs_modulus=3e9)


def scene(seed):
    """Reynolds numbers of 500 to 40000, a tenth to three times the load that the laminar film has as its unit."""
    rng = np.random.default_rng([seed, 77])
    drive = ("rotor", "swing", "crank", "tilted")[seed % 4]
    radius, speed = float(rng.choice([0.03, 0.06, 0.1])), float(rng.choice([100.0, 300.0, 600.0]))
    length, clearance = radius * float(rng.choice([0.7, 1.0, 1.6])), radius * float(rng.choice([1e-3, 2e-3, 3e-3]))
    viscosity = max(1000.0 * speed * radius * clearance / 10.0 ** rng.uniform(2.7, 4.6), 2e-4)
    laws, options = {}, {}
    several = {
        "end_pressures": (1e5, 3e4),
        "profile": ehd.EdgeRelief(drop=0.2 * clearance, relief_length=0.2 * length),
        "thermal": ehd.FilmEnergy(supply_temperature=320.0, bush_coefficient=1e4)
        if rng.random() < 0.5
        else ehd.LumpedThermal(supply_temperature=320.0),
        "asperity": ehd.GreenwoodTripp(composite_roughness=5e-7, composite_modulus=1e11),
        "supply": (ehd.Hole(angle=rng.uniform(0.0, 6.0), diameter=0.3 * radius, pressure=2e5, rotating=seed % 3 == 0),),
        "bush": POLYMER,
    }
    for name, value in several.items():
        if rng.random() < 0.35:
            options[name] = value
    if "thermal" in options:
        law = ehd.ReynoldsTemperature(point=(320.0, viscosity), coefficient=0.015)
        laws = {"temperature_law": law, "temperature": 320.0, "specific_heat": 4180.0}
    closures = (ehd.SwiftStieber(), ehd.SwiftStieber(line_in_cells=True), ehd.ElrodAdams(cavity_pressure=-5e4))
    turbulence = (ehd.NgPan(), ehd.Hirs(), ehd.NgPan(onset=500.0, full=600.0))[rng.integers(3)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        bearing = ehd.JournalBearing(
            journal_radius=radius,
            length=length,
            radial_clearance=clearance,
            lubricant=ehd.Lubricant(viscosity=viscosity, density=1000.0, **laws),
            film=ehd.FiniteLength(n_theta=64, n_z=8),
            cavitation=closures[rng.integers(3)],
            turbulence=turbulence,
            **options,
        )
    load = 10.0 ** rng.uniform(-1.0, 0.5) * bearing.reference_force(speed)
    return Scene(bearing=bearing, drive=drive, speed=speed, load=load)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(16))
def test_turbulent_run(seed):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = Model(scene(seed))
        model.run(1.0, 200)
    history = model.joint.history
    for name in ("motion", "force", "moment", "minimum_gap", "peak_pressure", "power_loss", "friction_torque"):
        assert np.all(np.isfinite(getattr(history, name))), name
    # hardly a step is halved
    assert 201 <= history.time.size <= 215
    assert history.minimum_gap.min() > 0.0
