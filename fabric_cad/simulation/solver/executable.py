"""The CalculiX to run: the one named, or the one on the PATH."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

from ...support.errors import SolverError

_HINT = (
    "install it (Debian, Ubuntu: apt-get install calculix-ccx; elsewhere conda-forge's calculix or a build "
    "from calculix.de) or name it with --ccx PATH"
)


def find_solver(option: str | Path | None = None) -> Path:
    """The ccx to run: the one named, else ``ccx``, the newest ``ccx_2.x`` or ``ccx_static`` on the PATH.

    Raises SolverError, in one line that says how to get it, where there is none.
    """
    if option is not None:
        found = shutil.which(os.fspath(option))
        if found is None:
            raise SolverError(f"no CalculiX solver at {option}: {_HINT}")
        return Path(found).resolve()
    for name in ("ccx", *_numbered(), "ccx_static"):
        if found := shutil.which(name):
            return Path(found).resolve()
    raise SolverError(f"the CalculiX solver ccx is not on the PATH: {_HINT}")


def _numbered() -> list[str]:
    """Names like ccx_2.21 or ccx_2.22_MT on the PATH, newest first."""
    folders = [Path(folder) for folder in os.environ.get("PATH", "").split(os.pathsep) if folder]
    names = {path.name for folder in folders for path in folder.glob("ccx_2.*")}
    versions = {
        name: match[1] for name in names if (match := re.fullmatch(r"ccx_2\.(\d+)\w*", name))
    }
    return sorted(versions, key=lambda name: (-int(versions[name]), name))
