"""Coupling of the films to Exudyn.

Module map
----------
api         `CreateLubricatedJoint`, axial options `Free` and `Held`
spherical   `CreateLubricatedSphericalJoint`: a ball in its socket
pads        `CreateTiltingPadBearing`, `CreateTiltingPadThrustBearing`: pads as bodies, a film for each of them
replace     `ReplaceJoint`: films in the place of joints that a model has; `ReplaceReducedBody`
handle      `LubricatedJoint`: what a user has of a joint
rotor       rotors in several films: equilibria over the speed, eigenvalues, unbalance
run         Exudyn's solvers with this package's errors and start of Newton's method; restarts
element     the film as an object of Exudyn: user functions, accepted steps, failures, sensors, drawing
doubts      steps too coarse for a film, films and forces to doubt, a line at the end of a run
exudyn_solvers settings of runs, the solver at work, its hooks; control of steps
items       item numbers of a scene to carriers of a joint frame; input checks; a nodal bush as an object of a model
record      what a run leaves: histories, films, a line
kinematics  poses, rates and exact variations of the two frames, as kernels
contract    what the coupling asks of a film and of a side; names for Exudyn's types
"""
