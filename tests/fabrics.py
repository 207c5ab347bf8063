"""Random and written fabrics for the tests: rows go through a real table, as a user's do."""

from __future__ import annotations

import tempfile
from math import gcd
from pathlib import Path

import numpy as np

from fabric_cad.measured.tables import Family, read_family
from fabric_cad.weave.faults import pattern_faults
from fabric_cad.weave.patterns import written


def table(family: str, *rows: dict, folder: Path | None = None) -> Family:
    """A family table of the given rows (column to value), written and read."""
    columns = list(dict.fromkeys(column for row in rows for column in row))
    lines = [
        ",".join(columns),
        *(",".join(_text(row.get(column, "")) for column in columns) for row in rows),
    ]
    with tempfile.TemporaryDirectory() as scratch:
        path = Path(folder or scratch) / f"{family}.csv"
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return read_family(path)


def _text(value) -> str:
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def random_row(
    rng: np.random.Generator,
    name: str = "random",
    widths: tuple[float, float] = (0.6, 0.97),
    family: str = "",
    ratio: float | None = None,
) -> tuple[str, dict]:
    """(family, row) of a valid-looking fabric: m, n to 5, harness to 12, crimps 0.0005 to 0.03, lenticular or flat.

    ``widths`` are its bounds as shares of the spacing; ``ratio`` is about that of a weft's thickness to a
    warp's (None: either a balanced fabric, or one of yarns about equally thick).
    """
    family = family or str(rng.choice(["plain", "twill", "satin"]))
    row: dict = {"name": name} | _weave(rng, family)
    spacing = float(np.exp(rng.uniform(np.log(0.4), np.log(6.0))))
    row |= _direction(rng, "weft", spacing, widths)
    if ratio is not None or rng.random() < 0.5:
        row |= _direction(rng, "warp", spacing * float(rng.uniform(0.7, 1.4)), widths)
        row |= _thickness(rng, row, ratio)
    if rng.random() < 0.3:
        row |= {"section": "flat", "lateral_height_mm": spacing * float(rng.uniform(0.002, 0.03))}
    return family, row


def _weave(rng: np.random.Generator, family: str) -> dict:
    """The weave columns of a row."""
    if family == "twill":
        return {"over": int(rng.integers(1, 6)), "under": int(rng.integers(1, 6))}
    if family == "satin":
        harness = int(rng.integers(5, 13))
        return {
            "harness": harness,
            "step": int(rng.choice([k for k in range(1, harness) if gcd(k, harness) == 1])),
        }
    return {"pattern": written(_pattern(rng))} if family == "pattern" else {}


def _pattern(rng: np.random.Generator) -> tuple[str, ...]:
    """An interlacement of 2 to 8 wefts and warps, as likely over as under, that holds together."""
    while True:
        wefts, warps = rng.integers(2, 9, size=2)
        pattern = tuple("".join(row) for row in rng.choice(["0", "1"], size=(wefts, warps)))
        if not pattern_faults(pattern):
            return pattern


def random_narrow_row(rng: np.random.Generator, name: str = "narrow") -> tuple[str, dict]:
    """A fabric with narrow gaps: widths 0.95 to 0.999 of the spacing; one in four of any weave."""
    return random_row(rng, name, (0.95, 0.999), "pattern" if rng.random() < 0.25 else "")


def random_unequal_row(rng: np.random.Generator, name: str = "unequal") -> tuple[str, dict]:
    """A fabric whose wefts are 1/4 to 4 times as thick as its warps; one in four of any weave."""
    ratio = float(np.exp(rng.uniform(-np.log(4), np.log(4))))
    return random_row(rng, name, family="pattern" if rng.random() < 0.25 else "", ratio=ratio)


def _direction(
    rng: np.random.Generator, direction: str, spacing: float, widths: tuple[float, float]
) -> dict:
    return {
        f"{direction}_density_per_mm": 1 / spacing,
        f"{direction}_width_mm": spacing * float(rng.uniform(*widths)),
        f"{direction}_crimp": float(np.exp(rng.uniform(np.log(0.0005), np.log(0.03)))),
    }


def _thickness(rng: np.random.Generator, row: dict, ratio: float | None) -> dict:
    """One thickness, drawn around what the two crimps imply for yarns of about that ratio of thicknesses."""
    from fabric_cad.model.lengths import slope_from_crimp

    repeat = row["over"] + row["under"] if "over" in row else row.get("harness", 2)
    total = 0.0
    for direction, crossed in (("weft", "warp"), ("warp", "weft")):
        a, c = 1 / row[f"{crossed}_density_per_mm"], row[f"{crossed}_width_mm"]
        total += float(slope_from_crimp(row[f"{direction}_crimp"], repeat / 2 * a, c, a - c)) * (
            a - c / 2
        )
    if ratio is not None:
        return {"weft_thickness_mm": total * ratio / (1 + ratio)}
    kind = str(rng.choice(["weft_thickness_mm", "warp_thickness_mm", "fabric_thickness_mm"]))
    if kind == "fabric_thickness_mm":
        return {kind: total * float(rng.uniform(0.98, 1.2))}
    return {kind: total * float(rng.uniform(0.35, 0.65))}


def random_general_row(
    rng: np.random.Generator, name: str = "general", form: str = "", family: str = ""
) -> tuple[str, dict]:
    """The same with contact chords of 0.6 to 1 of the width, offsets to 0.2 of the half chord, and
    all three lateral forms (round ones with chords from 0.93, below which few arcs fit)."""
    family, row = random_row(rng, name, family=family)
    form = form or str(rng.choice(["lenticular", "flat", "round"]))
    row = {
        column: value
        for column, value in row.items()
        if column not in ("section", "lateral_height_mm")
    }
    row["section"] = form
    if form == "flat":
        row["lateral_height_mm"] = 0.01 * row["weft_width_mm"]
    for direction in ("weft", "warp"):
        if f"{direction}_width_mm" not in row:
            continue
        width = row[f"{direction}_width_mm"]
        for side in ("top", "bottom"):
            share = float(rng.uniform(0.93, 0.99) if form == "round" else rng.uniform(0.6, 1.0))
            row[f"{direction}_contact_{side}_mm"] = share * width
            if rng.random() < 0.5:
                row[f"{direction}_offset_{side}_mm"] = (
                    float(rng.uniform(0.0, 0.2)) * share * width / 2
                )
    return family, row


def random_pattern_row(
    rng: np.random.Generator, name: str = "pattern", form: str = ""
) -> tuple[str, dict]:
    """A general row of any weave."""
    return random_general_row(rng, name, form, "pattern")


def flat_gaps(draw):
    """The same draw of (family, row), its float gaps flat."""

    def drawn(rng: np.random.Generator, *rest, **options) -> tuple[str, dict]:
        family, row = draw(rng, *rest, **options)
        return family, row | {"float_gap": "flat"}

    return drawn


DRAWS = {
    "standard": random_row,
    "general": random_general_row,
    "patterns": random_pattern_row,
    "narrow": random_narrow_row,
    "unequal": random_unequal_row,
    "flat-gaps": flat_gaps(random_pattern_row),
}
"""What draws the rows of each part of ``make stability``."""


def skin_of(fabric, yarn):
    """The skin of one yarn of a fabric."""
    from fabric_cad.yarn.swept import SweptYarn

    return SweptYarn(fabric, yarn).skin


def section_area(section) -> float:
    """Area of a section, mm2, by Green's theorem along its outline (exact for parabolas)."""
    from fabric_cad.pictures.plots import section_outline

    v, z = section_outline(section, 4001)
    return float(np.sum(v[:-1] * z[1:] - v[1:] * z[:-1]) / 2)


TWILL32 = {
    "name": "twill32",
    "over": 3,
    "under": 2,
    "weft_density_per_mm": 0.35,
    "weft_width_mm": 2.4,
    "weft_crimp": 0.004,
}
UNBALANCED = {
    "name": "unbalanced",
    "weft_density_per_mm": 0.25,
    "weft_width_mm": 2.8,
    "weft_crimp": 0.006,
    "warp_density_per_mm": 0.22,
    "warp_width_mm": 3.3,
    "warp_crimp": 0.003,
}
