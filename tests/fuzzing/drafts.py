"""Weaving drafts (.wif) of several programs' manners, spoilt."""

from __future__ import annotations

import re

import numpy as np

from .mutations import ODD_TEXTS, encoded, pick, spoil_bytes, spoil_text
from .trial import Trial

PLACE = r"draft\.wif(:\d+: |: \[[A-Z ]+\]|: not a weaving draft|: (warp|weft) \d+)"


def sound(rng: np.random.Generator) -> str:
    """A draft of a twill on 4 to 8 shafts, by tie-up and treadling or by liftplan."""
    shafts = int(rng.integers(4, 9))
    warps, wefts = (shafts * int(rng.integers(1, 6)) for _ in range(2))
    straight = [f"{number + 1}={number % shafts + 1}" for number in range(max(warps, wefts))]
    ties = [f"{number + 1}={number + 1},{(number + 1) % shafts + 1}" for number in range(shafts)]
    lifts = [
        f"{number + 1}={number % shafts + 1},{(number + 1) % shafts + 1}" for number in range(wefts)
    ]
    parts = {
        "WIF": [
            "Version=1.1",
            "Date=April 20, 1997",
            "Developers=wif@mhsoft.com",
            "Source Program=none",
        ],
        "CONTENTS": ["THREADING=yes", "WEAVING=yes", "COLOR TABLE=yes"],
        "WEAVING": [
            f"Shafts={shafts}",
            f"Treadles={shafts}",
            f"Rising Shed={pick(rng, ('true', 'no', '1'))}",
        ],
        "WARP": [f"Threads={warps}", "Units=centimeters", "Spacing=0.212", "Color=1"],
        "WEFT": [f"Threads={wefts}", "Units=inches", "Spacing=0.1"],
        "COLOR PALETTE": ["Entries=2", "Form=RGB", "Range=0,255"],
        "COLOR TABLE": ["1=255,255,255", "2=0,0,0"],
        "THREADING": straight[:warps],
    }
    if rng.random() < 0.5:
        parts |= {"LIFTPLAN": lifts}
    else:
        parts |= {"TIEUP": ties, "TREADLING": straight[:wefts]}
    return "\n\n".join("\n".join([f"[{name}]", *lines]) for name, lines in parts.items()) + "\n"


def trial(seed: int) -> Trial:
    """A spoilt draft given to ``wif``."""
    rng = np.random.default_rng((3, seed))
    text, level = sound(rng), rng.random()
    if level < 0.6:
        for _ in range(int(rng.integers(1, 4))):
            text = _spoil_line(rng, text)
    elif level < 0.85:
        text = spoil_text(rng, text)
    content = encoded(rng, text)
    content = spoil_bytes(rng, content) if level >= 0.85 else content
    command = ("wif", "draft.wif", "--name", "mine")
    return Trial("a spoilt draft", command, {"draft.wif": content}, PLACE, fresh=seed % 50 == 13)


def _spoil_line(rng: np.random.Generator, text: str) -> str:
    lines = text.split("\n")
    keys = [number for number, line in enumerate(lines) if "=" in line]
    heads = [number for number, line in enumerate(lines) if line.startswith("[")]
    if not (keys and heads):
        return text
    number, head = pick(rng, keys), pick(rng, heads)
    key, value = lines[number].split("=", 1)
    kind = int(rng.integers(8))
    if kind <= 1:
        numbers = (
            "0",
            "1",
            "9",
            "5001",
            "-1",
            "1.5",
            "1,2,99",
            ",",
            "1;2",
            "1 2",
            "10000000000",
            "²",
            "٣",
            "0,0",
            "yes",
        )
        lines[number] = f"{key}={pick(rng, numbers)}"
    elif kind == 2:
        lines[number] = f"{key}={pick(rng, ODD_TEXTS)}"
    elif kind == 3:
        lines[number] = (
            f"{pick(rng, ('0', '9999', '-1', '1', '²', '٣', '01', '1.0', *ODD_TEXTS))}={value}"
        )
    elif kind == 4:
        lines[head] = pick(
            rng,
            (
                "[]",
                "[WIF",
                "WIF]",
                "[  ]",
                "[WARP]",
                lines[head].lower(),
                lines[head] * 2,
                "[DEFAULT]",
            ),
        )
    elif kind == 5:  # a whole section away
        end = next((later for later in heads if later > head), len(lines))
        del lines[head:end]
    elif kind == 6:
        lines[number] = lines[number].replace(
            "=", pick(rng, (" = ", ":", "==", "=;", " ", "= ; no "))
        )
    else:
        number = re.sub(r"\d+", lambda digits: str(int(rng.integers(60))), value)
        lines[pick(rng, keys)] = f"{key}={number}"
    return "\n".join(lines)
