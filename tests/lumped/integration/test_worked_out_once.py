"""What follows from an object alone is worked out once, and forgotten with it."""

import gc

from lumped.model.once import once


class Thing:
    def __init__(self, size):
        self.size = size


def test_the_same_object_is_looked_at_once_and_an_equal_one_again():
    seen = []

    @once
    def doubled(of):
        seen.append(of.size)
        return 2 * of.size

    one, other = Thing(3), Thing(3)
    assert [doubled(one), doubled(one), doubled(other)] == [6, 6, 6]
    assert seen == [3, 3]


def test_what_has_gone_is_not_mistaken_for_what_took_its_place():
    @once
    def size(of):
        return of.size

    for k in range(50):
        assert size(Thing(k)) == k
        gc.collect(0)
