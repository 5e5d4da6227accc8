"""`LubricatedJoint`: what a user has of a joint that `CreateLubricatedJoint` made."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import exudyn as exu
import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.coupling.contract import Index
from exudyn_ehd.coupling.element.rigid import FilmElement
from exudyn_ehd.coupling.record.display import FilmDisplay
from exudyn_ehd.coupling.record.history import JointHistory, Quantity
from exudyn_ehd.coupling.record.results import JointResults
from exudyn_ehd.coupling.record.sensors import add_sensor, reader
from exudyn_ehd.coupling.run.joint_state import JointState, bore_modes_of, check_owner, digest
from exudyn_ehd.coupling.watch.solver_state import require_end
from exudyn_ehd.joint.balance.overload import HIGHEST_PEAK
from exudyn_ehd.pictures.units import shown
from exudyn_ehd.status import InputError, require_number

if TYPE_CHECKING:
    from exudyn_ehd.film.surfaces.elastic_liner import ElasticLiner
    from exudyn_ehd.joint.audit.audit import Audit
    from exudyn_ehd.joint.static.equilibrium import EquilibriumResult


class LubricatedJoint(JointResults):
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

    @property
    def history(self) -> JointHistory:
        """All accepted steps up to now as NumPy arrays; a rejected step leaves nothing behind.

        The last row is the end of the last run, during a run the start of the current step. Behind Exudyn's own
        ``mbs.SolveDynamic`` read it before the system's state is changed (a linearisation, Assemble): it is completed
        at this moment. A run that starts at the end of the record goes on with it, e.g. after ``SolveDynamic(...,
        updateInitialValues=True)``; any other starts a new one, also a run at that time from the old initial values. A
        last state without a film is left out, and a warning says why.

        What the film remembers follows the state, not the record: see `forget`.
        """
        return self.element.steps.history(self.mbs, complete=self.element.presence.found(self.mbs) is not None)

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

    def state(self) -> JointState:
        """What the joint knows besides Exudyn's coordinates at the last accepted state: memory of the film, and record.

        See `SaveState` for the whole system.
        """
        if not self.mbs.systemIsConsistent:
            raise InputError(
                f"LubricatedJoint.state: the system of joint '{self.name}' is not assembled; call mbs.Assemble() first."
            )
        self.element.require_items(self.mbs)
        require_end("LubricatedJoint.state", self.mbs, self.element.steps.solver)
        time, memory, begin, rows = self.element.steps.remembered(self.mbs)
        return JointState(
            name=self.name,
            bearing=digest(self.bearing),
            time=time,
            memory=memory,
            rows=rows,
            begin=begin,
            modes=bore_modes_of(self.element),
        )

    def forget(self) -> None:
        """Let the next run start with a new record and a new film: full of oil, not worn, at its first temperature.

        Without it what a film remembers follows the state: a run that starts where the last one has ended goes on with
        the film of its end, at whatever time and with static solves in between; a run that starts where the last one
        has started has the film of its start. At any other state the film of the last end goes on, with a
        `MemoryWarning`.
        """
        self.element.steps.forget()

    def stop_at(self, *, force: float = math.inf, pressure: float = HIGHEST_PEAK) -> None:
        """End runs with a `FilmError` at the first accepted step whose film exceeds a limit of yours.

        Without it runs end where the film is none: pressures beyond 3 GPa, which neither oil nor steel bears
        (`SolveDynamic` and `SolveDynamicSparse` try smaller steps first), rigid surfaces pressed through each other by
        more than the clearance, forces that alternate at many times what they move and carry. Steps with more than
        1 GPa on the projected area, or with more than 3 GPa where you allow them, give an `OverloadWarning`.

        Parameters
        ----------
        force : float
            Largest force of film and contact, N.
        pressure : float
            Largest peak pressure of the film, and mean pressure of film and contact on the projected area, Pa;
            `math.inf` allows any.
        """
        for name, value, unit in (("force", force, "N"), ("pressure", pressure, "Pa")):
            if value != math.inf:
                require_number(f"LubricatedJoint.stop_at.{name}", value, unit, above=0.0)
        failures = self.element.failures
        failures.largest_force, failures.largest_pressure = force, pressure

    def restore_state(self, state: JointState) -> None:
        """Let the next run go on with the memory of a state, and with its record if it starts at its time.

        `SolveDynamic` does it with ``restart``.

        Raises
        ------
        InputError
            If the state is of another joint or bearing.
        """
        check_owner(self, state)
        self.element.steps.resume(state.time, state.memory, state.rows, state.begin)

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
        write = bool(fileName) if writeToFile is None else writeToFile
        self.element.require_items(self.mbs)
        return add_sensor(self.mbs, self.element, read, name or f"{self.name} {title}", fileName, write)
