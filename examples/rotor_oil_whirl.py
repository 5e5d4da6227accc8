"""A flexible rotor on two oil films runs up through oil whirl into oil whip.

A steel shaft, 22 mm thick and 0.6 m long, runs in two bearings (diameter 30 mm, length 15 mm, radial clearance 0.1 mm,
0.05 Pa s) and carries a disc of 1.6 kg in its middle. The bushes sit in spherical seats and follow the shaft's slope,
without which their edges would carry the whipping shaft. The numbers are our own, of the size of laboratory rotors that
show whirl and whip. The shaft is a chain of geometrically exact beams (``ObjectBeamGeometricallyExact``) on
``NodeRigidBodyRxyz`` nodes, whose first angle is the spin: it may grow without limit, while the other two stay at the
shaft's bend. The bearings' journals are the end nodes themselves.

Three things are compared.

* Linear theory: `equilibrium` gives position, K and C of a bearing at each speed; with the mass and stiffness matrices
  of the shaft (from Exudyn's ``ComputeLinearizedSystem``) they make the rotor's eigenvalues. Where the largest real
  part changes sign, whirl begins. Next to it the textbook's rotor of one mass on a massless shaft, for which the
  threshold needs only the critical mass and whirl ratio that `equilibrium` reports: journals' mass + disc's mass / (1 -
  (nu / omega_n)^2) = critical mass (J. W. Lund, J. Tribology 109 (1987) 37, with the shaft in series).
* Free vibration in time, started in the whirling mode at six speeds about the threshold: growth and frequency against
  the eigenvalue.
* The run-up. A light tap on the disc every 0.2 s is what an instability can grow from. Beyond the threshold a whirl
  grows, first at the eigenvalue's frequency; when it fills the clearance it jumps to half the spin, the mean speed of
  the oil. When half the spin comes near the shaft's first bending frequency, the whirl bends away from it and stays a
  few per cent below that frequency however fast the rotor turns: whip. It bends the shaft by fifty clearances. The
  journals stay on their films, but barely: at exactly half the spin a film has no wedge, so that it needs all of its
  eccentricity to hold a journal that whirls close to it. The minimum film thickness is below a micrometre, where a real
  bearing rubs.

K and C belong to small motions: the frequency of the limit cycle is not the eigenvalue's, and only the nonlinear film
gives it. The linear theory omits gyroscopic moments, since the disc in the middle does not tilt in the first mode, and
the small moment that the bushes transmit.

Run ``python examples/rotor_oil_whirl.py``; pictures are written to ``results/rotor_oil_whirl``.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib
import time

import exudyn as exu
import exudyn.itemInterface as eii
import matplotlib.pyplot as plt
import numpy as np
from scipy import linalg, optimize, signal

import exudyn_ehd as ehd
from exudyn_ehd.pictures.style import styled

STEEL, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
DIAMETER, SPAN = 0.022, 0.6
RADIUS, WIDTH = 0.015, 0.015  # of the journals
DISC_MASS, DISC_RADIUS = 1.6, 0.05
ECCENTRICITY = 5e-6  # of the disc's centre of mass
TAP_TIME, TAP_PERIOD = 0.01, 0.2
GRAVITY = 9.81
CLEARANCE = 100e-6
HZ = 2.0 * math.pi
AREA, INERTIA = math.pi * DIAMETER**2 / 4.0, math.pi * DIAMETER**4 / 64.0
SHAFT_MASS = DENSITY * AREA * SPAN
LOAD = 0.5 * GRAVITY * (DISC_MASS + SHAFT_MASS)
IN_PLANE = (1, 2, 4, 5)  # of a node's coordinates: y, z and the rotations about them


def bearing(*, quick: bool = False) -> ehd.JournalBearing:
    """One of the two bearings."""
    return ehd.JournalBearing(
        journal_radius=RADIUS,
        length=WIDTH,
        radial_clearance=CLEARANCE,
        lubricant=ehd.Lubricant(viscosity=0.05),
        film=ehd.FiniteLength(n_theta=64, n_z=4) if quick else ehd.FiniteLength(n_theta=96, n_z=6),
    )


class Rotor:
    """The rotor in Exudyn.

    Parameters
    ----------
    elements : int
        Beams of the shaft, an even number.
    film : JournalBearing or None
        Both bearings; None leaves the shaft free.
    speed, angle : function of the time
        Spin (rad/s) and its integral (rad).
    displacement, velocity : (elements + 1, 4) arrays
        y, z (m) and rotations about y and z (rad) of the nodes at the start, and their rates in space.
    tap : float
        Force of the taps on the disc, N; 0 leaves out the disc's unbalance too.
    """

    def __init__(self, elements: int, film=None, speed=None, angle=None, displacement=None, velocity=None, tap=0.0):
        self.mbs = mbs = exu.SystemContainer().AddSystem()
        count, length = elements + 1, SPAN / elements
        u = np.zeros((count, 4)) if displacement is None else displacement
        v = np.zeros((count, 4)) if velocity is None else velocity
        spin = 0.0 if speed is None else speed(0.0)
        self.nodes = [self._node(k * length, u[k], v[k], spin) for k in range(count)]
        data = section()
        beams = [
            mbs.AddObject(eii.ObjectBeamGeometricallyExact(nodeNumbers=list(pair), length=length, sectionData=data))
            for pair in zip(self.nodes[:-1], self.nodes[1:], strict=True)
        ]
        moment = 0.25 * DISC_MASS * DISC_RADIUS**2
        disc = mbs.AddObject(
            eii.ObjectRigidBody(
                nodeNumber=self.nodes[elements // 2],
                mass=DISC_MASS,
                inertia=[2.0 * moment, moment, moment, 0, 0, 0],
                centerOfMass=[0, ECCENTRICITY if tap else 0.0, 0],
            )
        )
        for body in (*beams, disc):
            marker = mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=body))
            mbs.AddLoad(eii.LoadMassProportional(markerNumber=marker, loadVector=[0, 0, -GRAVITY]))
        if tap:
            marker = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=disc))
            mbs.AddLoad(
                eii.LoadForceVector(markerNumber=marker, loadVector=[0, 0, 0], loadVectorUserFunction=taps(tap))
            )
        ends = (("left", self.nodes[0], 0.0), ("right", self.nodes[-1], SPAN))
        self.joints = [] if film is None else [self._joint(film, *end) for end in ends]
        self._hold(self.nodes[0], 0)
        if speed is not None:
            self._hold(
                self.nodes[elements // 2],
                3,
                offsetUserFunction=lambda mbs, t, item, offset: angle(t),
                offsetUserFunction_t=lambda mbs, t, item, offset: speed(t),
            )
        self.disc_sensor = mbs.AddSensor(
            eii.SensorNode(
                nodeNumber=self.nodes[elements // 2],
                storeInternal=True,
                outputVariableType=exu.OutputVariableType.Displacement,
            )
        )
        mbs.Assemble()

    def _node(self, x: float, u: np.ndarray, v: np.ndarray, spin: float):
        """Node of the shaft: displacements and velocities (4,) in y, z and the two bending angles."""
        return self.mbs.AddNode(
            eii.NodeRigidBodyRxyz(
                referenceCoordinates=[x, 0, 0, 0, 0, 0],
                initialCoordinates=[0, u[0], u[1], 0, u[2], u[3]],
                # the two bending angles count in the turning shaft
                initialVelocities=[0, v[0], v[1], spin, v[2] + spin * u[3], v[3] - spin * u[2]],
            )
        )

    def _joint(self, film: ehd.JournalBearing, name: str, node, x: float) -> ehd.LubricatedJoint:
        return ehd.CreateLubricatedJoint(
            self.mbs,
            name=name,
            itemNumbers=[self._bush(x), node],
            position=[x, 0, 0],
            rotationMatrixAxes=[[0, 0, 1], [1, 0, 0], [0, 1, 0]],  # x, y of the joint are y, z of space
            bearing=film,
        )

    def _bush(self, x: float):
        """Bush in a spherical seat: it follows the shaft's slope, but does not turn with it."""
        mbs = self.mbs
        node = mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[x, 0, 0, 0, 0, 0]))
        bush = mbs.AddObject(eii.ObjectRigidBody(nodeNumber=node, mass=0.1, inertia=[2e-5, 1e-5, 1e-5, 0, 0, 0]))
        seat = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=mbs.AddObject(eii.ObjectGround()), localPosition=[x, 0, 0]))
        markers = [seat, mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=bush))]
        mbs.AddObject(eii.ObjectJointGeneric(markerNumbers=markers, constrainedAxes=[1, 1, 1, 1, 0, 0]))
        return bush

    def _hold(self, node, coordinate: int, **drive) -> None:
        mbs = self.mbs
        markers = [
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=mbs.AddNode(eii.NodePointGround()), coordinate=0)),
            mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)),
        ]
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers, **drive))

    def matrices(self) -> tuple[np.ndarray, np.ndarray]:
        """Mass and stiffness matrix of the shaft at rest without bearings, four coordinates per node."""
        mass, stiffness, _ = self.mbs.ComputeLinearizedSystem()
        kept = [self.mbs.GetNodeODE2Index(node) + k for node in self.nodes for k in IN_PLANE]
        return mass[np.ix_(kept, kept)], stiffness[np.ix_(kept, kept)]

    def run(self, end: float, step: float) -> tuple[ehd.JointHistory, np.ndarray, float]:
        """Integrate; history of the left bearing, displacement (n, 3) of the disc at its times, ms per step."""
        settings = exu.SimulationSettings()
        settings.timeIntegration.endTime = end
        settings.timeIntegration.numberOfSteps = steps = round(end / step)
        # damps the beams' stretching and shear; at the whirl's frequency its damping ratio is below 1e-5
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
        settings.timeIntegration.verboseMode = 0
        settings.solution.sensors.writePeriod = step
        settings.solution.file.write = False
        ehd.ConfigureSolver(settings)
        start = time.process_time()
        ehd.SolveDynamic(self.mbs, settings)
        milliseconds = 1e3 * (time.process_time() - start) / steps
        history = self.joints[0].history
        disc = self.mbs.GetSensorStoredData(self.disc_sensor)
        at = np.column_stack([np.interp(history.time, disc[:, 0], disc[:, k]) for k in (1, 2, 3)])
        return history, at, milliseconds


def section() -> exu.BeamSection:
    """Section data of the shaft, without damping of its own (which would make it unstable above its critical speed)."""
    shear = STEEL / (2.0 * (1.0 + POISSON))
    factor = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON)  # G. R. Cowper 1966, solid circle
    data = exu.BeamSection()
    transverse, bending = factor * shear * AREA, STEEL * INERTIA
    data.stiffnessMatrix = np.diag([STEEL * AREA, transverse, transverse, 2.0 * shear * INERTIA, bending, bending])
    data.inertia = DENSITY * np.diag([2.0 * INERTIA, INERTIA, INERTIA])
    data.massPerLength = DENSITY * AREA
    return data


def taps(force: float):
    """User function of light taps on the disc, sideways, half a sine each."""

    def push(mbs, t, load):
        since = t % TAP_PERIOD
        return [0.0, force * math.sin(math.pi * since / TAP_TIME) if since < TAP_TIME else 0.0, 0.0]

    return push


class LinearRotor:
    """Shaft and linearised bearings."""

    def __init__(self, elements: int, film: ehd.JournalBearing) -> None:
        self.elements, self.film = elements, film
        self.mass, self.stiffness = Rotor(elements).matrices()
        last = 4 * elements
        self.journals = np.array([0, 1, last, last + 1])
        self.others = np.setdiff1d(np.arange(last + 4), self.journals)

    @property
    def first_bending(self) -> float:
        """First bending frequency with the journals held in their middles, rad/s."""
        inner = np.ix_(self.others, self.others)
        return math.sqrt(linalg.eigh(self.stiffness[inner], self.mass[inner], eigvals_only=True)[0])

    def equilibrium(self, speed: float) -> ehd.EquilibriumResult:
        """Bearing under half the rotor's weight."""
        return ehd.equilibrium(self.film, speed=speed, load=(0.0, -LOAD))

    def rest(self, speed: float) -> np.ndarray:
        """Bent shaft (elements + 1, 4) in its bearings under its weight."""
        u = np.zeros(self.mass.shape[0])
        u[self.journals] = np.tile(self.equilibrium(speed).position, 2)
        down = np.zeros_like(u)
        down[1::4] = -GRAVITY
        force = (self.mass @ down - self.stiffness @ u)[self.others]
        u[self.others] = linalg.solve(self.stiffness[np.ix_(self.others, self.others)], force)
        return u.reshape(-1, 4)

    def mode(self, speed: float) -> tuple[complex, np.ndarray]:
        """Eigenvalue (1/s) with the largest real part among the whirling modes, and its mode (elements + 1, 4)."""
        eq, n = self.equilibrium(speed), self.mass.shape[0]
        stiffness, damping = self.stiffness.copy(), np.zeros((n, n))
        for first in (0, n - 4):
            block = slice(first, first + 2)
            stiffness[block, block] += eq.stiffness
            damping[block, block] += eq.damping
        inverse = linalg.inv(self.mass)
        values, vectors = linalg.eig(
            np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -inverse @ damping]])
        )
        values[values.imag < 0.1 * speed] = -np.inf
        best = int(np.argmax(values.real))
        return complex(values[best]), vectors[:n, best].reshape(-1, 4)

    def threshold(self) -> float:
        """Spin at which the growth rate changes its sign, rad/s."""
        return float(optimize.brentq(lambda w: self.mode(w)[0].real, 60.0 * HZ, 2.0 * self.first_bending, xtol=0.01))

    def threshold_of_one_mass(self) -> float:
        """Threshold spin of a disc with 17/35 of the shaft on a massless shaft, the rest at the journals, rad/s."""
        modal = 0.5 * (DISC_MASS + 17.0 / 35.0 * SHAFT_MASS)
        own = math.sqrt(24.0 * STEEL * INERTIA / SPAN**3 / modal)

        def excess(speed: float) -> float:
            eq = self.equilibrium(speed)
            return LOAD / GRAVITY - modal + modal / (1.0 - (eq.whirl_ratio * speed / own) ** 2) - eq.critical_mass

        return float(optimize.brentq(excess, 60.0 * HZ, 1.9 * own, xtol=0.01))


def free_whirl(linear: LinearRotor, speed: float, *, turns: float, steps_per_turn: int) -> complex:
    """Growth rate + i frequency (1/s) of the simulated rotor, released in its whirling mode at 1 % of the clearance."""
    value, mode = linear.mode(speed)
    mode = mode / np.hypot(*np.abs(mode[0, :2])) * 0.01 * CLEARANCE
    rotor = Rotor(
        linear.elements,
        linear.film,
        lambda t: speed,
        lambda t: speed * t,
        linear.rest(speed) + mode.real,
        (value * mode).real,
    )
    history, _, _ = rotor.run(turns * HZ / abs(value.imag), HZ / abs(value.imag) / steps_per_turn)
    t, y = history.time, history.eccentricity[:, 0] / (0.01 * CLEARANCE)

    def model(t, offset, cosine, sine, growth, frequency):
        return offset + np.exp(growth * t) * (cosine * np.cos(frequency * t) + sine * np.sin(frequency * t))

    guess = [y.mean(), y[0] - y.mean(), 0.0, value.real, value.imag]
    _, _, _, growth, frequency = optimize.curve_fit(model, t, y, p0=guess)[0]
    return complex(growth, frequency)


@dataclasses.dataclass(frozen=True, kw_only=True)
class RunUp:
    """The run-up on a uniform grid of times, with spectra of the left journal's forward motion.

    ``speed`` (Hz), ``orbit`` x + i y of the journal and ``disc`` y + i z of the disc (m), ``film`` minimum film
    thickness (m); ``spectrum_speed`` (k,) and ``frequency`` (n,) in Hz with ``amplitude`` (n, k) in m.
    """

    time: np.ndarray
    speed: np.ndarray
    orbit: np.ndarray
    disc: np.ndarray
    film: np.ndarray
    largest_ratio: float
    spectrum_speed: np.ndarray
    frequency: np.ndarray
    amplitude: np.ndarray
    milliseconds_per_step: float

    def peak(self) -> np.ndarray:
        """Frequency of the largest line below 0.8 of the spin, at each spectrum, Hz."""
        below = self.frequency[:, None] < 0.8 * self.spectrum_speed
        strongest = np.argmax(np.where(below & (self.frequency[:, None] > 15.0), self.amplitude, 0.0), axis=0)
        return self.frequency[strongest]


def run_up(linear: LinearRotor, first: float, last: float, duration: float, step: float, tap: float) -> RunUp:
    """Accelerate uniformly from ``first`` to ``last`` (Hz)."""
    start, rate = HZ * first, HZ * (last - first) / duration
    rest = linear.rest(start)
    rotor = Rotor(
        linear.elements,
        linear.film,
        lambda t: start + rate * t,
        lambda t: start * t + 0.5 * rate * t * t,
        rest,
        tap=tap,
    )
    h, disc, milliseconds = rotor.run(duration, step)
    # a step that was halved leaves a time of its own
    t = np.arange(0.0, duration, step)

    def at(values: np.ndarray) -> np.ndarray:
        return np.interp(t, h.time, values)

    orbit = at(h.eccentricity[:, 0]) + 1j * at(h.eccentricity[:, 1])
    window = round(0.2 / step)
    frequency, centres, amplitude = signal.spectrogram(
        orbit,
        1.0 / step,
        window="hann",
        nperseg=window,
        noverlap=window * 9 // 10,
        nfft=8 * window,
        return_onesided=False,
        detrend="constant",
        scaling="spectrum",
        mode="magnitude",
    )
    kept = np.flatnonzero((frequency > 0.0) & (frequency < 1.2 * last))
    return RunUp(
        time=t,
        speed=first + (last - first) * t / duration,
        orbit=orbit,
        disc=at(disc[:, 1]) + 1j * at(disc[:, 2]),
        film=at(h.minimum_gap),
        largest_ratio=float(h.eccentricity_ratio.max()),
        spectrum_speed=first + (last - first) * centres / duration,
        frequency=frequency[kept],
        amplitude=amplitude[kept],
        milliseconds_per_step=milliseconds,
    )


def figures(linear: LinearRotor, rates: dict[float, tuple[complex, complex]], ride: RunUp) -> dict[str, float]:
    """Numbers of the example; frequencies in Hz."""
    threshold, bending = linear.threshold(), linear.first_bending / HZ
    value = linear.mode(threshold)[0]
    # zero of the simulated growth rate between the two speeds next to the threshold
    (slow, (_, before)), (fast, (_, after)) = sorted(rates.items())[len(rates) // 2 - 1 : len(rates) // 2 + 1]
    simulated = slow - before.real * (fast - slow) / (after.real - before.real)
    ratio = ride.peak() / ride.spectrum_speed
    whirls = (ride.spectrum_speed > 1.2 * threshold / HZ) & (ride.spectrum_speed < 1.8 * bending)
    late = ride.spectrum_speed > ride.spectrum_speed[-1] - 10.0
    return {
        "first_bending_Hz": bending,
        "threshold_linear_Hz": threshold / HZ,
        "threshold_one_mass_Hz": linear.threshold_of_one_mass() / HZ,
        "threshold_simulated_Hz": simulated / HZ,
        "ratio_at_threshold": value.imag / threshold,
        "eccentricity_ratio_at_threshold": linear.equilibrium(threshold).eccentricity_ratio,
        "whirl_ratio_lowest": float(ratio[whirls].min()),
        "whirl_ratio_highest": float(ratio[whirls].max()),
        "whip_Hz": float(ride.peak()[late].mean()),
        "whip_ratio": float(ratio[late].mean()),
        "whip_change_per_Hz": float(np.polyfit(ride.spectrum_speed[late], ride.peak()[late], 1)[0]),
        "quiet_amplitude_ratio": float(np.abs(ride.orbit - ride.orbit.mean())[ride.speed < threshold / HZ].max())
        / CLEARANCE,
        "largest_eccentricity_ratio": ride.largest_ratio,
        "minimum_film_thickness_um": 1e6 * float(ride.film.min()),
        "largest_disc_amplitude_mm": 1e3 * float(np.abs(ride.disc - ride.disc.mean()).max()),
        "milliseconds_per_step": ride.milliseconds_per_step,
    }


def _draw_waterfall(water, ride: RunUp, threshold: float, bending: float) -> None:
    """Spectra of the left journal over the spin."""
    lines = np.linspace(0, ride.spectrum_speed.size - 1, 34).round().astype(int)
    height = 0.09 * (ride.spectrum_speed[-1] - ride.spectrum_speed[0]) / (0.5 * CLEARANCE)
    for order, k in enumerate(lines[::-1]):
        base, line = ride.spectrum_speed[k], height * ride.amplitude[:, k]
        water.fill_between(ride.frequency, base, base + line, color="white", zorder=2 * order)
        water.plot(ride.frequency, base + line, color="tab:blue", lw=0.9, zorder=2 * order + 1)
    ends = np.array([ride.spectrum_speed[0], ride.spectrum_speed[-1] + 4.0])
    guide = {"lw": 1.0, "zorder": 200}
    water.plot(ends, ends, color="grey", ls=":", label="spin", **guide)
    water.plot(0.5 * ends, ends, color="tab:orange", ls="--", label="half the spin", **guide)
    water.axvline(bending, color="tab:red", ls="-.", label="first bending frequency", **guide)
    water.axhline(threshold, color="tab:green", ls="--", label="threshold of linear theory", **guide)
    water.set(
        xlabel="frequency [Hz]",
        ylabel="spin [Hz]",
        xlim=(20, ride.frequency[-1]),
        ylim=(ends[0] - 1.0, ends[1] + 12.0),
        title=f"forward motion of the left journal\n(an amplitude of c / 2 is {height * 0.5 * CLEARANCE:.1f} Hz high)",
    )
    water.legend(loc="upper center", bbox_to_anchor=(0.5, -0.06), ncols=2, frameon=False)


def _draw_modes(
    frequency, growth, linear: LinearRotor, rates: dict[float, tuple[complex, complex]], ride: RunUp, threshold: float
) -> None:
    """Whirl frequency and growth rate over the spin, from time and from linear theory."""
    bending = linear.first_bending / HZ
    speeds = np.linspace(0.85 * threshold, ride.spectrum_speed[-1] + 4.0, 40)
    modes = [linear.mode(HZ * s)[0] for s in speeds]
    grown = ride.spectrum_speed > 1.02 * threshold
    frequency.plot(ride.spectrum_speed[grown], ride.peak()[grown], color="tab:blue", lw=2, label="run-up")
    frequency.plot(speeds, [m.imag / HZ for m in modes], color="black", ls=":", label="linear theory")
    frequency.plot(speeds, 0.5 * speeds, color="tab:orange", ls="--", label="half the spin")
    frequency.axhline(bending, color="tab:red", ls="-.", label="first bending")
    frequency.set(xlabel="spin [Hz]", ylabel="whirl frequency [Hz]", ylim=(40, 95))
    frequency.legend(loc="upper left")
    growth.plot(speeds, [m.real for m in modes], color="black", ls=":", label="linear theory")
    growth.plot(
        [s / HZ for s in rates],
        [r[1].real for r in rates.values()],
        "o",
        color="tab:blue",
        label="free vibration in time",
    )
    growth.axhline(0.0, color="grey", lw=0.8)
    growth.axvline(threshold, color="tab:green", ls="--", label="threshold")
    growth.set(xlabel="spin [Hz]", ylabel="growth rate [1/s]", xlim=(0.87 * threshold, 1.3 * threshold), ylim=(-19, 27))
    growth.legend(loc="lower right")


def _draw_orbits(orbits, disc, ride: RunUp, threshold: float, bending: float) -> None:
    """Left journal and disc before the whirl, in it, and in the whip."""
    around = np.exp(1j * np.linspace(0.0, HZ, 200))
    orbits.plot(around.real, around.imag, color="grey", lw=1)
    chosen = (
        ("before", 0.99 * threshold, {"color": "tab:green", "lw": 1.2}),
        ("whirl", 0.85 * 2.0 * bending, {"color": "tab:orange", "lw": 3.0}),
        ("whip", ride.speed[-1], {"color": "tab:red", "lw": 1.2, "ls": "--"}),
    )
    for label, speed, style in chosen:
        last = int(np.searchsorted(ride.speed, speed))
        # one turn of the whirl
        part = slice(last - round(1.0 / min(0.5 * speed, bending) / (ride.time[1] - ride.time[0])) - 1, last)
        orbits.plot((ride.orbit[part] / CLEARANCE).real, (ride.orbit[part] / CLEARANCE).imag, **style)
        disc.plot(
            1e3 * ride.disc[part].real,
            1e3 * ride.disc[part].imag,
            label=f"{label}, {speed:.0f} Hz",
            **style,
        )
    orbits.set(
        xlabel="y / c [-]",
        ylabel="z / c [-]",
        aspect="equal",
        title="left journal in its bearing,\none turn of the whirl",
    )
    disc.set(xlabel="y [mm]", ylabel="z [mm]", aspect="equal", title="disc, one turn of the whirl")
    disc.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3, frameon=False)


def _sketch(ax) -> None:
    """The rotor from the side, 1 : 1 in both directions."""
    half, wide = 0.5 * DIAMETER, 0.5 * WIDTH
    ax.plot([-0.08, SPAN + 0.08], [0.0, 0.0], color="0.8", lw=0.8, ls="-.")
    ax.add_patch(plt.Rectangle((-wide, -half), SPAN + 2.0 * wide, DIAMETER, fc="0.85", ec="black", lw=0.8))
    thick = 0.25 * DISC_RADIUS
    ax.add_patch(
        plt.Rectangle((0.5 * SPAN - thick, -DISC_RADIUS), 2.0 * thick, 2.0 * DISC_RADIUS, fc="0.6", ec="black")
    )
    for x, name in ((0.0, "left"), (SPAN, "right")):
        ax.add_patch(plt.Rectangle((x - wide, -RADIUS), WIDTH, 2.0 * RADIUS, fc="0.85", ec="black", lw=0.8))
        for low in (RADIUS, -RADIUS - 0.02):
            ax.add_patch(plt.Rectangle((x - wide, low), WIDTH, 0.02, fc="tab:blue", ec="none"))
        ax.text(x, -0.07, f"{name} bearing, on oil", ha="center", color="tab:blue")
    ax.annotate(
        "", (-0.07, 0.022), (-0.07, -0.022), arrowprops={"arrowstyle": "->", "connectionstyle": "arc3,rad=-0.6"}
    )
    ax.text(-0.1, 0.0, "spin", ha="right", va="center")
    ax.text(0.5 * SPAN + 1.5 * thick, 0.028, f"disc, {DISC_MASS:g} kg")
    ax.text(0.24 * SPAN, 0.02, "flexible shaft", ha="center")
    ax.set(aspect="equal", xlim=(-0.2, SPAN + 0.15), ylim=(-0.085, 0.06))
    ax.set_axis_off()


@styled(10.0)
def draw(linear: LinearRotor, rates: dict[float, tuple[complex, complex]], ride: RunUp, path: pathlib.Path) -> None:
    """Waterfall, frequencies and growth rates against linear theory, orbits."""
    threshold, bending = linear.threshold() / HZ, linear.first_bending / HZ
    fig = plt.figure(figsize=(14, 10), layout="constrained")
    grid = fig.add_gridspec(3, 3, width_ratios=(1.5, 1, 1), height_ratios=(0.36, 1, 1))
    _sketch(fig.add_subplot(grid[0, 1:]))
    _draw_waterfall(fig.add_subplot(grid[:, 0]), ride, threshold, bending)
    _draw_modes(fig.add_subplot(grid[1, 1]), fig.add_subplot(grid[1, 2]), linear, rates, ride, threshold)
    _draw_orbits(fig.add_subplot(grid[2, 1]), fig.add_subplot(grid[2, 2]), ride, threshold, bending)
    fig.savefig(path, dpi=85)
    plt.close(fig)


def main(*, quick: bool = False, output: str | pathlib.Path | None = "results/rotor_oil_whirl") -> dict[str, float]:
    """Threshold by linear theory and in time, and the run-up; returns the numbers that `figures` names.

    Parameters
    ----------
    quick : bool
        Fewer elements, coarser film and steps, a faster run-up.
    output : path or None
        Folder for the picture; None writes none.
    """
    linear = LinearRotor(4 if quick else 6, bearing(quick=quick))
    threshold = linear.threshold()
    print("rotor on two oil films; compiling the film's kernels takes some seconds the first time", flush=True)
    rates = {}
    for share in (0.97, 1.03) if quick else (0.91, 0.94, 0.97, 1.03, 1.08, 1.15):
        speed = share * threshold
        simulated = free_whirl(linear, speed, turns=4 if quick else 10, steps_per_turn=40 if quick else 80)
        rates[speed] = (linear.mode(speed)[0], simulated)
        print(f"  free vibration at {speed / HZ:.1f} Hz: {simulated.real:+.2f} + {simulated.imag:.1f}i, ", end="")
        print(f"linear theory {rates[speed][0].real:+.2f} + {rates[speed][0].imag:.1f}i", flush=True)
    # the faster run-up leaves a whirl less time to grow: a firmer tap
    first, last, duration, step, force = (
        (97.0, 170.0, 0.75, 1 / 3000, 8.0) if quick else (85.0, 170.0, 2.4, 1 / 4000, 0.8)
    )
    print(f"  run-up from {first:g} to {last:g} Hz, {duration / step:.0f} steps ...", flush=True)
    ride = run_up(linear, first, last, duration, step, force)
    numbers = figures(linear, rates, ride)
    for name, value in numbers.items():
        print(f"{name:36s}{value:10.4g}")
    if output is not None:
        folder = pathlib.Path(output)
        folder.mkdir(parents=True, exist_ok=True)
        draw(linear, rates, ride, folder / "rotor_oil_whirl.png")
        print(f"\npicture: {folder / 'rotor_oil_whirl.png'}")
    return numbers


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="coarser, and a faster run-up")
    main(quick=parser.parse_args().quick)
