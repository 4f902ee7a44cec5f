"""Tests of a case are looked at side by side: the same as one after the other, and a stop keeps what is done."""

import time
from dataclasses import replace

import pytest

from tests.shared.small_case import small_case
from thermoscope.case_folder.folder import load_case
from validation import threads
from validation.comparison.compare import StoppedComparisonError, compare
from validation.threads import listening


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return load_case(small_case(tmp_path_factory.mktemp("beside"))).case


def test_a_comparison_in_threads_is_the_same(case, monkeypatch):
    alone = compare(case).document()
    monkeypatch.setattr(threads, "WORTH_A_THREAD", 0)
    assert compare(case).document() == alone


def test_a_stop_keeps_what_is_done(case, monkeypatch):
    monkeypatch.setattr(threads, "WORTH_A_THREAD", 0)
    several = replace(case, tests=tuple(replace(t, name=f"{t.name}-{k}") for k in range(4) for t in case.tests))

    def stop(message):
        if message.startswith("(4"):  # three are done
            raise KeyboardInterrupt

    with listening(stop), pytest.raises(StoppedComparisonError) as stopped:
        compare(several)
    known, every = [t.name for t in stopped.value.so_far.tests], [t.name for t in several.tests]
    assert len(known) >= 3
    assert known == [name for name in every if name in known]


def test_what_has_not_begun_is_not_waited_for():
    done = []

    def piece(k):
        time.sleep(0.02)
        done.append(k)

    def stop(message):
        raise KeyboardInterrupt

    with listening(stop), pytest.raises(KeyboardInterrupt):
        threads.side_by_side(piece, range(1000))
    assert len(done) < 100
