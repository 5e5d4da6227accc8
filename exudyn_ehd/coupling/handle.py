"""`LubricatedJoint`: what a user has of a joint that `CreateLubricatedJoint` made."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.display import FilmDisplay
from exudyn_ehd.coupling.record.history import Quantity
from exudyn_ehd.coupling.record.results import JointResults
from exudyn_ehd.coupling.record.sensors import reader
from exudyn_ehd.coupling.run.joint_state import Joint
from exudyn_ehd.pictures.units import shown
from exudyn_ehd.status import InputError

if TYPE_CHECKING:
    from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
    from exudyn_ehd.joint.audit.audit import Audit
    from exudyn_ehd.joint.static.equilibrium import EquilibriumResult


class LubricatedJoint(Joint, JointResults):
    """Handle of one lubricated joint.

    Attributes
    ----------
    name : str
        Its name.
    mbs : exudyn.MainSystem
        The system it belongs to.
    bearing : object
        What was given as bearing.
    objectNumber : exudyn.ObjectIndex
        The film element.
    constraintNumber : exudyn.ObjectIndex or None
        The constraint of what is `Held`.
    element : FilmElement
        The film between the two frames.
    display : FilmDisplay
        The film in Exudyn's renderer.
    bush : FlexibleBush or None
        The nodal bush, if the bearing has one.

    Examples
    --------
    After the example of `CreateLubricatedJoint`:

    >>> joint
    <LubricatedJoint 'main': object 2, journal 50 mm x 25 mm, clearance 25 µm>
    >>> sensor = joint.AddSensor("minimum_gap")
    >>> joint.record_films(period=1e-3)
    """

    def __init__(
        self,
        mbs: exu.MainSystem,
        name: str,
        element: FilmElement,
        display: FilmDisplay,
        numbers: tuple[Index, Index | None],
    ) -> None:
        self.mbs = mbs
        self.name = name
        self.element: FilmElement = element
        self.display = display
        self.bearing = element.model.bearing
        self.objectNumber, self.constraintNumber = numbers
        bush = getattr(element, "bush", None)
        # the element's own does not keep the system alive
        self.bush = None if bush is None else dataclasses.replace(bush, mbs=mbs)

    def __repr__(self) -> str:
        b = self.bearing
        size = (
            ""
            if not isinstance(b, JournalBearing)
            else (
                f", journal {shown('length', 2.0 * b.journal_radius)} x {shown('length', b.length)}, "
                f"clearance {shown('length', b.radial_clearance)}"
            )
        )
        return f"<LubricatedJoint '{self.name}': object {int(self.objectNumber)}{size}>"

    def place_in_equilibrium(
        self, *, load: Sequence[float] | np.ndarray, speed: float | None = None
    ) -> EquilibriumResult:
        """Let the next run start where the film carries a steady load, with the film in its steady state.

        The journal's node is moved sideways, its tilt stays; the journal starts at rest against the housing except for
        its spin. Temperature, oil content and modal bush start settled. For a body in one film; rotors in several start
        from `SolveEquilibrium`, and loads that depend on the place settle in a static solve (`SolveStatic`).

        Parameters
        ----------
        load : (2,) [N]
            Force on the journal in the joint's x and y that the film has to carry: what acts on its body, with inertia.
        speed : float, optional
            Relative spin, rad/s; by default that of the initial state.

        Returns
        -------
        EquilibriumResult

        Raises
        ------
        InputError
            For a joint that does not turn, without a system assembled, or a journal that is not a rigid body.
        FilmError
            If no equilibrium was found.
        """
        from exudyn_ehd.coupling.run.equilibrium_start import place

        self.element.require_items(self.mbs)
        return place(self.mbs, self.element, self.name, load, speed)

    def audit(self, *, liner: ElasticLiner | None = None, measure_time: bool = False) -> Audit:
        """Which effects mattered in the accepted steps, which were left out, which were without effect.

        The films at the worst recorded states (minimum film thickness, highest pressure, loss, speed, tilt, squeeze)
        are evaluated again, on a model of their own: the joint is not touched. What the record holds counts as
        recorded; what it takes a field for (cavitated share, grid, heat of a field) is that of a flexible bore settled
        under the film.

        Parameters
        ----------
        liner : ElasticLiner, optional
            Of which to say whether its elasticity would matter; for bearings without one.
        measure_time : bool
            Measure the share of the time that every effect takes which is on.

        Returns
        -------
        Audit
            Print it for a table; ``neglected`` and ``unneeded`` hold what to change.

        Raises
        ------
        InputError
            Before anything was recorded, and of a thinned record (`Every`, `Period`).
        """
        history = self.history
        if history.time.size == 0:
            raise InputError(
                f"LubricatedJoint.audit: joint '{self.name}' has no accepted steps yet; run a solver first."
            )
        if history.is_thinned:
            raise InputError(
                f"LubricatedJoint.audit: joint '{self.name}' keeps {history.time.size} of {history.step_count[-1] + 1} "
                "states, and forces that ring, heat and films that remember need every step: audit a shorter run "
                "without Every or Period, e.g. one that goes on from ehd.SaveState in a model without them."
            )
        from exudyn_ehd.joint.audit.audit import audit_record
        from exudyn_ehd.joint.audit.samples import RecordedSteps

        names = [field.name for field in dataclasses.fields(RecordedSteps)]
        record = RecordedSteps(**{name: getattr(history, name) for name in names})
        return audit_record(self.bearing, record, liner=liner, measure_time=measure_time)

    def AddSensor(
        self,
        quantity: Quantity | exu.OutputVariableType | str,
        *,
        fileName: str = "",
        name: str = "",
        writeToFile: bool | None = None,
    ) -> Index:
        """Add an Exudyn sensor of one quantity, e.g. for ``mbs.PlotSensor`` and ``mbs.GetSensorStoredData``.

        Parameters
        ----------
        quantity : Quantity, exudyn.OutputVariableType or str
            What to record. Of the film, by its name in `JointHistory` too; vectors are in the joint frame, loads act on
            the journal. Or what Exudyn's joints give, as of one with the markers [housing, journal], of film and
            constraint together: ForceLocal, TorqueLocal, DisplacementLocal, VelocityLocal, Rotation (Tait-Bryan
            angles), AngularVelocityLocal in the housing's joint frame, Force, Torque, Displacement, AngularVelocity
            global, Position and Velocity of the housing's joint point, HomogeneousTransformation,
            HomogeneousTransformationLocal. Loads are then those that the journal hands on to the housing, torques are
            about the bearing's centre.
        fileName : str
            File to write to, as in Exudyn's sensors.
        name : str
            Name of the sensor; by default joint and quantity.
        writeToFile : bool, optional
            By default whether a file name is given; the values are stored in the sensor in any case.

        Returns
        -------
        exudyn.SensorIndex
        """
        title, read = reader(self.element, self.constraintNumber, quantity)
        return self._add_sensor(title, read, fileName, name, writeToFile)
