"""A study's table as Parquet and CSV: one row a unit; the door to pyarrow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..support.errors import FabricCadError

_KEY = b"fabric_cad.study"
NAMES = ("table.parquet", "table.csv")


def _pyarrow():
    try:
        import pyarrow
        import pyarrow.csv
        import pyarrow.parquet
    except ImportError as error:
        raise FabricCadError(
            "a study's table needs pyarrow: pip install 'fabric-cad[study]'"
        ) from error
    return pyarrow


def write_table(columns: Mapping[str, Sequence], folder: Path, digest: str) -> None:
    """Write columns of equal length (NaN and None: empty) to ``table.parquet`` and ``table.csv`` of a folder.

    ``digest`` goes with the Parquet file, for :func:`written_digest`.
    """
    pa = _pyarrow()
    arrays = {name: pa.array(values, from_pandas=True) for name, values in columns.items()}
    table = pa.table(arrays).replace_schema_metadata({_KEY: digest})
    parquet, text = (folder / name for name in NAMES)
    pa.parquet.write_table(table, parquet)
    pa.csv.write_csv(table, text)


def written_digest(folder: Path) -> str | None:
    """The digest of the table in a folder, None where there is no whole one."""
    pa = _pyarrow()
    parquet, text = (folder / name for name in NAMES)
    if not (parquet.exists() and text.exists()):
        return None
    try:
        metadata = pa.parquet.read_schema(parquet).metadata or {}
    except (OSError, pa.ArrowException):
        return None
    return metadata.get(_KEY, b"").decode() or None


def read_table(folder: str | Path) -> dict[str, np.ndarray]:
    """The columns of a study's ``table.parquet`` by name, each of shape (units,).

    Empty cells are NaN or None.
    """
    pa = _pyarrow()
    table = pa.parquet.read_table(Path(folder) / NAMES[0])
    return {name: table[name].to_numpy(zero_copy_only=False) for name in table.column_names}
