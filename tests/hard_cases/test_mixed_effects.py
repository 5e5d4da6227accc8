"""Three to six effects at once over load cycles: every accepted step is finite,
and in balance of oil, heat and momentum.

The configurations are drawn with fixed seeds; combinations that a bearing refuses are left out by the draw.
"""

import dataclasses
import math

import hard_scene
import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.joint.solved_film import History

R, L, C = 0.02, 0.02, 25e-6
RATE = 2.0 * math.pi * 50.0
CYCLE = 2.0 * math.pi / RATE
ROUGH = 8e-7
MESH = ehd.HollowCylinder(inner_radius=R + C, thickness=0.006, length=L, axial=2, radial=1, circumferential=12)
STEEL = ehd.SaintVenantKirchhoff(youngs_modulus=2.1e11, poisson_ratio=0.3, density=7800.0)
CLOSURES = [
    ehd.ElrodAdams(cavity_pressure=-5e4),
    ehd.SwiftStieber(cavity_pressure=-5e4),
    ehd.Gumbel(),
    ehd.FullSommerfeld(),
]
# One of a group at most; "law" entries go to the lubricant.
GROUPS = [
    [
        ("law", {"pressure_law": ehd.BarusPressure(coefficient=5e-9)}),
        ("law", {"pressure_law": ehd.RoelandsPressure(coefficient=5e-9)}),
    ],
    [("law", {"shear_law": ehd.CarreauShear(relaxation_time=2e-6, exponent=0.8, residual=0.2)})],
    [("law", {"density_law": ehd.DowsonHigginson()})],
    [
        ("supply", (ehd.AxialGroove(angle=1.6, width_angle=0.5, length=0.7 * L, pressure=2e5),)),
        ("supply", (ehd.Hole(angle=0.4, diameter=7e-3, pressure=3e5, rotating=True),)),
    ],
    [("roughness", ehd.PatirCheng(composite_roughness=ROUGH, pattern=3.0))],
    [
        ("thermal", ehd.LumpedThermal(supply_temperature=313.15, capacity=1.0)),
        ("thermal", ehd.FilmEnergy(supply_temperature=313.15, bush_coefficient=2e4, conductivity=0.13)),
    ],
    [("profile", (ehd.Crown(drop=3e-6), ehd.OutOfRound(amplitude=2e-6, order=2)))],
    [("wear", ehd.ArchardWear(wear_rate=1e-15, acceleration=1e4))],
    [("end_pressures", (1e5, 3e4))],
]


def draw(seed):
    """A bearing with three to six of the groups, in contact by asperities."""
    rng = np.random.default_rng(seed)
    options, laws = {}, {}
    for k in rng.permutation(len(GROUPS))[: rng.integers(3, 7)]:
        name, value = GROUPS[k][rng.integers(len(GROUPS[k]))]
        if name == "law":
            laws |= value
        else:
            options[name] = value
    return ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=dataclasses.replace(ehd.oil("ISO VG 32", temperature=325.0), **laws),
        film=ehd.FiniteLength(n_theta=45, n_z=6),
        cavitation=CLOSURES[seed % len(CLOSURES)],
        asperity=ehd.GreenwoodTripp(composite_roughness=ROUGH, composite_modulus=2e10),
        **options,
    )


class Balances:
    """Largest errors of the balances over the accepted steps of a joint: oil, heat, force and moment on both sides."""

    def __init__(self, joint):
        self.oil = self.heat = self.momentum = 0.0
        self.element = element = joint.element
        self.row, self.force = element.row, element._generalized_force
        element.row, element._generalized_force = self.look, self.cancel

    def look(self, time, trial):
        row, model = self.row(time, trial), self.element.model
        old, step = trial.memory, trial.step
        if row is not None and isinstance(old, History) and step > 0.0:
            film, new, s = trial.evaluation.film, trial.evaluation.history(), model.solver
            if old.mass is not None:
                inflow, gain = s.inflow(), float(np.sum((new.mass - old.mass) * s.area)) / step
                self.oil = max(self.oil, abs(inflow.sum() - gain) / (np.abs(inflow).sum() + abs(gain)))
                assert s.fill.min() >= 0.0 and s.fill.max() <= 1.0
            if old.temperature is not None:
                b = model.effects.thermal.balance(film, new.temperature)
                error = abs(b["heat_in"] - b["convected"] - b["conducted"] - b["stored"])
                self.heat = max(self.heat, error / max(abs(v) for v in b.values()))
        return row

    def cancel(self, trial):
        out, (a, b), loads, wrench = self.force(trial), self.element.sides, np.empty((4, 3)), trial.evaluation.wrench
        relative.global_loads(a.frame, b.frame, wrench, loads)
        # by rounding the journal gets these and no others
        given, own = out[a.size : a.size + b.size], b.jac[0].T @ loads[2] + b.jac[1].T @ loads[3]
        np.testing.assert_allclose(given, own, rtol=1e-10, atol=1e-12 * np.abs(loads).max())
        errors = loads[0] + loads[2], loads[1] + loads[3] + np.cross(b.frame[:, 3] - a.frame[:, 3], loads[2])
        for error, size in zip(errors, (wrench[:3], wrench[3:]), strict=True):
            self.momentum = max(self.momentum, np.abs(error).max() / max(np.abs(size).max(), 1.0))
        return out

    def check(self):
        # the film's own accuracy 1e-11 and rounding, as with single effects
        assert self.oil < 1e-10 and self.heat < 1e-8 and self.momentum < 1e-10, vars(self)


def rotor(bearing, seed, **options):
    """Unbalanced loads on a rotor; every third seed starts tilted, every other one swings to and fro."""
    load = (300.0, 1500.0, 3000.0)[seed % 3]
    speed = 300.0 if seed % 2 else (lambda t: 200.0 / RATE * math.sin(RATE * t), lambda t: 200.0 * math.cos(RATE * t))
    return hard_scene.Rotor(
        bearing,
        mass=3.0,
        speed=speed,
        position=(0.2 * C, -0.3 * C),
        **options,
        load=lambda t: (0.5 * load * math.sin(RATE * t), -load * (1.0 - 0.4 * math.cos(RATE * t))),
    )


# Configurations with a sharp impact or a slender film ring at these steps, which the package says.
@pytest.mark.filterwarnings("ignore::exudyn_ehd.RingingWarning")
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_mixed_effects(seed, tmp_path):
    made = draw(seed)
    scene = rotor(made, seed)
    balances = Balances(scene.joint)
    history = scene.run(2.0 * CYCLE, CYCLE / 100, spectral_radius=0.6).history
    balances.check()
    assert history.time[-1] == pytest.approx(2.0 * CYCLE)
    assert scene.momentum_error(history) < 1e-2
    # the recorded state can be judged, drawn and stored
    assert str(scene.joint.audit())
    scene.joint.save(tmp_path / "history.npz")
    assert np.array_equal(ehd.load_history(tmp_path / "history.npz").force, history.force)
    scene.joint.plot_pressure(path=tmp_path / "pressure.png")
    # a run that is stopped and taken up by a new system
    half = rotor(made, seed)
    half.run(1.0 * CYCLE, CYCLE / 100, spectral_radius=0.6)
    ehd.SaveState(half.mbs, tmp_path / "half.npz")
    again = rotor(made, seed).run(
        1.2 * CYCLE, CYCLE / 100, spectral_radius=0.6, restart=tmp_path / "half.npz", start=CYCLE
    )
    assert np.all(np.isfinite(again.history.force))
    first = history.between(0.0, 1.2 * CYCLE).eccentricity
    assert np.abs(again.history.eccentricity[-1] - first[-1]).max() < 1e-4 * C


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::exudyn_ehd.RingingWarning")
@pytest.mark.parametrize("seed", [1, 5])
def test_mixed_effects_on_a_modal_bush(seed):
    bush = ehd.ModalBush(mesh=MESH, material=STEEL, tolerance=0.2)
    scene = rotor(dataclasses.replace(draw(seed), bush=bush), seed)
    balances = Balances(scene.joint)
    scene.run(1.0 * CYCLE, CYCLE / 100, spectral_radius=0.6)
    balances.check()


@pytest.mark.parametrize("spectral_radius", [0.0, 0.6])
def test_an_iterate_deep_in_a_contact_is_not_taken_for_a_solution(spectral_radius):
    """A tolerance relative to the residual there, 1e16 N, would accept a journal metres beyond its bore."""
    made = ehd.JournalBearing(
        journal_radius=R,
        length=L,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=0.015),
        film=ehd.FiniteLength(n_theta=45, n_z=6),
        cavitation=ehd.ElrodAdams(cavity_pressure=-5e4),
        asperity=ehd.GreenwoodTripp(composite_roughness=ROUGH, composite_modulus=2e10),
    )
    scene = hard_scene.Rotor(
        made, mass=3.0, speed=300.0, position=(0.2 * C, -0.3 * C), velocity=(0.03, -0.02), load=(0.0, -6000.0)
    )
    history = scene.run(2e-3, 2e-4, spectral_radius=spectral_radius).history
    assert history.largest_eccentricity_ratio.max() < 1.2
