"""Accuracy against time: scenes, ladders of settings, work-precision tables and pictures, and `recommend`.

Module map
----------
setting     what a rung of a ladder changes, what a run gives back, what a scene is
richardson  a converged reference with an estimate of its own error
study       scene + ladder + references -> table; repeated in turns, or in parallel without times
table       the table: text, CSV
front       Pareto front, cheapest setting within an error, whether an order of times is kept
steady      scenes: a journal at a prescribed position
moving      scenes: journals that move in an Exudyn model
mechanisms  the Exudyn models of these scenes
ladders     which settings stand on a ladder
catalogue   all studies
pictures    work-precision diagrams, one-page summary
cells       measured errors over (eps, L/D, tilt, elasticity)
advice      `recommend`
growth      cost over grid, modes and joints
costs       tables of what options cost, with factors over a base
effect_costs  effects, closures and reduced films over the plain film
bush_costs  bores in a run, the film's Jacobian, assembly of elements
once_costs  what is paid once: kernels, maps, modes
guide       texts and tables of the guide from all these
order       whether times keep their order over several runs
moving_catalogue  the moving scenes and their ladders
parameters  apart from all that: `parameter_study`, a function over lists of parameters

``python -m exudyn_ehd.studies`` redoes everything that is shipped in ``data``; ``--quick`` takes about a minute.
"""
