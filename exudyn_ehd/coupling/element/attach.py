"""Create the items of a flexible bush in an Exudyn system, and the film element of any joint.

Flexible bores start in equilibrium with the films of the initial configuration. Several bores on one body are brought
into equilibrium together.
"""

from __future__ import annotations

import dataclasses

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from scipy.linalg import block_diag

from exudyn_ehd.coupling.contract import Index, NodeIndex, Side
from exudyn_ehd.coupling.element.nodal import ModalFilmElement, NodalFilmElement, TurningFilmElement
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.items.beams import node_coordinates
from exudyn_ehd.coupling.items.bodies import Item
from exudyn_ehd.coupling.items.bush import add_bush
from exudyn_ehd.coupling.items.objects import own_equations, require_heavy_housing
from exudyn_ehd.coupling.items.reduced_bodies import FloatingBoreSide, initial_frame
from exudyn_ehd.coupling.kinematics import relative
from exudyn_ehd.film.cavitation.closures import SwiftStieber
from exudyn_ehd.joint.bore.equilibrium import Elasticity, bore_equilibrium
from exudyn_ehd.joint.bore.shapes import Bore, ModalBore
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.build import TurningModel
from exudyn_ehd.joint.model.effects import collect_effects
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, ElasticEvaluation
from exudyn_ehd.joint.solved_film import MOTION_SIZE, BoreState, History
from exudyn_ehd.joint.thrust import ThrustModel
from exudyn_ehd.solid.bush import ANCFBush
from exudyn_ehd.solid.fe_bore import ReducedBore
from exudyn_ehd.solid.loads import Gravity
from exudyn_ehd.status import InputError, Status

# Period over 2 pi of a mode with its numerical mass, over the journal's radius, s/m: a thousandth of the travel time of
# sound over the radius. Larger: the numerical mass affects the motion.
NUMERICAL_PERIOD = 2e-7
# Name in mbs.variables of the films on every body, by the number of its modal node
_BODIES = "lubricatedBodies"


def attach_bush(
    mbs: exu.MainSystem,
    model: ElasticBearingModel,
    items: tuple[Item, Item],
    sides: tuple[Side, Side],
    place: tuple[np.ndarray, np.ndarray],
    name: str,
    show: bool,
    gravity: np.ndarray | None,
) -> tuple[FilmElement, dict[str, object]]:
    """Add the bush of ``model``.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    model : ElasticBearingModel
    items, sides : pairs
        Housing and journal; the sides are updated to the initial configuration.
    place : ndarray (3,), ndarray (3, 3)
        Joint point and joint frame in the reference configuration, global.
    name : str
        Name of the joint.
    show : bool
        Draw the bush.
    gravity : ndarray (3,) or None
        Gravity of a nodal bush whose mass counts in addition to the housing's [m/s^2]; None: the housing contains the
        bush.

    Returns
    -------
    element : FilmElement
        Film element on the bush.
    arguments : dict
        Further arguments of the element's ObjectGenericODE2, without nodes and functions.
    """
    for side in sides:
        state = undeformed(mbs, side) if isinstance(side, FloatingBoreSide) else None
        side.frame[:] = initial_frame(mbs, side, state)
    if not isinstance(model.bore, ModalBore):
        return _attach_nodes(mbs, model, items[0], sides, place, name, show, gravity), {}
    if gravity is not None:
        raise InputError(
            f"CreateLubricatedJoint.bushGravity: mass and weight of the {type(model.bearing.yielding).__name__} of "
            f"joint '{name}' are its body's; leave it out, and let the body's mass and loads contain them."
        )
    # finite-element bodies have nodes, mass and stiffness for the modes
    if isinstance(model, TurningModel):
        nodes = _settle_body(mbs, model, sides, items[1], sides[1], model.turning.surface)
        return TurningFilmElement(model, *sides, nodes, name, model.turning), {}
    if isinstance(sides[0], FloatingBoreSide):
        nodes = _settle_body(mbs, model, sides, items[0], sides[0], model.bore.modes)
        return ModalFilmElement(model, *sides, nodes, name, model.bore), {}
    settled = initial_coordinates(model, sides)
    k = model.bore.size
    node = mbs.AddNode(
        eii.NodeGenericODE2(
            name=f"{name} bush modes",
            referenceCoordinates=[0.0] * k,
            initialCoordinates=[0.0] * k if settled is None else settled.tolist(),
            initialCoordinates_t=[0.0] * k,
            numberOfODE2Coordinates=k,
        )
    )
    element = ModalFilmElement(model, *sides, [node], name, model.bore)
    element.is_massless = True
    # numerical mass, too small to have an effect: without it Exudyn cannot compute initial accelerations of the system
    mass = np.diag(element.stiffness * (NUMERICAL_PERIOD * model.bearing.journal_radius) ** 2)
    # not the sides' sizes: those of markers are known after Assemble only
    rigid = sum(len(mbs.GetNodeParameter(node, "referenceCoordinates")) for side in sides for node in side.nodes)
    return element, {"massMatrix": block_diag(np.zeros((rigid, rigid)), mass)}


def _attach_nodes(
    mbs: exu.MainSystem,
    model: ElasticBearingModel,
    item: Item,
    sides: tuple[Side, Side],
    place: tuple[np.ndarray, np.ndarray],
    name: str,
    show: bool,
    gravity: np.ndarray | None,
) -> NodalFilmElement:
    solid = model.bearing.bush
    assert isinstance(solid, ANCFBush)
    mount = (sides[0], place[0]) if sides[0].nodes else None
    weight = [] if gravity is None else [Gravity(acceleration=gravity)]
    contained = mount is not None and gravity is None
    bush = add_bush(
        mbs, f"{name} bush", solid, mount, place, contained=contained, fixed=mount is None, show=show, loads=weight
    )
    if bush.equations.contained is not None:
        require_heavy_housing(mbs, item, bush.equations.contained.mass, name)
    if initial_coordinates(model, sides) is not None:
        assert isinstance(model.elasticity, SolidElasticity)
        u = model.elasticity.displacements @ sides[0].frame[:, :3].T
        for number, shift in zip(bush.nodeNumbers, u):
            if number >= 0 and shift.any():
                node = NodeIndex(int(number))
                initial = np.array(mbs.GetNodeParameter(node, "initialCoordinates")) + shift
                mbs.SetNodeParameter(node, "initialCoordinates", initial.tolist())
    nodes = [NodeIndex(int(i)) for i in bush.nodeNumbers[bush.mesh.bore.nodes]]
    return NodalFilmElement(model, *sides, nodes, name, bush)


@dataclasses.dataclass(frozen=True)
class StartingFilm:
    """A film on its bore, with its initial motion (10,), initial angle of the journal, and initial memory."""

    model: ElasticBearingModel
    motion: np.ndarray
    memory: History | None
    spin: float


@dataclasses.dataclass
class FilmsOnOneBody:
    """Films on bores of one body, which have the same modes, with the interface that `bore_equilibrium` needs.

    The first number of the motion is the fraction of all poses. ``bore`` is one of the bores, which all have the same
    coordinates. ``elasticity`` is that of the body, with centrifugal growth if the first film is on a journal.
    """

    films: list[StartingFilm]
    bore: Bore
    elasticity: Elasticity

    def evaluate(
        self, motion: np.ndarray, history: History | None = None, step: float = 0.0, spin: float = 0.0
    ) -> FilmsTogether:
        """Evaluate all films at a motion (10 + 2 k,)."""
        scale = np.ones(motion.size)
        scale[:4] = motion[0]
        motions = [scale * np.concatenate((film.motion, motion[MOTION_SIZE:])) for film in self.films]
        parts = [f.model.evaluate(own, f.memory, 0.0, f.spin) for f, own in zip(self.films, motions, strict=True)]
        bore = parts[0].bore._replace(load=np.sum([part.bore.load for part in parts], axis=0))
        return FilmsTogether(parts, max(part.status for part in parts), bore)


@dataclasses.dataclass
class FilmsTogether:
    """Evaluations of films on one body, with the worst status, the body's coordinates and the sum of the loads."""

    parts: list[ElasticEvaluation]
    status: Status
    bore: BoreState

    def combined_tangent(self, by_place: float, by_rate: float) -> np.ndarray:
        """Sum of the films' tangents to the bores' coordinates."""
        return np.sum([part.combined_tangent(by_place, by_rate) for part in self.parts], axis=0)


def initial_coordinates(model: ElasticBearingModel, sides: tuple[Side, Side]) -> np.ndarray | None:
    """Coordinates (k,) of the bore in equilibrium with the film of the initial configuration; None without one.

    The sides' frames must be those of the initial configuration. A film that conserves mass starts flooded, and at its
    first instant it equals a Swift-Stieber film. A film with a heat balance has the initial temperature of the run.
    The modes of a finite-element journal are those of its body, see `_settle_body`.
    """
    return None if isinstance(model, TurningModel) else _equilibrium([_starting_film(model, sides)])


def undeformed(mbs: exu.MainSystem, side: FloatingBoreSide) -> tuple[np.ndarray, np.ndarray]:
    """Initial q and q_t of a body; modes that films of earlier joints have set are undeformed and at rest."""
    (_, q, q_t), known, n = node_coordinates(mbs, side.nodes), _known(mbs, side), side.floating.size
    if known and np.array_equal(q[n:], known[1]):
        q[n:] = q_t[n:] = 0.0
    return q, q_t


def _settle_body(
    mbs: exu.MainSystem,
    model: ElasticBearingModel,
    sides: tuple[Side, Side],
    item: Item,
    side: Side,
    surface: object,
) -> list[Index]:
    """Let the modes of a reduced body start in equilibrium with all of its films, unless the model has set them.

    The body's frame is fixed; the sides' frames are those of the undeformed body. The initial state of a journal that
    turns includes centrifugal growth, and its shape is at rest in the joint's frame. The body gets its exact Jacobian,
    unless the model keeps Exudyn's or the body has user functions.

    Returns
    -------
    list
        The node of the modes.
    """
    assert isinstance(surface, ReducedBore) and isinstance(side, FloatingBoreSide) and item.body is not None
    if surface.exact_jacobian and mbs.GetObjectParameter(item.body, "computeFFRFterms"):
        own_equations(mbs, item.body)
    node, known = side.nodes[-1], _known(mbs, side)
    present = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
    others = known[0] if known and np.array_equal(present, known[1]) else []
    if not surface.settled or (present.any() and not others):
        return [node]
    films = [*others, _starting_film(model, sides, surface.held())]
    # films on journals first, because the first film decides about centrifugal growth
    films.sort(key=lambda film: not isinstance(film.model, TurningModel))
    if (start := _equilibrium(films)) is not None:
        mbs.SetNodeParameter(node, "initialCoordinates", start.tolist())
        mbs.SetNodeParameter(node, "initialCoordinates_t", _standing_rates(films, start).tolist())
        put = np.array(mbs.GetNodeParameter(node, "initialCoordinates"))
        mbs.variables.setdefault(_BODIES, {})[int(node)] = films, put
    return [node]


def _known(mbs: exu.MainSystem, side: FloatingBoreSide) -> tuple[list[StartingFilm], np.ndarray] | None:
    """Films of earlier joints on a body, and the coordinates of the equilibrium that they have set."""
    return mbs.variables.get(_BODIES, {}).get(int(side.nodes[-1]))


def _starting_film(
    model: ElasticBearingModel, sides: tuple[Side, Side], held: ReducedBore | None = None
) -> StartingFilm:
    """Initial film of a model at the sides' frames, on its own bore or on that of a body with a fixed frame."""
    bearing, film = model.bearing, model
    if bearing.cavitation.conserves_mass:
        closure = SwiftStieber(cavity_pressure=bearing.cavitation.cavity_pressure)
        bearing = dataclasses.replace(bearing, cavitation=closure)
    effects = collect_effects(bearing)
    if held is not None and isinstance(model, TurningModel):
        journal = dataclasses.replace(model.turning, surface=held)
        film = TurningModel(bearing, journal, effects=effects)
        film.turns = False
        spin = float(sides[1].frame[:, 2] @ sides[1].frame[:, 5])
        film.elasticity = Elasticity(held.stiffness_matrix, spin**2 * journal.mass)
    else:
        make = model.make_bore if held is None else lambda grid: ModalBore(held, grid)
        film = ElasticBearingModel(bearing, make, elasticity=model.elasticity, effects=effects)
    frames = sides[0].frame, sides[1].frame
    motion = relative.motion_of(*frames)
    known = film.initial_history(motion)
    # without pressures of supply areas: they are found in balance with the bore
    memory = None if known is None else dataclasses.replace(known, pockets=None)
    return StartingFilm(film, motion, memory, relative.angle_of(*frames))


def _equilibrium(films: list[StartingFilm]) -> np.ndarray | None:
    """Coordinates (k,) of the bores in equilibrium with their films; None without one."""
    first = films[0]
    if len(films) == 1:
        settled = first.model.evaluate_steady(first.motion, first.memory, 0.0, first.spin)
        return settled.bore.coordinates.copy() if settled.status is Status.CONVERGED else None
    together = FilmsOnOneBody(films, first.model.bore, first.model.elasticity)
    found = bore_equilibrium(together, np.ones(MOTION_SIZE), (None, 0.0, 0.0), np.zeros(first.model.size))[0]
    return None if found is None else found.bore.coordinates.copy()


def _standing_rates(films: list[StartingFilm], q: np.ndarray) -> np.ndarray:
    """Rates (k,) that keep shapes of turning journals at rest in space as far as possible: T q_t = -omega D T q."""
    turning = [(f.model.turning, f) for f in films if isinstance(f.model, TurningModel)]
    if not turning:
        return np.zeros_like(q)
    maps = [journal.map(film.spin) for journal, film in turning]
    # centrifugal growth turns with the journal and has no rate
    elasticity = turning[0][1].model.elasticity
    q = q - np.linalg.solve(elasticity.stiffness, elasticity.load)
    carried = [film.motion[8] * journal.turned(T @ q) for (journal, film), T in zip(turning, maps, strict=True)]
    return np.asarray(np.linalg.lstsq(np.concatenate(maps), -np.concatenate(carried), rcond=1e-6)[0])


def add_faces(mbs: exu.MainSystem, element: FilmElement, offset: float) -> None:
    """Add the films on the end faces of its bearing to an element.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    element : FilmElement
    offset : float
        Distance of the joint points along the axis in the reference configuration, m.

    Raises
    ------
    InputError
        If the journal starts outside its faces.
    """
    element.faces, element.collars = ThrustModel(element.model.bearing), relative.collar_kinematics(offset)
    start = element.faces.evaluate(element.collars.motion_of(*(initial_frame(mbs, side) for side in element.sides)))
    start.tangent()
    if start.status is not Status.CONVERGED:
        _, _, bx, by, *_, place = start.motion
        raise InputError(
            f"CreateLubricatedJoint: the journal is outside the thrust faces of '{element.failures.name}' in the "
            f"initial configuration: axial position {place:.6g} m, tilt ({bx:.3g}, {by:.3g}), smallest gap "
            f"{start.minimum_gap:.6g} m; check the initial positions, and whether the clearance is that of one face."
        )
