"""How far a case of loads is told to be, and how long its rest may take."""

import pytest

from fabric_cad.simulation.progress import (
    SECONDS_A_STATE,
    CaseWatch,
    announced,
    clock_words,
    expected_seconds,
    told,
)
from fabric_cad.simulation.solver import Progress


class Clock:
    now = 100.0  # s

    def __call__(self):
        return self.now


def run(states, seconds_a_state):
    """What is heard of a case whose states, in halves, take the same time each."""
    heard, clock = [], Clock()
    watch = CaseWatch(states, 2000, heard.append, clock)
    for job, count in enumerate(states):
        listen = watch.job(job)
        for step in range(1, count + 1):
            for increment, load in ((1, 0.5), (2, 1.0)):
                clock.now += seconds_a_state / 2
                listen(Progress(step, increment, load, step - 1 + load, load, count))
    return heard


@pytest.mark.parametrize("states", [(8,), (3, 4, 1), (1,)])
def test_states_count_over_all_jobs_and_time_left_is_exact_where_states_are_alike(states):
    first, *heard = run(states, 6.0)
    assert (first.state, first.states, first.seconds, first.left) == (0, sum(states), 0.0, None)
    assert [progress.state for progress in heard[::2]] == list(range(1, sum(states) + 1))
    assert [progress.left for progress in heard[:2]] == [
        None,
        None,
    ]  # the first state says nothing of the others
    for progress in heard[2:]:
        assert progress.seconds + progress.left == pytest.approx(6.0 * sum(states))
    assert sum(states) == 1 or heard[-1].left == 0.0


def test_what_is_expected_grows_with_states_and_elements():
    (first, *_) = run((4,), 1.0)
    assert first.expected == expected_seconds(4, 2000) == pytest.approx(4 * 2 * SECONDS_A_STATE)
    assert announced(first).startswith(
        f"4 states on 2000 hexahedra: about {clock_words(first.expected)} (likely "
    )


def test_an_increment_is_told_with_the_time_left_once_it_is_known():
    heard = run((40,), 6.0)
    assert told(heard[1]) == "state 1 of 40, increment 1: 50 % of its load"
    assert told(heard[20]) == "state 10 of 40, increment 2: 100 % of its load, about 3 min left"
    assert told(heard[-1]) == "state 40 of 40, increment 2: 100 % of its load"


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.4, "5 s"),
        (12, "10 s"),
        (54, "55 s"),
        (61, "1 min"),
        (200, "3 min"),
        (3590, "1 h"),
        (7900, "2 h 10 min"),
    ],
)
def test_a_time_is_told_no_finer_than_it_is_known(seconds, words):
    assert clock_words(seconds) == words


def test_nobody_listens():
    assert CaseWatch((3,), 10, None).job(0) is None
