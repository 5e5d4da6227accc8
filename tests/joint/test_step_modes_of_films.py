"""Modes of a mass on a film in time: the film's own linear response over one step, with what it remembers.

Generalised alpha as Exudyn has it, and the rates of `exudyn_ehd.joint.time_step`. The mass moves along the
eccentricity, so that no cross stiffness feeds it.
"""

import dataclasses
import math

import numpy as np
import pytest

import exudyn_ehd as ehd
from exudyn_ehd.joint.model.build import build_model
from exudyn_ehd.joint.time_step import WEIGHTS
from tests.sampling import sample

C, SPEED = 25e-6, 300.0
CLOSURES = [
    {"cavitation": ehd.FullSommerfeld()},
    {"cavitation": ehd.Gumbel()},
    {"cavitation": ehd.SwiftStieber()},
    {"cavitation": ehd.ElrodAdams(cavity_pressure=-1e5)},
    {
        "cavitation": ehd.ElrodAdams(),
        "supply": (ehd.AxialGroove(angle=math.pi, width_angle=0.8, length=0.03, pressure=1e5),),
    },
]
LAWS = [
    {},
    {"pressure_law": ehd.BarusPressure(coefficient=2e-8)},
    {"density_law": ehd.DowsonHigginson()},
]
LINER = {"bush": ehd.ElasticLiner(thickness=1e-3, youngs_modulus=2e9, poisson_ratio=0.35)}
RADII = (1.0, 0.9, 0.8, 0.5, 0.0)


class Response:
    """Force along x and memory at the end of a step, by place, rate and memory at its start.

    Attributes
    ----------
    stiffness, damping : float
        Of the joint's tangent.
    place, rate, force : (k,) arrays
        Derivatives of the memory to place and rate, and of the force to the memory.
    kept : (k, k) array
        Of the memory to what it was.
    """

    def __init__(self, model, eccentricity, step):
        self.step = step
        motion = np.zeros(10)
        motion[0], motion[8] = eccentricity * C, SPEED
        memory = model.evaluate_steady(motion).history()
        # voids of cavities and deflections move; what is full stays full
        self.parts = [
            (name, place)
            for name in ("void", "deflection")
            if memory is not None and getattr(memory, name) is not None
            for place in np.argwhere(np.abs(getattr(memory, name)) > 1e-9)
        ]
        if memory is not None and memory.outflow is not None:
            self.parts += [
                ("outflow", (k, *place)) for k in (0, 1, 3) for place in np.argwhere(memory.outflow[0] < 1.0)
            ]

        def ask(move=0.0, rate=0.0, memory=memory):
            at = motion.copy()
            at[[0, 4]] += move, rate
            evaluation = model.evaluate(at, memory, step)
            after = evaluation.history()
            rest = [getattr(after, name)[tuple(place)] for name, place in self.parts]
            return np.array([evaluation.wrench[0], *rest])

        model.evaluate(motion, memory, step)
        tangent = model.evaluate(motion, memory, step).tangent()
        self.stiffness, self.damping = -tangent[0, 0], -tangent[0, 4]
        small = 1e-6 * C
        self.place = (ask(move=small) - ask(move=-small))[1:] / (2.0 * small)
        self.rate = (ask(rate=small * SPEED) - ask(rate=-small * SPEED))[1:] / (2.0 * small * SPEED)
        columns = []
        for name, place in self.parts:
            pair = []
            change = 1e-4 * np.abs(getattr(memory, name)[tuple(place)])
            if name == "outflow":  # fills and their rises, and rates of gaps that are at rest
                change = 1e-4 * memory.outflow[(0, *place[1:])] / (step if place[0] == 1 else 1.0)
            for side in (1.0, -1.0):
                field = getattr(memory, name).copy()
                field[tuple(place)] += side * change
                pair.append(ask(memory=dataclasses.replace(memory, **{name: field})))
            columns.append((pair[0] - pair[1]) / (2.0 * change))
        table = np.array(columns).T if columns else np.zeros((1, 0))
        self.force, self.kept = table[0], table[1:]

    def roots(self, radius, damping, weights):
        """Eigenvalues of a step for a mass ``m = C h / damping``; lengths over C, time over the step."""
        mass, k = self.damping * self.step / damping, len(self.parts)
        alpha_m, alpha_f = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
        gamma = 0.5 - alpha_m + alpha_f
        beta = 0.25 * (gamma + 0.5) ** 2
        unit = np.eye(7 + k)
        (q, v, a, accel), misses, memory = unit[:4], unit[4:7], unit[7:]
        place, speed = q + v + (0.5 - beta) * a, v + (1.0 - gamma) * a
        rate = speed + np.asarray(weights) @ misses
        stiffness = self.stiffness * self.step**2 / mass
        by_memory = self.force * (self.step**2 / (mass * C)) @ memory
        share = (1.0 - alpha_f) / (1.0 - alpha_m)
        a1 = share * (by_memory - stiffness * place - damping * rate) + (alpha_f * accel - alpha_m * a) / (
            1.0 - alpha_m
        )
        a1 = a1 / (1.0 + share * (stiffness * beta + damping * gamma))
        place, speed, rate = place + beta * a1, speed + gamma * a1, rate + gamma * a1
        rows = [place, speed, a1, by_memory - stiffness * place - damping * rate]
        rows += [place - q - 0.5 * (v + speed), *misses[:2]]
        after = C * (np.outer(self.place, place) + np.outer(self.rate, rate) / self.step) + self.kept @ memory
        return np.linalg.eigvals(np.vstack((rows, after)))


def alternating(roots):
    back = roots[(roots.real < 0.0) & (np.abs(roots.imag) < 0.5 * np.abs(roots.real))]
    return np.abs(back).max(initial=0.0)


@pytest.mark.parametrize("seed", sample(range(10), 1))
def test_no_film_rings_by_its_rates(seed):
    """Every closure with and without a liner; law, place and step at random, the mass over nine decades.

    No mode grows; films that remember may feed slow motions of heavy masses, as they do by velocities alone. Of every
    mass alternating modes fade at least as fast as that of the lightest one by velocities alone, by the spectral
    radius.
    """
    rng = np.random.default_rng(seed)
    law = LAWS[rng.integers(3)]
    bearing = ehd.JournalBearing(
        journal_radius=0.025,
        length=0.04,
        radial_clearance=C,
        lubricant=ehd.Lubricant(viscosity=0.02, **law),
        film=ehd.FiniteLength(n_theta=16, n_z=4),
        **CLOSURES[seed % 5],
        **(LINER if seed >= 5 else {}),
    )
    place, turn = rng.uniform(0.2, 0.9), 10.0 ** rng.uniform(1.3, 3.5)
    film = Response(build_model(bearing), place, 2.0 * math.pi / SPEED / turn)
    assert film.damping > 0.0
    for damping in 10.0 ** np.arange(-3.0, 7.0, 1.5):
        for radius in RADII:
            roots, plain = (film.roots(radius, damping, weights) for weights in (WEIGHTS[3], np.zeros(3)))
            fast = np.abs(np.angle(roots)) > (0.3 if film.parts else -1.0)
            assert np.abs(roots[fast]).max(initial=0.0) < 1.0 + 1e-9
            assert np.abs(roots).max() < max(1.0, np.abs(plain).max()) + (1e-5 if film.parts else 1e-9)
            assert alternating(roots) < radius + 1e-6
