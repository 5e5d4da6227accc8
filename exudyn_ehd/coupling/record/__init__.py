"""Records of the accepted steps of a run.

Module map
----------
history      quantities over accepted steps
record       rows and films of a joint's accepted steps; histories from files
rows         numbers and errors of steps; rules that keep some steps and the worst ones; rows in a file, for long runs
revolutions  extremes by revolution
"""
