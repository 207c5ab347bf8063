"""A unit's line on disk: what was written is read, and nothing else."""

import json

import pytest

from fabric_cad.study.lines import read_line, written_line
from fabric_cad.study.store import Store
from fabric_cad.study.units import Outcome
from fabric_cad.support.errors import OutputError

DONE = Outcome(
    "done", "", {"a.b": 0.1, "text": "weft", "none": None, "odd": float("inf")}, {"total": 1.25}
)
LINE = written_line("k1", DONE).encode()


def test_a_line_is_read_as_it_was_written():
    assert read_line(LINE) == ("k1", DONE)


@pytest.mark.parametrize(
    "line",
    [
        b"",
        b"7",
        b"null",
        b"[1, 2]",
        b'"text"',
        b"{}",
        b"[" * 100_000,
        b"\xff\xfe",
        LINE[:-40],
        LINE.replace(b"1.25", b"1.35"),
        LINE.replace(b"k1", b"k2"),
        json.dumps(
            {"key": "k1", "status": "done", "reason": "", "figures": {}, "costs": {}}
        ).encode(),
        json.dumps({"sha256": None, "unit": None}).encode(),
    ],
)
def test_any_other_line_is_a_value_error(line):
    with pytest.raises(ValueError):
        read_line(line)


def test_every_single_byte_changed_is_noticed():
    for at in range(len(LINE) - 1):
        changed = bytearray(LINE)
        changed[at] ^= 1
        try:
            assert read_line(bytes(changed)) == ("k1", DONE)  # white space of JSON alone
        except ValueError:
            pass


def test_a_store_passes_over_what_is_damaged_and_what_failed(tmp_path):
    store = Store(tmp_path)
    for name, status in (("a", "done"), ("b", "failed"), ("c", "refused"), ("d", "done")):
        store.add(name, Outcome(status, name, {"x": 1.0}))
    store.close()
    (path,) = (tmp_path / "units").glob("*.jsonl")
    lines = path.read_text().splitlines()
    path.write_text("\n".join([lines[0].replace("1.0", "2.0"), *lines[1:], "[]", ""]))

    again = Store(tmp_path)
    assert set(again.outcomes) == {"c", "d"}
    assert again.damaged == [f"{path}:1", f"{path}:5"]


def test_a_store_that_cannot_be_read_is_told(tmp_path):
    (tmp_path / "units" / "a.jsonl").mkdir(parents=True)
    with pytest.raises(OutputError, match="a.jsonl: Is a directory"):
        Store(tmp_path)
