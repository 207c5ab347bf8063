"""What the command prints: results, progress, notes and warnings; ``--quiet`` is heeded here."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .terminal import complain, say

if TYPE_CHECKING:
    from ..simulation.progress import CaseProgress
    from ..study.run import Progress

_CLEAR = "\r\033[K"  # to the start of a terminal's line, and clear it
_PAUSE = 10.0  # seconds between two lines of a study's progress, where it is no terminal


class Voice:
    """One command's voice: standard output for results, standard error for the rest.

    Progress is told in place on a terminal, and as a line each elsewhere.
    """

    def __init__(self, quiet: bool) -> None:
        self.quiet = quiet
        self._terminal = sys.stderr.isatty()
        self._told: set[str] = set()
        self._units_told = 0.0

    def result(self, text: str = "", end: str = "\n") -> None:
        """What a command exists to print, quiet or not."""
        say(text, end)

    def table(self, lines: Sequence[tuple[str, ...]]) -> None:
        """A result in columns, as wide as they need to be; the first line is the header."""
        widths = [max(map(len, column)) for column in zip(*lines)]
        for line in lines:
            cells = (cell.ljust(width) for cell, width in zip(line, widths))
            self.result("  ".join(cells).rstrip())

    def summary(self, text: str) -> None:
        """What files hold that were written, on standard output."""
        if not self.quiet:
            say(text)

    def files(self, paths: Iterable[Path]) -> None:
        """The files that were written."""
        for path in paths:
            self.summary(f"  {path}")

    def written(self, text: str, paths: Iterable[Path]) -> None:
        """What a row's files hold and where they are, before anything is said of the next row."""
        self.summary(text)
        self.files(paths)
        self.flush()

    def flush(self) -> None:
        """Let a reader of standard output have what was said so far."""
        if not self.quiet:
            sys.stdout.flush()

    def remark(self, text: str) -> None:
        """A note or progress, on standard error."""
        if not self.quiet:
            complain(text)

    def remark_once(self, about: str, text: str) -> None:
        """A note that is not repeated in this command, told by what it is ``about``."""
        if not self.quiet and self._is_first(about):
            complain(text)

    def alert(self, text: str) -> None:
        """What must be seen, quiet or not, on standard error."""
        complain(text)

    def warn(self, sentences: Iterable[str]) -> None:
        """Warnings, quiet or not, each once a command."""
        for sentence in sentences:
            if self._is_first(sentence):
                complain(f"warning: {sentence}")

    def stage(self, name: str, seconds: float | None) -> None:
        """A stage as it starts (no ``seconds``; on a terminal alone) or after it has run."""
        if seconds is not None:
            start = _CLEAR if self._terminal else ""
            self.remark(f"{start}  {name:14}{seconds:6.2f} s")
        elif self._terminal and not self.quiet:
            complain(f"{_CLEAR}  {name} ...", end="")

    def increment(self, progress: CaseProgress) -> None:
        """A load case before its first state, or an increment of the solver."""
        from ..simulation.progress import announced, told

        if self.quiet:
            return

        start, end = (_CLEAR, "") if self._terminal else ("", "\n")
        if progress.state:
            complain(f"{start}  {told(progress)}", end=end)
        else:
            complain(f"{start}  {announced(progress)}")

    def units(self, progress: Progress) -> None:
        """How far a study is; a line every ten seconds where it is not a terminal."""
        is_early = progress.seconds < self._units_told + _PAUSE
        if self.quiet or not self._terminal and is_early:
            return

        self._units_told = progress.seconds
        left = f"{_clock(progress.left)} left" if progress.rate else "starting"
        text = f"  {progress.finished} of {progress.units} units, {progress.rate:.2f}/s, {left}"
        if self._terminal:
            complain(f"{_CLEAR}{text}", end="")
        else:
            complain(text)

    def end_units(self) -> None:
        """Take a study's progress off the terminal."""
        if self._terminal and not self.quiet:
            complain(_CLEAR, end="")

    def _is_first(self, sentence: str) -> bool:
        """Whether a sentence was not told before; it counts as told from now on."""
        is_first = sentence not in self._told
        self._told.add(sentence)
        return is_first


def _clock(seconds: float) -> str:
    """A time as minutes and seconds, with hours where there are any."""
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)

    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"
