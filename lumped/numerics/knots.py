"""Which knots of a record a run needs: those between which all that drives it is a parabola. Compiled on its own."""

from __future__ import annotations

from lumped.numerics.jit import entry, inner, inner_finite, pasted


@inner_finite
def _missed(time, value, bulge, line):
    """The most that a parabola from the first knot to the last misses of a curve, at all knots and halfway between.

    line (3,) : of the parabola its value at the first knot, its rise from there to the last, its bulge
    """
    last = time.size - 1
    most, first, over, f0, rise, four = 0.0, time[0], 1.0 / (time[last] - time[0]), line[0], line[1], 4.0 * line[2]
    for k in range(1, last + 1):
        s = (time[k] - first) * over
        m = 0.5 * (s + (time[k - 1] - first) * over)
        at_knot = abs(f0 + s * (rise + (1.0 - s) * four) - value[k])
        halfway = abs(f0 + m * (rise + (1.0 - m) * four) - 0.5 * (value[k] + value[k - 1]) - bulge[k])
        larger = at_knot if at_knot > halfway else halfway
        most = larger if larger > most else most
    return most


@inner
def _follows(time, value, bulge, whole, allowed, line, i, j):
    """Whether parabolas from knot i to knot j that keep all integrals are where every curve is."""
    span = time[j] - time[i]
    for c in range(len(value)):
        f0, f1 = value[c, i], value[c, j]
        line[0], line[1], line[2] = f0, f1 - f0, 1.5 * ((whole[c, j] - whole[c, i]) / span - 0.5 * (f0 + f1))
        limit = max(allowed[c, 0], allowed[c, 1] * max(abs(f0), abs(f1)))
        if _missed(time[i : j + 1], value[c, i : j + 1], bulge[c, i : j + 1], line) > limit:
            return False
    return True


@inner
def _reached(time, value, bulge, whole, allowed, line, i, width, last):
    """The farthest knot found, up to `last`, to which parabolas from knot i follow: at least the next.

    width : where to look first
    """
    good, bad = i + 1, last + 1
    while i + width <= last and width > 1:
        if _follows(time, value, bulge, whole, allowed, line, i, i + width):
            good, width = i + width, 2 * width
        else:
            bad = i + width
            break
    if i + width > last and good < last:
        if _follows(time, value, bulge, whole, allowed, line, i, last):
            return last
        bad = last
    while bad - good > max(1, (good - i) // 16):  # a sixteenth more is not worth another look
        between = (good + bad) // 2
        if _follows(time, value, bulge, whole, allowed, line, i, between):
            good = between
        else:
            bad = between
    return good


@pasted
def _integrated(time, value, bulge, whole):
    """The integrals of all curves from the first knot."""
    for c in range(len(value)):
        acc = 0.0
        whole[c, 0] = 0.0
        for k in range(1, time.size):
            acc += (time[k] - time[k - 1]) * (0.5 * (value[c, k] + value[c, k - 1]) + bulge[c, k] / 1.5)
            whole[c, k] = acc


@entry
def needed(time, value, bulge, allowed, whole, line, knot):
    """The knots a run needs, into knot; how many there are.

    time (nk,) s;  value (nc, nk) curves at the knots;  bulge (nc, nk) how far each is above the mean of both ends in
    the middle before a knot;  allowed (nc, 2) what a parabola may miss: at all, as a share
    whole (nc, nk) : their integrals from the first knot, filled here;  line (3,) scratch
    """
    _integrated(time, value, bulge, whole)
    i, count, width, jump = 0, 1, 2, 1
    knot[0] = 0
    while i < time.size - 1:
        while jump < time.size and (jump <= i or time[jump] > time[jump - 1]):
            jump += 1
        j = _reached(time, value, bulge, whole, allowed, line, i, max(width, 2), jump - 1) if jump > i + 1 else i + 1
        width, i = j - i, j
        knot[count] = j
        count += 1
    return count
