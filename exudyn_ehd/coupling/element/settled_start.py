"""Flexible bores start in equilibrium with the films of the initial configuration; several on one body together."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import exudyn as exu
import numpy as np

from exudyn_ehd.coupling.contract import Side
from exudyn_ehd.coupling.items.item import Item
from exudyn_ehd.coupling.items.reduced_bodies import FloatingBoreSide
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.joint.bore.equilibrium import Elasticity, bore_equilibrium
from exudyn_ehd.joint.bore.shapes import Bore, ModalBore
from exudyn_ehd.joint.model.build import collect_effects
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation, TurningModel
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.status import Status

# Name in mbs.variables of the films on every body, by the number of its modal node
_BODIES = "lubricatedBodies"


@dataclasses.dataclass(frozen=True)
class StartingFilm:
    """A film on its bore, the motion (10,) at which it starts, and what it remembers there."""

    model: ElasticBearingModel
    motion: np.ndarray
    memory: History | None

    def at(self, part: float, bore: np.ndarray) -> ElasticEvaluation:
        """The film with the pose scaled by ``part`` and the bore's coordinates and rates (2 k,)."""
        motion = np.concatenate((self.motion, bore))
        motion[:4] *= part
        return self.model.evaluate(motion, self.memory)


@dataclasses.dataclass(frozen=True)
class FilmsOnOneBody:
    """Films on bores of one body, whose modes they share, as `bore_equilibrium` takes them.

    The first number of the motion is the part of all poses.
    """

    films: list[StartingFilm]

    @property
    def bore(self) -> Bore:
        """One of the bores; all have the same coordinates."""
        return self.films[0].model.bore

    @property
    def elasticity(self) -> Elasticity:
        """That of the body."""
        return self.films[0].model.elasticity

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> FilmsTogether:
        """All films at a motion (10 + 2 k,)."""
        return FilmsTogether([film.at(float(motion[0]), motion[MOTION_SIZE:]) for film in self.films])


@dataclasses.dataclass(frozen=True)
class FilmsTogether:
    """Evaluations of films on one body."""

    parts: list[ElasticEvaluation]

    @property
    def status(self) -> Status:
        """The first that is not `Status.CONVERGED`."""
        return next((part.status for part in self.parts if part.status is not Status.CONVERGED), Status.CONVERGED)

    @property
    def bore(self) -> BoreState:
        """Coordinates, and the sum of the loads."""
        return self.parts[0].bore._replace(load=np.sum([part.bore.load for part in self.parts], axis=0))

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """Sum of the films' tangents to the bores' coordinates."""
        return np.sum([part.combined_tangent(by_place, by_rate) for part in self.parts], axis=0)


def initial_coordinates(model: ElasticBearingModel, sides: tuple[Side, Side]) -> np.ndarray | None:
    """Coordinates (k,) of the bore in equilibrium with the film of the initial configuration, None if there is none.

    The sides' frames must be those of the initial configuration. A film that conserves mass starts flooded, and a
    flooded film's first instant is Swift-Stieber's; with a heat balance it has the temperature that the run starts at.
    The modes of a finite-element journal are where the scene has put them.
    """
    if isinstance(model, TurningModel):
        return None
    return _equilibrium([_starting_film(model, sides, model.make_bore)])


def undeformed(mbs: exu.MainSystem, housing: Item, side: FloatingBoreSide) -> Item:
    """The housing with its modes at rest, if they are where an earlier joint's film has put them."""
    node = side.nodes[-1]
    known = _known(mbs, side)
    if not known or not np.array_equal(mbs.GetNodeParameter(node, "initialCoordinates"), known[1]):
        return housing
    initial = np.array(housing.initial_coordinates, dtype=float)
    initial[side.floating.size :] = 0.0
    return dataclasses.replace(housing, initial_coordinates=initial)


def settle_body(mbs: exu.MainSystem, model: ElasticBearingModel, sides: tuple[Side, Side]) -> None:
    """Let the modes of a reduced body start in equilibrium with all of its films, unless the scene has set them.

    The body's frame is held; the sides' frames are those of the undeformed body.
    """
    bush, side = model.bearing.bush, sides[0]
    assert isinstance(bush, ReducedBore) and isinstance(side, FloatingBoreSide)
    node, known = side.nodes[-1], _known(mbs, side)
    present = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
    if not bush.settled or (present.any() and not (known and np.array_equal(present, known[1]))):
        return
    held = bush.held()
    films = [*(known[0] if known and present.any() else []), _starting_film(model, sides, lambda g: ModalBore(held, g))]
    start = _equilibrium(films)
    if start is not None:
        mbs.SetNodeParameter(node, "initialCoordinates", start.tolist())
        put = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
        mbs.variables.setdefault(_BODIES, {})[int(node)] = films, put


def _known(mbs: exu.MainSystem, side: FloatingBoreSide) -> tuple[list[StartingFilm], np.ndarray] | None:
    """Films that have settled a body before, and where they have put it."""
    return mbs.variables.get(_BODIES, {}).get(int(side.nodes[-1]))


def _starting_film(
    model: ElasticBearingModel, sides: tuple[Side, Side], make_bore: Callable[[FilmGrid], Bore]
) -> StartingFilm:
    """The film of a model on another bore at the sides' frames."""
    bearing = model.bearing
    if bearing.cavitation.conserves_mass:
        closure = SwiftStieber(cavity_pressure=bearing.cavitation.cavity_pressure)
        bearing = dataclasses.replace(bearing, cavitation=closure)
    film = ElasticBearingModel(bearing, make_bore, elasticity=model.elasticity, effects=collect_effects(bearing))
    motion = np.empty(MOTION_SIZE)
    relative.relative_motion(sides[0].frame, sides[1].frame, motion)
    return StartingFilm(film, motion, film.initial_history(motion))


def _equilibrium(films: list[StartingFilm]) -> np.ndarray | None:
    """Coordinates (k,) of the bores in equilibrium with their films, None if there is none."""
    if len(films) == 1:
        settled = films[0].model.evaluate_steady(films[0].motion, films[0].memory)
        return settled.bore.coordinates.copy() if settled.status is Status.CONVERGED else None
    together = FilmsOnOneBody(films)
    found = bore_equilibrium(together, np.ones(MOTION_SIZE), (None, 0.0, 0.0), np.zeros(together.bore.size))[0]
    return None if found is None else found.bore.coordinates.copy()
