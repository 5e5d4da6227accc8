"""Records of the accepted steps of a run.

Module map
----------
history      quantities over accepted steps
record       the rows and films of a joint's accepted steps, and histories back from files
rows         numbers and errors of steps; some of the steps, with the worst ones; rows in a file, for long runs
revolutions  extremes by revolution
"""
