"""What a first run foretells of the stages of other cases."""

from benchmarks.console.progress import usual


def test_a_further_step_is_foretold_as_the_first_of_a_case_not_as_those_of_a_larger_one():
    small = {"reading": 1.0, "looking": 10.0, "refitting": 4.0}
    large = {"reading": 3.0, "looking": 20.0, "1 step": 1.0, "1 looking": 90.0, "2 step": 1.0, "2 looking": 90.0}
    found = usual([small, large])
    further = {"1 step": 0.0, "1 looking": 15.0, "1 refitting": 4.0}
    assert found == {"reading": 2.0, "looking": 15.0, "refitting": 4.0, **further}
    assert usual([small, small]) == small
