"""From the description of a bush, of an elastic journal or of both to a bearing model with flexible surfaces."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.film.grid import FilmGrid
from exudyn_ehd.joint.bore.equilibrium import Elasticity
from exudyn_ehd.joint.bore.shapes import Bore, ModalBore, NodalBore
from exudyn_ehd.joint.bore.solid import SolidElasticity
from exudyn_ehd.joint.model.flexible import ElasticBearingModel, TurningModel
from exudyn_ehd.joint.seams import Effects
from exudyn_ehd.solid.bush import ANCFBush, ModalBush
from exudyn_ehd.solid.fe_bore import FEBore, ReducedBore
from exudyn_ehd.solid.journal.modes import journal_modes
from exudyn_ehd.solid.journal.turning import FEJournal, TurningJournal
from exudyn_ehd.solid.modes.static import bore_modes
from exudyn_ehd.status import InputError


def elastic_model(bearing: JournalBearing, start_angle: float, effects: Effects) -> ElasticBearingModel:
    """Model of a bearing with a ``bush`` or a ``journal``."""
    bush = bearing.bush
    if isinstance(bush, FEBore):
        raise InputError(
            "JournalBearing.bush=FEBore(...) takes its modes from the body that is the joint's housing: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[0]; for other bodies, and for a bearing by "
            "itself, take a ModalBush(...)."
        )
    if isinstance(bearing.journal, FEJournal):
        raise InputError(
            "JournalBearing.journal=FEJournal(...) takes its modes from the body that is the joint's journal: give "
            "CreateLubricatedJoint an ObjectFFRFreducedOrder as itemNumbers[1]; for other bodies, and for a bearing by "
            "itself, take an ElasticJournal(...)."
        )
    if isinstance(bearing.journal, TurningJournal):
        return TurningModel(bearing, bearing.journal, start_angle, effects)
    bore, elasticity = _bore_and_elasticity(bearing)
    return ElasticBearingModel(bearing, bore, elasticity=elasticity, start_angle=start_angle, effects=effects)


def _bore_and_elasticity(bearing: JournalBearing) -> tuple[Callable[[FilmGrid], Bore], Elasticity]:
    """A function that makes the bore on a film's grid, and what resists its coordinates."""
    bush, pin = bearing.bush, bearing.journal
    if isinstance(bush, ModalBush | None):
        modes = None if bush is None else bore_modes(bush)
        journal = None if pin is None else journal_modes(pin, bearing.journal_radius, bearing.length)
        stiffness = np.concatenate([part.stiffness for part in (modes, journal) if part is not None])
        return lambda grid: ModalBore(modes, grid, journal), Elasticity(lambda: np.diag(stiffness))
    if isinstance(bush, ReducedBore):
        return lambda grid: ModalBore(bush, grid), Elasticity(lambda: bush.stiffness_matrix)
    assert isinstance(bush, ANCFBush)
    mesh = bush.build_mesh()
    return lambda grid: NodalBore(mesh.bore, grid), SolidElasticity(bush.solid(mesh))
