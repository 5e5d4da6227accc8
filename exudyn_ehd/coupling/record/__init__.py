"""Records of the accepted steps of a run.

Module map
----------
history      quantities over accepted steps
record       the rows and films of a joint's accepted steps, and histories back from files
thinning     numbers and errors of steps; some of the steps, with the worst ones
on_disk      a history in a file, for long runs
summary      a run in one line
revolutions  extremes by revolution
"""
