"""Command lines with wrong options, values, files and places, and surroundings that have gone wrong."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable

import numpy as np

from .mutations import ODD_TEXTS, pick
from .tables import LEAVES, SHIPPED
from .trial import Trial

# (arguments, what a refusal names)
WRONG: tuple[tuple[tuple[str, ...], tuple[str, ...]], ...] = (
    ((), ("COMMAND",)),
    (("knit",), ("knit",)),
    (("lsit",), ("lsit",)),
    (("cell",), ("ROW",)),
    (("cell", ""), ("families",)),
    (("cell", "no such row"), ("no such row",)),
    (("cell", "../plain"), ("../plain",)),
    (("cell", "plain", "--across", "0"), ("across",)),
    (("cell", "plain", "--across", "two"), ("--across",)),
    (("cell", "plain", "--across", "-4"), ("across",)),
    (("cell", "plain", "--across", "1e3"), ("--across",)),
    (("cell", "plain", "--across", "٨"), ("across",)),
    (("cell", "plain", "--through", "3"), ("through",)),
    (("cell", "plain", "--through", "100"), ("through", "across")),
    (("cell", "plain", "--gap", "3"), ("gap",)),
    (("cell", "plain", "--gap", "100000000"), ("gap",)),
    (("cell", "plain", "--size", "0"), ("size",)),
    (("cell", "plain", "--size", "nan"), ("size",)),
    (("cell", "plain", "--size", "inf"), ("size",)),
    (("cell", "plain", "--size", "1e-300"), ("size",)),
    (("cell", "plain", "--size", "0.002"), ("size",)),
    (("cell", "plain", "--crossing", "1" * 5000), ("crossing",)),
    (("cell", "plain", "--deck", "nastran"), ("--deck",)),
    (("cell", "plain", "--no-such-option"), ("--no-such-option",)),
    (("cell", "plain", "--families"), ("--families",)),
    (("cell", "plain", "--families", "nowhere"), ("nowhere",)),
    (("cell", "plain", "--families", ""), ("families", ".: ")),
    (("cell", "plain", "--families", "families/plain.csv"), ("families/plain.csv",)),
    (("list", "--families", "a\x1b[31m"), ("a",)),
    (("list", "--families", "folder\nof two lines"), ("folder",)),
    (("list", "extra"), ("extra",)),
    (("solve", "--out", "a_file"), ("a_file",)),
    (("solve", "--out", "a_file/below"), ("a_file",)),
    (("solve", "--out", "x" * 300), ("x" * 20,)),
    (("study", "none.toml"), ("none.toml",)),
    (("study", "families"), ("families",)),
    (("study", "a_file"), ("a_file",)),
    (("study", "families/measured.toml", "--workers", "0"), ("--workers",)),
    (("study", "families/measured.toml", "--workers", "²"), ("--workers",)),
    (("wif", "none.wif", "--name", "mine"), ("none.wif",)),
    (("wif", "families", "--name", "mine"), ("families",)),
    (("wif", "a_file"), ("--name",)),
    (("wif", "a_file", "--name", "a b"), ("name",)),
    (("wif", "a_file", "--name", "\x1b[31m"), ("name",)),
    (("wif", "caf\udce9.wif", "--name", "mine"), ("caf",)),
    (("wif", "a\nb.wif", "--name", "mine"), ("b.wif",)),
    (("tension", "plain", "--threads", "0", "--ccx", "true"), ("--threads",)),
    (("tension", "plain", "--time-limit", "nan", "--ccx", "true"), ("--time-limit",)),
    (("tension", "plain", "--ccx", "no/such/solver"), ("no/such/solver",)),
    (("shear", "plain", "--ccx", "families"), ("families",)),
    (("shear", "nothing", "--deck", "abaqus"), ("nothing",)),
)


def _closed() -> None:
    os.close(1)


def _full() -> None:
    os.dup2(os.open("/dev/full", os.O_WRONLY), 1)


def _both_full() -> None:
    os.dup2(os.dup2(os.open("/dev/full", os.O_WRONLY), 1), 2)


def _folder_deleted() -> None:
    shutil.rmtree(os.getcwd())


# (arguments, what has gone wrong, statuses)
AROUND: tuple[tuple[tuple[str, ...], Callable[[], None], tuple[int, ...]], ...] = (
    (("list",), _closed, (0, 1, 2)),
    (("list",), _full, (1,)),
    (("validate",), _full, (1,)),
    (("list",), _both_full, (1,)),
    (("list",), _folder_deleted, (1, 2)),
    (("init",), _folder_deleted, (1, 2)),
    (("solve",), _folder_deleted, (1, 2)),
    (("solve",), _closed, (0, 1, 2)),
)


def trial(seed: int) -> Trial:
    """The commands of the list one after another; beyond its end, drawn ones."""
    files: dict[str, bytes | None] = {
        f"families/{path.name}": path.read_bytes() for path in SHIPPED.glob("*.*")
    }
    files |= {"a_file": b"[WIF]\nVersion=1.1\n", "an empty folder": None}
    if seed < len(WRONG):
        arguments, named = WRONG[seed]
        statuses = (
            (0, 1, 2) if {"--ccx", "--out"} & set(arguments) else (0, 2)
        )  # 1: no solver, no place for results
        place = "|".join(map(re.escape, named))
        return Trial(
            _shown(arguments),
            arguments,
            files,
            place,
            LEAVES,
            statuses=statuses,
            fresh=seed % 10 == 5,
        )
    if seed < len(WRONG) + len(AROUND):
        arguments, prepare, statuses = AROUND[seed - len(WRONG)]
        name = f"{_shown(arguments)} with {prepare.__name__.strip('_').replace('_', ' ')}"
        return Trial(name, arguments, files, "", LEAVES, LEAVES, statuses, prepare, fresh=True)
    return _drawn(np.random.default_rng((4, seed)), files)


def _drawn(rng: np.random.Generator, files) -> Trial:
    """A command with options and values that fit, or do not, in any order."""
    arguments = [
        pick(rng, ("list", "solve", "validate", "cell", "wif", "study", "init", "", "-", "--"))
    ]
    pool = (
        "plain",
        "twill32",
        "families",
        "a_file",
        "--out",
        "out",
        "-q",
        "--families",
        "--size",
        "--across",
        "--gap",
    )
    for _ in range(int(rng.integers(6))):
        word = pick(rng, pool) if rng.random() < 0.7 else pick(rng, ODD_TEXTS)
        arguments.insert(int(rng.integers(len(arguments) + 1)), word.replace("\x00", ""))
    leaves = rf"({LEAVES})|.*out.*/.*|.*families/.*"
    return Trial(_shown(arguments), tuple(arguments), files, "", leaves, LEAVES)


def _shown(arguments) -> str:
    return " ".join(ascii(word)[1:-1][:60] or "''" for word in arguments)
