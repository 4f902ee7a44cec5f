"""Which knots of a record a run needs: those between which all that drives it is a parabola. Compiled on its own."""

from __future__ import annotations

from lumped.numerics.jit import entry, inner


@inner
def _follows(time, value, middle, whole, allowed, i, j):
    """Whether parabolas from knot i to knot j are where every curve is, at all knots and middles between them."""
    for k in range(i + 1, j + 1):
        if time[k] == time[k - 1]:
            return False
    span = time[j] - time[i]
    for c in range(len(value)):
        f0, f1 = value[c, i], value[c, j]
        bulge = 1.5 * ((whole[c, j] - whole[c, i]) / span - 0.5 * (f0 + f1))
        limit = max(allowed[c, 0], allowed[c, 1] * max(abs(f0), abs(f1)))
        for k in range(i + 1, j + 1):
            s = (0.5 * (time[k] + time[k - 1]) - time[i]) / span
            if abs(f0 + s * (f1 - f0) + 4.0 * s * (1.0 - s) * bulge - middle[c, k]) > limit:
                return False
            s = (time[k] - time[i]) / span
            if abs(f0 + s * (f1 - f0) + 4.0 * s * (1.0 - s) * bulge - value[c, k]) > limit:
                return False
    return True


@inner
def _reached(time, value, middle, whole, allowed, i, width):
    """The farthest knot found to which parabolas from knot i follow: at least the next; width : where to look first."""
    last = time.size - 1
    good, bad = i + 1, last + 1
    while i + width <= last and width > 1:
        if _follows(time, value, middle, whole, allowed, i, i + width):
            good, width = i + width, 2 * width
        else:
            bad = i + width
            break
    if i + width > last and good < last:
        if _follows(time, value, middle, whole, allowed, i, last):
            return last
        bad = last
    while bad - good > max(1, (good - i) // 16):  # a sixteenth more is not worth another look
        between = (good + bad) // 2
        if _follows(time, value, middle, whole, allowed, i, between):
            good = between
        else:
            bad = between
    return good


@entry
def needed(time, value, middle, whole, allowed, knot):
    """The knots a run needs, into knot; how many there are.

    time (nk,) s;  value, middle (nc, nk) curves at the knots and in the middle before each
    whole (nc, nk) their integrals from the first knot;  allowed (nc, 2) what a parabola may miss: at all, as a share
    """
    i, count, width = 0, 1, 2
    knot[0] = 0
    while i < time.size - 1:
        j = _reached(time, value, middle, whole, allowed, i, max(width, 2))
        width, i = j - i, j
        knot[count] = j
        count += 1
    return count
