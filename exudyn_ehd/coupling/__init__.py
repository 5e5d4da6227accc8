"""Coupling of the films to Exudyn.

Module map
----------
api         `CreateLubricatedJoint`, axial options `Free` and `Held`
spherical   `CreateLubricatedSphericalJoint`: a ball in its socket
pads        `CreateTiltingPadBearing`, `CreateTiltingPadThrustBearing`: pads as bodies, a film for each of them
replace     `ReplaceJoint`: films that replace ideal joints of a model; `ReplaceReducedBody`
handle      `LubricatedJoint`: the object through which a user reads and controls a joint
rotor       rotors in several films: equilibria over the speed, eigenvalues, unbalance
run         Exudyn's solvers with this package's errors and start of Newton's method; restarts
element     the film as an object of Exudyn: user functions, accepted steps, failures, sensors, drawing
doubts      warnings of steps too coarse for a film and of doubtful films and forces; summary line of a run
exudyn_solvers settings of runs, the running solver, its hooks; control of steps
items       from item numbers of a model to sides of a joint; input checks; a nodal bush as an object of a model
record      records of a run: histories, films, tables of revolutions
kinematics  poses, rates and exact variations of the two frames, as kernels
contract    protocols of a film and of a side of a joint; names for Exudyn's types
"""
