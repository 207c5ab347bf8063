"""A unit's outcome as a line of JSON with a checksum, and back."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, fields

from .units import Outcome

_STATUS = ("done", "refused", "failed")
_KINDS = {"key": str, "status": str, "reason": str, "figures": dict, "costs": dict}


def written_line(key: str, outcome: Outcome) -> str:
    """The line, its end included, of a unit's key and outcome."""
    record = json.dumps({"key": key, **asdict(outcome)})
    return json.dumps({"sha256": _checksum(record), "unit": json.loads(record)}) + "\n"


def read_line(line: bytes) -> tuple[str, Outcome]:
    """Key and outcome of a line. Raises ValueError where it is not one that :func:`written_line` wrote."""
    try:
        content = json.loads(line)
    except RecursionError as error:
        raise ValueError("nested too deeply") from error

    if not (isinstance(content, dict) and set(content) == {"sha256", "unit"}):
        raise ValueError("not a unit's line")

    record = content["unit"]
    if _checksum(json.dumps(record)) != content["sha256"]:
        raise ValueError("not as it was written")
    if not isinstance(record, dict) or set(record) != set(_KINDS):
        raise ValueError("not a unit's outcome")
    if (
        not all(isinstance(record[name], kind) for name, kind in _KINDS.items())
        or record["status"] not in _STATUS
    ):
        raise ValueError("not a unit's outcome")

    return record["key"], Outcome(**{field.name: record[field.name] for field in fields(Outcome)})


def _checksum(record: str) -> str:
    return hashlib.sha256(record.encode()).hexdigest()[:16]
