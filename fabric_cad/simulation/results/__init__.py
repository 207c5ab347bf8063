"""What CalculiX wrote, as arrays: ``.frd`` (fields), ``.dat`` (printed sums), ``.sta`` (increments).

Our own reader, because ccx2paraview is GPL and pyvista-frd-reader, as fast, knows neither steps nor
diverged frames.

Times. Both ``.frd`` and ``.dat`` count the total time, which runs on from step to step (two steps
of 1 and 2 end at 1 and 3); only ``.sta`` has the time within the step beside it. ``.frd`` rounds it
to six digits below 1, so match states and prints with a tolerance, or by their order.

Fields. Nodal values in the global axes, the mean over the elements that share the node. Tensors
have the order xx, yy, zz, xy, yz, zx (``.dat`` prints xx, yy, zz, xy, xz, yz, and in the element's
own axes where it has an orientation, unless told ``GLOBAL=YES``). Shear strains are tensor
components, half the angle. Under NLGEOM, STRESS is Cauchy's and TOSTRAIN Green's. ccx carries
stress and strain from the integration points of a C3D8 to its nodes with coefficients rounded to
four digits: a uniform field comes out 4e-5 of its value too small (DISP, FORC and the sums of the
``.dat`` do not).

Contact. Face-to-face contact fills in CONTACT for the slave surface; every other node has zeros.

Sums. RF of a node tied by an equation is the force of the elements at that node, dependent or not,
so a face keeps its sum; RF of a node that only equations know (a reference node) prints 0.
"""

from .fields import State, read_frd
from .increments import Increment, read_sta
from .prints import CONTACT_FORCE, Printed, read_dat

__all__ = ["CONTACT_FORCE", "Increment", "Printed", "State", "read_dat", "read_frd", "read_sta"]
