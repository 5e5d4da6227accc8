"""The films on the end faces at a prescribed position of the journal."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from exudyn_ehd.bearing import JournalBearing
from exudyn_ehd.joint.thrust import ThrustEvaluation, ThrustModel
from exudyn_ehd.pictures.records import shown
from exudyn_ehd.status import InputError


@dataclass(frozen=True, eq=False, kw_only=True)
class ThrustResult:
    """Films on the end faces at one position of the journal; vectors on the journal, in the joint frame.

    Attributes
    ----------
    axial_position : float
        Of the journal's centre, m.
    force, moment : (3,) arrays
        N and Nm, moment about the joint's origin.
    axial_force, friction_torque : float
        N along z; Nm about the bearing's axis.
    axial_stiffness, axial_damping : float
        -dF/dz, N/m, and -dF/dw, N s/m. Plane faces at rest that rupture carry where they close only: in the middle of
        two equal faces the damping is that of one, elsewhere it is nan, as both ways of the journal differ.
    minimum_gap, peak_pressure, power_loss, contact_load : float
        m, Pa, W, N, of all faces.
    edge_pressures : (k,) array
        Pa at the inner radius of every face, the lower one first.
    inflow, outflow : (k,) arrays
        m3/s that every face takes in at its inner radius, and gives away at its outer one.
    theta, r : (n,), (m,) arrays
        Grid, rad and m.
    pressure, gap : (k, n, m) arrays
        Of every face, Pa (gauge) and m; the lower one first. On edges of pads the gap is the mean of both sides.
    tangent : (6, 11) array
        Derivative of force and moment to the motion (`exudyn_ehd.joint.solved_film`) and the axial position, SI units.
        Of plane faces at rest it is the mean of both ways.

    Examples
    --------
    After the example of `ThrustFaces`:

    >>> print(film.faces)
    <ThrustResult: axial force -3.93 kN, minimum film thickness 20 µm, peak pressure 2.93 MPa, power loss 578 W>
    >>> film.faces.pressure.shape  # faces, theta, r
    (2, 136, 15)
    """

    axial_position: float
    force: np.ndarray
    moment: np.ndarray
    axial_force: float
    friction_torque: float
    axial_stiffness: float
    axial_damping: float
    minimum_gap: float
    peak_pressure: float
    power_loss: float
    contact_load: float
    edge_pressures: np.ndarray
    inflow: np.ndarray
    outflow: np.ndarray
    theta: np.ndarray = field(repr=False)
    r: np.ndarray = field(repr=False)
    pressure: np.ndarray = field(repr=False)
    gap: np.ndarray = field(repr=False)
    tangent: np.ndarray = field(repr=False)

    def __repr__(self) -> str:
        gap, peak = shown("length", self.minimum_gap), shown("pressure", self.peak_pressure)
        force, loss = shown("force", self.axial_force), shown("power", self.power_loss)
        film = f"minimum film thickness {gap}, peak pressure {peak}, power loss {loss}"
        return f"<ThrustResult: axial force {force}, {film}>"


def faces_at(bearing: JournalBearing, motion: np.ndarray, where: str) -> ThrustResult:
    """Films on the faces of a bearing with ``thrust`` at a motion (11,); `FilmError` if there are none."""
    found = ThrustModel(bearing).evaluate(motion)
    found.require_film(where)
    return result_of(found, found.tangent())


def require_faces(bearing: JournalBearing, where: str, **arguments: float | None) -> None:
    """Refuse arguments that only faces give a meaning to, of a bearing without them."""
    given = [f"{name} = {value!r}" for name, value in arguments.items() if value]
    if bearing.thrust is None and given:
        raise InputError(
            f"{where}: {', '.join(given)}: axial_position is that between the faces of "
            "JournalBearing.thrust=ThrustFaces(...), which the bearing does not have; without faces nothing depends on "
            "it, and nothing carries along the axis."
        )


def result_of(found: ThrustEvaluation, tangent: np.ndarray) -> ThrustResult:
    """Result of the last evaluation of its model, with its tangent (6, 11)."""
    model, values, first = found.model, found.quantities(), found.model.faces[0]
    inflow, outflow = np.array([face.flows() for face in model.faces]).T
    return ThrustResult(
        axial_position=values["axial_position"],
        force=found.wrench[:3],
        moment=found.wrench[3:],
        axial_force=float(found.wrench[2]),
        friction_torque=float(found.wrench[5]),
        axial_stiffness=-float(tangent[2, 10]),
        axial_damping=found.axial_damping(),
        minimum_gap=values["thrust_minimum_gap"],
        peak_pressure=values["thrust_peak_pressure"],
        power_loss=values["thrust_power_loss"],
        contact_load=values["thrust_contact_load"],
        edge_pressures=np.array([face.known[0] * face.scales.pressure for face in model.faces]),
        inflow=inflow,
        outflow=outflow,
        theta=first.annulus.grid.x,
        r=first.annulus.scale * first.annulus.r,
        pressure=np.array([face.pressure for face in model.faces]),
        gap=np.array([face.gap for face in model.faces]),
        tangent=tangent,
    )
