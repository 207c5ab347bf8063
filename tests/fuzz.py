"""Broken input, kills and two runs at once: ``python tests/fuzz.py [--part PART] [--seeds FIRST-END]``.

Every trial is drawn from its seed and runs in a folder of its own, in a process with a time limit. What fails
is told with its part and seed; ``--part tables --seeds 17-18 --show`` shows that one alone, its files kept.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from fuzzing import command_lines, drafts, kills, tables, tomls, twice  # noqa: E402
from fuzzing.trial import faults, run_trial  # noqa: E402
from stability import seed_range  # noqa: E402


@dataclass(frozen=True)
class Result:
    """What became of one trial: ``ending`` a word for the counts, ``wrong`` empty where all is as it must be."""

    part: str
    seed: int
    name: str
    ending: str
    wrong: tuple[str, ...]
    seconds: float

    def __str__(self) -> str:
        return f"{self.part} {self.seed}: {self.name}: {'; '.join(self.wrong) or self.ending} ({self.seconds:.2f} s)"


_COMMANDS = {
    "tables": tables.trial,
    "toml": tomls.trial,
    "drafts": drafts.trial,
    "commands": command_lines.trial,
}
_RUNS: dict[str, Callable] = {"kills": kills.kill_run, "twice": twice.run_twice}
COUNTS = {"tables": 500, "toml": 300, "drafts": 200, "commands": 75, "kills": 100, "twice": 20}
"""Trials of each part in a whole run."""


def try_one(part: str, seed: int) -> Result:
    """One trial."""
    if part in _RUNS:
        start = time.perf_counter()
        name, ending, wrong = _RUNS[part](seed)
        return Result(part, seed, name, ending, tuple(wrong), time.perf_counter() - start)
    trial = _COMMANDS[part](seed)
    ended = run_trial(trial)
    return Result(
        part, seed, trial.name, f"status {ended.status}", tuple(faults(trial, ended)), ended.seconds
    )


def try_part(part: str, seeds: range, workers: int) -> list[Result]:
    """All trials of a part, in worker processes that have loaded what it takes; failures are printed as they come."""
    results = []
    with multiprocessing.get_context("fork").Pool(workers, _load, (part,)) as pool:
        for result in pool.imap_unordered(_try, [(part, seed) for seed in seeds]):
            results.append(result)
            if result.wrong:
                print(result, flush=True)
    return results


def _load(part: str) -> None:
    kills.load_cad() if part in _RUNS else _load_light()


def _load_light() -> None:
    import fabric_cad.measured.wif
    import fabric_cad.model.identification
    import fabric_cad.model.scatter
    import fabric_cad.study.run  # noqa: F401


def _try(of: tuple[str, int]) -> Result:
    return try_one(*of)


def _show(part: str, seed: int) -> None:
    """A trial's command, files and output in full."""
    trial = _COMMANDS[part](seed)
    folder = Path("build", "fuzz", f"{part}-{seed}")
    for name, content in trial.files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).mkdir(exist_ok=True) if content is None else (folder / name).write_bytes(
            content
        )
    ended = run_trial(trial)
    print(
        f"{trial.name}; files in {folder}\narguments {trial.arguments!r}\nstatus {ended.status}, left {ended.left}"
    )
    print(f"--- output\n{ascii_lines(ended.out)}\n--- errors\n{ascii_lines(ended.err)}")
    print("--- wrong:", "; ".join(faults(trial, ended)) or "nothing")


def ascii_lines(text: str) -> str:
    """A text with all but plain ASCII escaped, so that it can be looked at; long lines cut."""
    return "\n".join(ascii(line)[1:-1][:400] for line in text.split("\n"))


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--part", choices=COUNTS, action="append", help="default: all")
    parser.add_argument(
        "--seeds", type=seed_range, metavar="FIRST-END", help="default: those of a whole run"
    )
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--show", action="store_true", help="show every trial of the part in full")
    settings = parser.parse_args()
    fine = True
    for part in settings.part or COUNTS:
        seeds = settings.seeds or range(COUNTS[part])
        if settings.show and part in _COMMANDS:
            for seed in seeds:
                _show(part, seed)
            continue
        start = time.perf_counter()
        results = try_part(part, seeds, settings.workers)
        counts = Counter(result.ending for result in results)
        wrong = sum(bool(result.wrong) for result in results)
        slowest = max((result.seconds for result in results), default=0.0)
        summary = ", ".join(f"{number} {ending}" for ending, number in sorted(counts.items()))
        print(
            f"{part}: {len(results)} trials: {summary}; {wrong} wrong; the slowest {slowest:.2f} s; "
            f"{time.perf_counter() - start:.0f} s in all",
            flush=True,
        )
        fine = fine and not wrong
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
