"""Measured recordings from raw file to last improvement, with no hand on them: error on tests that nobody used.

    python benchmarks/recordings.py [--only hust-13 tclab] [--folder DATA] [--most 6] [--json FILE]

Shipped recordings (`hust-13`: all thirteen temperatures from the raw files, the network guessed from the columns;
`hust` and `tclab`: with the network that is declared) and those of every folder in --folder, which `test new --yes`
imports. Of files in a folder a third is kept back, of a single file the last third of its rows. Then `explain
improve --yes` is done. Nothing looks at what is kept back before the end. The yardsticks learn from the same tests.
--page FILE puts the table of a JSON file into the docs and the README.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import numpy as np

from geom.errors import ThermoscopeError
from measured.case import Case
from scripts.published import benchmark_parser, cpu_s, publish, table, write_json
from thermoscope.case_folder.folder import find_case, load_case
from validation.comparison.compare import Comparison, pooled
from validation.revision.improvement import MOST, Improvement, Supervisor, improve, singletons
from validation.yardstick.words import model_error, scoped
from validation.yardstick.yardstick import KINDS, Yardstick, yardstick

ROOT = Path(__file__).parents[1]
PAGES = (ROOT / "docs" / "recordings.md", ROOT / "README.md")
RAW = ("csv", "gz", "txt", "lvm", "xlsx", "tdms", "mf4", "parquet")
KEPT_BACK = ("id_5", "id_8", "id_11", "id_15")  # those of the paper
HEAD: tuple[str, ...] = ("recording", "tests (kept back)", "no model", "black box", "free network", "published")
HEAD += ("declared", "calibrated", "at the end", "sensors as fitted", "over the best", "added", "CPU (s)")
AUTHORS = ("hust",)  # cases whose network as declared is the model that the authors of the recording published
FEWEST = 60  # rows of a third of a file: fewer are steady points, no course of time


@dataclass(frozen=True)
class Source:
    """Where a recording comes from.

    files : raw, to be imported; or `case`, a folder that declares its network;  kept : names of the tests to keep back
    period : s between rows without a clock
    """

    name: str
    files: tuple[Path, ...] = ()
    case: str = ""
    kept: tuple[str, ...] = ()
    period: float | None = None


@dataclass(frozen=True)
class Row:
    """Rms errors (K) over the tests kept back, of our model step by step and of the yardsticks.

    steps : name of each step -> error, as sensors read
    fitted : at the end, with sensors as the fit has them from the other tests, which is what the yardsticks learn too
    cpu_s : from raw file to the last step;  published : its network comes with the case;  fault : why there is none
    """

    name: str
    tests: int = 0
    kept: int = 0
    sensors: int = 0
    yardsticks: dict[str, float] = field(default_factory=dict)
    steps: list[tuple[str, float]] = field(default_factory=list)
    fitted: float = float("nan")
    verdict: str = ""
    why: str = ""
    cpu_s: float = 0.0
    published: bool = False
    fault: str = ""

    @property
    def ratios(self) -> tuple[float, float]:
        """Ours at the end over the best yardstick: as sensors read, and as they are fitted."""
        best = min((x for x in self.yardsticks.values() if np.isfinite(x)), default=float("nan"))
        return (self.steps[-1][1] / best, self.fitted / best) if self.steps else (float("nan"), float("nan"))


def shipped() -> list[Source]:
    """What comes along."""
    raw = tuple(sorted((ROOT / "cases" / "hust-ipmsm" / "tests").glob("id_*.csv.gz")))
    hust = Source("hust-13", raw, kept=KEPT_BACK, period=1.0)
    return [hust, Source("hust", case="hust-ipmsm"), Source("tclab", case="tclab")]


def of_folder(folder: Path, scratch: Path) -> Iterator[Source]:
    """Every folder of recordings in a folder: its files as tests, or of a file its thirds."""
    for one in sorted(p for p in folder.iterdir() if p.is_dir()):
        files = sorted(f for f in one.iterdir() if f.suffix.removeprefix(".") in RAW)
        alike: dict[str, list[Path]] = {}
        for f in files:
            alike.setdefault(first_line(f), []).append(f)
        for same in alike.values():
            name = one.name if len(alike) == 1 else f"{one.name}-{same[0].name.partition('.')[0]}"
            if len(same) > 1:
                back = tuple(f.name.partition(".")[0] for f in (same[2::3] or same[1:]))
                yield Source(name, tuple(same), kept=back)
            elif same[0].suffix in (".csv", ".txt", ".lvm") and (thirds := cut(same[0], scratch / name)):
                yield Source(name, thirds, kept=(thirds[-1].stem,))


def first_line(file: Path) -> str:
    """What files of the same columns share; of a table without a header how many columns there are."""
    if file.suffix in (".gz", ".xlsx", ".tdms", ".mf4", ".parquet"):
        return file.suffix
    line = file.read_text(encoding="utf-8", errors="replace").partition("\n")[0]
    return line if re.search("[A-Za-z]{2}", line) else str(line.count(",") + line.count("\t"))


def cut(file: Path, into: Path) -> tuple[Path, ...]:
    """The thirds of a table, each with its header; () where they would be too short."""
    lines = file.read_text(encoding="utf-8", errors="replace").splitlines(keepends=True)
    header = lines[:1] if re.search("[A-Za-z]{2}", lines[0]) else []
    rows = lines[len(header) :]
    third = len(rows) // 3
    if third < FEWEST:
        return ()
    into.mkdir(parents=True, exist_ok=True)
    out = []
    for i, word in enumerate(("first", "second", "last")):
        out.append(into / f"{word}.csv")
        out[-1].write_text("".join([*header, *rows[i * third : (i + 1) * third]]), encoding="utf-8")
    return tuple(out)


def imported(source: Source, scratch: Path) -> Path:
    """The case that `test new --yes` makes of raw files, with the kept-back tests held out.

    Of all files it holds out the last. Where others are kept back the first network is learnt without any of them.
    """
    folder = scratch / f"case-{source.name}"
    if source.kept == (source.files[-1].name.partition(".")[0],):
        new_case(source, source.files, folder)
    else:
        taught = [f for f in source.files if f.name.partition(".")[0] not in source.kept]
        lesson = scratch / f"taught-{source.name}"
        new_case(source, taught, lesson)
        sheet = tomllib.loads(next((lesson / "tests").glob("*.toml")).read_text(encoding="utf-8"))
        places = [f"--place={name}={c['place']}" for name, c in sheet["columns"].items() if "place" in c]
        new_case(source, source.files, folder, ["--network", str(lesson / "network.toml"), *places])
    file = folder / "case.toml"
    text = re.sub(r'role = "[a-z-]+"', 'role = "validate"', file.read_text(encoding="utf-8"))
    for name in source.kept:
        text = re.sub(rf'(\[tests\."?{re.escape(name)}"?\]\nrole = )"validate"', r'\1"hold-out"', text)
    file.write_text(text.replace('role = "validate"', 'role = "calibrate"', 1), encoding="utf-8")
    return folder


def new_case(source: Source, files: Sequence[Path], folder: Path, more: Sequence[str] = ()) -> None:
    """A case of some of the files, as the command makes it."""
    period = ["--period", f"{source.period:g}"] if source.period else []
    command = ["thermoscope", "test", "new", *map(str, files), "--yes", *period, *more, "--out", str(folder)]
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "not imported")


def measured_row(source: Source, most: int, scratch: Path) -> Row:
    """One recording, from raw file to last step."""
    begin = cpu_s()
    try:
        folder = load_case(imported(source, scratch) if source.files else find_case(source.case))
        case = folder.case
        yard = yardstick(case)
        supervisor = Supervisor(singletons, suggest=True)
        result = improve(case, supervisor, most, tell, folder.settings.kinds)
    except (ThermoscopeError, RuntimeError) as fault:
        return Row(source.name, fault=str(fault).rpartition(": ")[2], cpu_s=cpu_s() - begin)
    if yard is None or not yard.hold_out:
        return Row(source.name, fault="no test kept back reads a sensor that others read", cpu_s=cpu_s() - begin)
    return row(source, case, yard, result, cpu_s() - begin)


def tell(message: str) -> None:
    """Progress, under the recording's name."""
    print(f"  {message}", file=sys.stderr)


def row(source: Source, case: Case, yard: Yardstick, result: Improvement, seconds: float) -> Row:
    """What came of it."""

    def error(comparison: Comparison) -> float:
        return model_error(yard, comparison)

    steps = [(s.effect or s.step, error(s.comparison)) for s in result.stairs]
    back = sum(t.role == "hold-out" for t in case.tests)
    sensors = len({c.name for t in case.tests for c in t.channels})
    counts = len(case.tests), back, sensors
    yards = {kind: float(yard.hold_out[kind]) for kind in KINDS}
    verdict = result.diagnosis.verdict
    rows = [replace(c, rmse_K=c.fitted_rmse_K) for c in scoped(yard, result.stairs[-1].comparison) if c.fitted_rmse_K]
    fitted = pooled(rows) if rows else steps[-1][1]
    return Row(source.name, *counts, yards, steps, fitted, verdict, result.why, seconds, bool(source.case))


def recordings_table(rows: Sequence[Row]) -> str:
    """As Markdown: what ran first, then why others did not."""
    cells = []
    for r in (r for r in rows if not r.fault):
        words = {name: f"{value:.2f}" for name, value in r.yardsticks.items()}
        added = [name for name, _ in r.steps if name not in ("start", "calibrate")]
        start = f"{r.steps[0][1]:.2f}" if r.published else ""
        row = [
            r.name,
            f"{r.tests} ({r.kept})",
            *(words[k] for k in KINDS),
            start if r.name in AUTHORS else "",
            start,
            f"{r.steps[min(1, len(r.steps) - 1)][1]:.2f}",
            f"**{r.steps[-1][1]:.2f}**",
            f"**{r.fitted:.2f}**",
            " / ".join(f"{x:.2f}" for x in r.ratios),
            ", ".join(added).replace("|", "\\|") or "nothing",
            f"{r.cpu_s:.0f}",
        ]
        cells.append(row)
    lines = [table(HEAD, cells)]
    ratios = np.array([r.ratios for r in rows if np.isfinite(r.ratios).all()])
    if ratios.size:
        middle, worst = (" / ".join(f"{x:.2f}" for x in of(ratios, axis=0)) for of in (np.median, np.max))
        lines += ["", f"Ours over the best yardstick: median {middle}, worst {worst} of {len(ratios)}."]
    lines += ["", *(f"{r.name}: {r.fault}" for r in rows if r.fault)]
    return "\n".join(lines).strip()


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--only", nargs="*", help="names of recordings")
    parser.add_argument("--folder", type=Path, help="further recordings, a folder each")
    parser.add_argument("--most", type=int, default=MOST, help="effects to add at most")
    parser.add_argument("--page", type=Path, help="a JSON file whose table goes into docs and README")
    options = parser.parse_args()
    if options.page:
        rows = [
            Row(**{k: v for k, v in r.items() if k != "ratios"}) for r in json.loads(options.page.read_text())["rows"]
        ]
        for page in PAGES:
            publish(page, "recordings", recordings_table(rows))
        return
    scratch = Path(tempfile.mkdtemp())
    try:
        sources = [*shipped(), *(of_folder(options.folder, scratch) if options.folder else ())]
        rows = []
        for source in (s for s in sources if not options.only or s.name in options.only):
            print(source.name, file=sys.stderr, flush=True)
            begin = time.monotonic()
            rows.append(measured_row(source, options.most, scratch))
            print(f"{source.name}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
            write_json(options.json, {"rows": [{**asdict(r), "ratios": r.ratios} for r in rows]})
        print(recordings_table(rows))
    finally:
        shutil.rmtree(scratch)


if __name__ == "__main__":
    main()
