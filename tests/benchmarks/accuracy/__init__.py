"""Cost of accuracy in time: scenes, ladders of settings, work-precision tables and pictures; the README's numbers.

``python -m tests.benchmarks.accuracy`` from the project's folder redoes everything in ``data``; ``--quick`` takes about
a minute.

Module map
----------
scenes             journals held in place and journals that move in Exudyn models
errors             a study: scene + ladder + converged references -> table
costs              effects, closures, bushes over the plain film; growth; what is paid once
report             work-precision diagrams, Pareto fronts, summary, texts of the README
catalogue          all studies: which scene meets which ladder
advice_for_scenes  the cheapest film and steps for a measured scene
order              whether times keep their order over several runs
table              rows of errors and of costs: text, CSV
"""
