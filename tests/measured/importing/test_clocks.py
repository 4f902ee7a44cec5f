"""Clocks as people and loggers write them: how far the rows of a file are apart, and when they began."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest

from geom.errors import InputError
from measured.importing.case_files import read_runs
from measured.importing.clock import clock_of
from measured.importing.source import read_source

ROWS = np.arange(60)
BEGUN, NIGHT = datetime(2025, 11, 3, 8, 14, 30, tzinfo=UTC), datetime(2024, 12, 31, 23, 59, 59, tzinfo=UTC)


def dated(form, step_s, begun=BEGUN):
    return lambda k: (begun + timedelta(seconds=step_s * k)).strftime(form)


def file_of(folder, header, stamps, name="a.csv"):
    """Two columns of readings behind the cells of a clock, between the signs of its header."""
    sep = next(sign for sign in ";\t," if sign in header)
    rows = [sep.join((stamp, f"{20 + k / 10:.1f}", f"{k % 7}")) for k, stamp in enumerate(stamps)]
    (folder / name).write_text("\n".join([header, *rows]) + "\n")
    return folder / name


# header, cell (or cells) of the clock in row k, seconds from row to row
EVEN = {
    "points in a time of day": ("Data;Ora;T [°C];I [A]", dated("%d/%m/%Y;%H.%M.%S", 1), 1),
    "points, every minute": ("Dato,Klokkeslæt,T,I", lambda k: f"03-02-2025,{9 + k // 60:02d}.{k % 60:02d}.00", 60),
    "hours and minutes, by their unit": ("Time\tT\tI\nh:min\t°C\tA", lambda k: f"{k // 60}:{k % 60:02d}", 60),
    "minutes and seconds from hour to hour": ("Time,T [°C],I [A]", lambda k: f"{10 * k % 60:02d}:42.0", 600),
    "milliseconds of a day": ("ms_today,T_coil [C],I [A]", lambda k: f"{76231191 + 91 * k}", 0.091),
    "LabVIEW's seconds": ("X_Value\tT [C]\tI [A]", lambda k: f"{0.001 + k / 20:.3f}", 0.05),
    "hours as in French": ("heure,T bobine [°C],I [A]", lambda k: f"{10 + k // 60}h{k % 60:02d}", 60),
    "minus signs in the hour": ("time,T [°C],I [A]", dated("%Y-%m-%d_%H-%M-%S", 7), 7),
    "no noughts": ("time,T [°C],I [A]", lambda k: f"17.4.2024 10:{7 * k // 60}:{7 * k % 60}", 7),
    "no noughts in an hour": ("time,T [°C],I [A]", lambda k: f"10:{7 * k // 60}:{7 * k % 60}", 7),
    "a date beside it": ("date,time,T [°C],I [A]", lambda k: f"17.4.2024,10:{7 * k // 60}:{7 * k % 60}", 7),
    "a minus sign after a date": ("time,T [°C],I [A]", lambda k: f"2026-03-21-10:{k // 6:02d}:{10 * k % 60:02d}.5", 10),
    "minutes by their name": ("Minutes,T,I [A]", str, 60),
    "hours by their name": ("Stunden,T,I [A]", str, 3600),
    "ms alone": ("ms,T,I [A]", str, 1e-3),
    "s alone": ("s,T,I [A]", str, 1),
    "parts of a second": ("Time,T,I [A]", lambda k: f"{(58 + k) // 60}:{(58 + k) % 60:02d}.5", 1),
    "over midnight": ("Time,T,I [A]", dated("%H:%M:%S", 1, NIGHT), 1),
    "over noon at night": ("Time,T,I [A]", dated("%I:%M:%S %p", 1, NIGHT), 1),
    "zones that change": ("Time,T,I [A]", lambda k: f"2024-03-09T1{k % 2}:00:{k:02d}+0{k % 2}:00", 1),
    "over the year": ("Time,T,I [A]", dated("%d.%m.%Y %H:%M:%S", 1, NIGHT), 1),
    "since 1970": ("Time,T,I [A]", lambda k: f"{1710000000 + k}", 1),
    "ms since 1970": ("Time,T,I [A]", lambda k: f"{1710000000000 + 1000 * k}", 1),
    "days of a spreadsheet": ("Time,T,I [A]", lambda k: f"{45000 + k / 4:.2f}", 21600),
}


@pytest.mark.parametrize("kind", EVEN)
def test_how_far_rows_are_apart(tmp_path, kind):
    header, stamp, step_s = EVEN[kind]
    [(_, clock)] = read_runs(file_of(tmp_path, header, map(stamp, ROWS.tolist())))
    assert clock.seconds == pytest.approx(step_s * ROWS, abs=1e-3 * step_s)


@pytest.mark.parametrize(
    "stamp", ["%Y. %m. %d. %H:%M:%S", "%Y.%m.%d. %H:%M:%S", "%Y.%m.%d %H:%M:%S", "%d.%m.%Y. %H:%M:%S"]
)
def test_points_and_blanks_in_dates(tmp_path, stamp):
    [(_, clock)] = read_runs(file_of(tmp_path, "time,T_coil [C],I [A]", map(dated(stamp, 5), ROWS.tolist())))
    assert clock.start == pytest.approx(BEGUN.timestamp())
    assert clock.seconds == pytest.approx(5.0 * ROWS)


@pytest.mark.parametrize(
    "stamp",
    [
        *("lun. 03/06/2024", "mar. 04/06/2024", "Mo. 03.06.2024", "Di 04.06.2024", "mar 04/06/2024", "gio. 06/06/2024"),
        *("mié. 05/06/2024", "Wed 05/06/2024", "mar. 4 juin 2024", "Do., 6. Juni 2024", "mercoledì 5 giugno 2024"),
    ],
)
def test_days_of_the_week_before_a_date(tmp_path, stamp):
    """A Tuesday in French is no March."""
    stamps = [f"{stamp} 23:{k // 4:02d}:{15 * k % 60:02d}" for k in ROWS]
    [(_, clock)] = read_runs(file_of(tmp_path, "Horodatage;T_coil [°C];I [A]", stamps))
    assert clock.seconds == pytest.approx(15.0 * ROWS)
    day = int(next(word for word in stamp.replace("/", " ").replace(".", " ").split() if word.isdigit()))
    assert datetime.fromtimestamp(clock.start, UTC).strftime("%m-%d") == f"06-{day:02d}"


@pytest.mark.parametrize("stamp", [" 12/31  {:02d}:00:00", "31.12. {:02d}:00"])
def test_dates_without_a_year_are_a_clock_without_a_start(tmp_path, stamp):
    [(_, clock)] = read_runs(file_of(tmp_path, "Date/Time,T_coil [C],I [A]", [stamp.format(h) for h in range(1, 25)]))
    assert (clock.start, clock.end_s, clock.doubt) == (None, pytest.approx(23 * 3600.0), "")


@pytest.mark.parametrize(
    ("line", "step_s"),
    [("Rate,10 s", 10.0), ("Scan rate = 500 ms", 0.5), ("Messtakt:;10 s;;", 10.0), ("Sampling rate: 10 Hz", 1.0)],
)
def test_how_often_a_logger_reads(tmp_path, line, step_s):
    """By a line before the names; a frequency is none, nor a flow."""
    rows = "".join(f"{20 + k / 10:.1f},{k % 7}\n" for k in ROWS)
    (tmp_path / "a.csv").write_text(f"{line}\nflow rate,3 l/min\nT_winding [°C],I [A]\n{rows}")
    assert clock_of(read_source(tmp_path / "a.csv")).seconds == pytest.approx(step_s * ROWS)


def test_a_clock_that_slips_for_one_row_costs_that_row(tmp_path):
    at = [60 * k for k in range(240)]
    slips = [max(s - 180, 0) if k == 120 else s for k, s in enumerate(at)]
    back = [s - 1800 * (k >= 120) for k, s in enumerate(at)]
    two = [s - 180 * (k in (120, 121)) for k, s in enumerate(at)]
    slips, *backs = (
        [f"2025-03-01 {s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}" for s in of] for of in (slips, back, two)
    )
    [(_, clock)] = read_runs(file_of(tmp_path, "Time,T [°C],I [A]", slips))
    assert np.isnan(clock.seconds).sum() == 1
    assert "1 rows whose clock runs back" in clock.doubt
    for stamps in backs:
        with pytest.raises(InputError, match="runs back"):
            read_runs(file_of(tmp_path, "Time,T [°C],I [A]", stamps))
