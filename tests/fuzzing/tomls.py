"""Studies, ``simulation.toml`` and ``composite.toml``, spoilt in values, keys, nesting, text and bytes."""

from __future__ import annotations

import re

import numpy as np

from .mutations import ODD_TEXTS, encoded, pick, spoil_bytes, spoil_text
from .tables import SHIPPED
from .trial import Trial

STUDIES = (
    """base = "plain_measured"
depth = "identify"
design = "sobol"
samples = 8
seed = 1
figures = ["fabric_thickness_mm"]
keep = false
limit_seconds = 60

[factors]
weft_density_per_mm = "normal"
weft_width_mm = { distribution = "uniform" }
weft_crimp = { distribution = "normal", mean = 0.004, std = 0.0004 }
""",
    """base = "plain_unbalanced"
design = "latin-hypercube"
samples = 20

[factors]
weft_width_mm = { from = 2.6, to = 3.0 }
weft_crimp = { distribution = "normal", std = 0.0004 }
warp_crimp = [0.0025, 0.003, 0.0035]
""",
    """base = "twill32"
depth = "mesh"
design = "grid"

[mesh]
across = 8
through = 2

[factors]
over = [2, 3, 4]
weft_crimp = { from = 0.003, to = 0.005, steps = 3 }
section = ["lenticular", "flat"]
lateral_height_mm = [0.02]
""",
    """base = "satin5"
depth = "tension"
design = "one-at-a-time"
[factors]
step = [2, 3]
weft_crimp_percent = [0.3, 0.4]
""",
)
VALUES = (
    *(
        "0",
        "-1",
        "1",
        "1.5",
        "true",
        "false",
        '""',
        '"x"',
        "[]",
        "{}",
        "[[]]",
        "[1, 'a']",
        "{ a = 1 }",
        "inf",
        "-inf",
    ),
    *(
        "nan",
        "1e308",
        "-1e308",
        "5e-324",
        "9223372036854775807",
        "9223372036854775808",
        "1e5",
        str(10**30),
        "1" * 5000,
    ),
    *(
        "1979-05-27",
        "07:32:00",
        "1979-05-27T07:32:00Z",
        "0x10",
        "0b1",
        "1_000",
        "[" * 200 + "]" * 200,
    ),
    *(
        "[" * 3000 + "]" * 3000,
        "{ a = " * 3000 + "1" + " }" * 3000,
        '"' + "a" * 100_000 + '"',
        "'''\n'''",
        '"\\u202e"',
    ),
    *(
        '"\\u001b[31m"',
        '"normal"',
        '"uniform"',
        '"sobol"',
        "[0.1, inf]",
        "[nan]",
        "{ from = 1, to = 0 }",
        "[true]",
    ),
    *(
        "{ from = 0, to = inf }",
        "{ distribution = 3 }",
        "{ std = 0 }",
        '{ distribution = "normal", std = 1e300 }',
    ),
)
LEAVES = (
    r"build/study/((table\.(parquet|csv))|sensitivity\.(csv|png|svg|pdf)|costs\.csv|\.lock|units.*)"
)

PLACE = "{0}(:[0-9]+: |: [^ :]+: |: not TOML)"
"""What is wrong has a line, is a key that is missing, or the end of the file."""


def trial(seed: int) -> Trial:
    """A spoilt study, or one time in three a spoilt ``simulation.toml`` or ``composite.toml``."""
    rng = np.random.default_rng((2, seed))
    families = {f"families/{path.name}": path.read_bytes() for path in SHIPPED.glob("*.csv")}
    if seed % 3 == 2:
        return _settings_trial(
            rng, families, "composite.toml" if seed % 6 == 5 else "simulation.toml"
        )

    text = pick(rng, STUDIES)
    files = families | {"study.toml": toml_bytes(rng, text)}
    base = text.split('"')[1]
    place = PLACE.format(r"study\.toml")
    return Trial(
        f"a spoilt study of {base}",
        ("study", "study.toml"),
        files,
        place,
        LEAVES,
        fresh=seed % 50 == 12,
    )


_COMMANDS = {
    "simulation.toml": (("tension", "plain"), ("shear", "basket22"), ("tension", "twill32")),
    "composite.toml": (
        ("voxels", "plain", "--cells", "6x6x6"),
        ("voxels", "twintex_tpeet44", "--cells", "5x5x5"),
    ),
}
_ENDINGS = {"simulation.toml": ("--deck", "calculix"), "composite.toml": ()}


def _settings_trial(rng: np.random.Generator, families: dict[str, bytes], name: str) -> Trial:
    """A command that reads a spoilt file beside the family tables."""
    command = (*pick(rng, _COMMANDS[name]), *_ENDINGS[name])
    files = families | {
        f"families/{name}": toml_bytes(rng, (SHIPPED / name).read_text(encoding="utf-8"))
    }
    place, leaves = PLACE.format(rf"families/{re.escape(name)}"), r"build/\w+/voxels\.(npz|vti)"
    title = f"{' '.join(command)} by a spoilt {name}"
    return (
        Trial(title, command, files, place, leaves)
        if command[0] == "voxels"
        else Trial(title, command, files, place)
    )


def toml_bytes(rng: np.random.Generator, text: str) -> bytes:
    """A TOML file with something wrong or odd in it."""
    level = rng.random()
    if level < 0.7:
        for _ in range(int(rng.integers(1, 3))):
            text = _spoil_line(rng, text)
    elif level < 0.87:
        text = spoil_text(rng, text)
    content = encoded(rng, text)
    return spoil_bytes(rng, content) if level >= 0.87 else content


def _spoil_line(rng: np.random.Generator, text: str) -> str:
    lines = text.split("\n")
    keys = [number for number, line in enumerate(lines) if re.match(r"[\w.]+ *=", line)]
    if not keys:
        return text
    number = pick(rng, keys)
    key, value = lines[number].split("=", 1)
    kind = int(rng.integers(8))
    if kind <= 3:
        lines[number] = f"{key}= {pick(rng, VALUES)}"
    elif kind == 4:
        odd = pick(
            rng,
            (
                key.strip() + "x",
                key.strip().upper(),
                "a.b.c",
                '"' + key.strip() + '"',
                "''",
                '"\\u001b"',
                "x" * 500,
            ),
        )
        lines[number] = f"{odd} ={value}"
    elif kind == 5:
        lines[number] = (
            f"[{pick(rng, (key.strip(), 'rows', 'rows.plain', 'rows.plain.yarn', 'mesh', '[factors]', 'a.b'))}]"
        )
    elif kind == 6:
        inner = [match for match in re.finditer(r"-?\d[\d.e-]*|\"[^\"]*\"", value)]
        if inner:
            one = pick(rng, inner)
            lines[number] = f"{key}={value[: one.start()]}{pick(rng, VALUES)}{value[one.end() :]}"
    else:
        quoted = pick(rng, ODD_TEXTS).replace("\\", "\\\\").replace('"', '\\"')
        lines[number] = f'{key}= "{quoted}"'
    return "\n".join(lines)
