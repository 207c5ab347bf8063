"""CalculiX as a child process: found, run, followed, stopped in time, and its verdict read.

Its exit status alone says little: 0 also where the deck could not be opened or held no step, 201
for an error in the deck as for a job that did not converge. The verdict here comes from the status,
the log and the increments in the ``.sta`` file together. Where the system has no process groups
(Windows), the process alone is stopped, and its memory is not known.
"""

from .executable import find_solver
from .running import Progress, run_solver
from .steps import step_periods
from .verdict import Run

__all__ = ["Progress", "Run", "find_solver", "run_solver", "step_periods"]
