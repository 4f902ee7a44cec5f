"""Which knots of a record a run needs: those between which all that drives it is a parabola. Compiled on its own."""

from lumped.numerics.jit import entry, inner, inner_finite, pasted


@inner_finite
def _missed(time, value, bulge, line):
    """The most that a parabola from the first knot to the last misses of a curve, at all knots and halfway between.

    line (4,) : of the parabola its value at the first knot, its rise from there to the last, its bulge
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
def _follows(time, value, bulge, whole, tolerance, line, i, j):
    """Whether parabolas from knot i to knot j that keep all integrals are where every curve is.

    line[3] : the curve that was missed last, which is looked at first
    """
    span, count, last = time[j] - time[i], len(value), int(line[3])
    for k in range(count):
        c = (last + k) % count
        f0, f1 = value[c, i], value[c, j]
        line[0], line[1], line[2] = f0, f1 - f0, 1.5 * ((whole[c, j] - whole[c, i]) / span - 0.5 * (f0 + f1))
        limit = max(tolerance[c, 0], tolerance[c, 1] * max(abs(f0), abs(f1)))
        if _missed(time[i : j + 1], value[c, i : j + 1], bulge[c, i : j + 1], line) > limit:
            line[3] = c
            return False
    return True


@inner
def _reached(time, value, bulge, whole, tolerance, line, i, width, last):
    """The farthest knot found, up to `last`, to which parabolas from knot i follow: at least the next.

    width : where to look first
    """
    good, bad = i + 1, last + 1
    while i + width <= last and width > 1:
        if _follows(time, value, bulge, whole, tolerance, line, i, i + width):
            good, width = i + width, 2 * width
        else:
            bad = i + width
            break
    if i + width > last and good < last:
        if _follows(time, value, bulge, whole, tolerance, line, i, last):
            return last
        bad = last
    while bad - good > max(1, (good - i) // 16):  # a sixteenth more is not worth another look
        between = (good + bad) // 2
        if _follows(time, value, bulge, whole, tolerance, line, i, between):
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
def needed(time, value, bulge, tolerance, fixed, whole, line, knot):
    """The knots a run needs, into knot; how many there are.

    time (nk,) s;  value (nc, nk) curves at the knots;  bulge (nc, nk) how far each is above the mean of both ends in
    the middle before a knot;  tolerance (nc, 2) what a parabola may miss: at all, as a share;  fixed (nk,) which knots
    it needs in any case
    whole (nc, nk) : their integrals from the first knot, filled here;  line (4,) scratch
    """
    _integrated(time, value, bulge, whole)
    i, count, width, jump, stop = 0, 1, 2, 1, 1
    knot[0], line[3] = 0, 0.0
    while i < time.size - 1:
        while jump < time.size and (jump <= i or time[jump] > time[jump - 1]):
            jump += 1
        stop = max(stop, i + 1)
        while stop < jump - 1 and not fixed[stop]:
            stop += 1
        last = min(stop, jump - 1)
        j = _reached(time, value, bulge, whole, tolerance, line, i, max(width, 2), last) if last > i + 1 else i + 1
        width, i = j - i, j
        knot[count] = j
        count += 1
    return count


@entry
def halfway(every, left, far, limits, bulge, intervals):
    """How far a factor bulges halfway between samples, into bulge; the intervals worth a closer look, into intervals.

    How many these are, or -1 where the factor never changes by more than rounding.
    every : the factor at the samples, then halfway after those in `left`;  far (nt - 1,) whether an input moves far
    limits (4,) : of the largest factor what is rounding, of an interval's what is flat, what counts at least; and the
    largest factor, filled here;  bulge, intervals (nt,)
    """
    nt, scale, least, most = bulge.size, 0.0, every[0], every[0]
    for i in range(every.size):
        least = every[i] if every[i] < least else least
        most = every[i] if every[i] > most else most
    scale = max(abs(least), abs(most))
    if most - least <= limits[0] * scale:
        return -1
    for k in range(left.size):
        off = every[nt + k] - 0.5 * (every[left[k]] + every[left[k] + 1])
        if abs(off) > limits[0] * scale:
            bulge[left[k] + 1] = off
    count, small = 0, limits[2] * scale
    for i in range(1, nt):
        if far[i - 1] or abs(bulge[i]) > limits[1] * max(abs(every[i]), small):
            intervals[count] = i - 1
            count += 1
    limits[3] = scale
    return count


@entry
def moved(x, far, at_all, is_far):
    """Where an input moves between samples, and where by more than a share `far` of its largest, beside what is there.

    at_all, is_far (nt - 1,) : filled here
    """
    most = 0.0
    for i in range(x.size):
        most = max(most, abs(x[i]))
    for i in range(x.size - 1):
        step = abs(x[i + 1] - x[i])
        at_all[i] |= step > 0.0
        is_far[i] |= step > far * most


@entry
def placed(time, knot, indices, at, first, share):
    """Which samples end in the interval before every knot, into first (nk + 1,), and where in it, into share (nt,).

    time (nt,), knot (nk,) s;  at (nt,), indices (nk,) : which of all knots they are
    """
    j = 0
    first[0] = 0
    for t in range(time.size):
        while indices[j] < at[t]:
            j += 1
            first[j] = t
        share[t] = 1.0 if indices[j] == at[t] else (time[t] - knot[j - 1]) / (knot[j] - knot[j - 1])
    while j < knot.size:
        j += 1
        first[j] = time.size
