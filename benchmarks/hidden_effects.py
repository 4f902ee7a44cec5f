"""Does the diagnosis name what is hidden? Machines made by physics of their own, their truth in labels it never sees.

    python benchmarks/hidden_effects.py --seeds dev --count 12 --classes nothing one fault --json FILE

Every case is one line of OUT/answers.jsonl and one of OUT/labels.jsonl; a run that is started again with the same OUT
goes on where it stopped, `--score` only scores. Sizes were measured on machines of their own; "test" is for reporting.
`--cases DIR` asks about folders of another generator and scores them alike.
"""

import argparse
from pathlib import Path

from hidden import sizes
from hidden.cases import SHARES, plan
from hidden.evidence import audit, sums, temper
from hidden.kinds import KINDS
from hidden.odds import reliability
from hidden.page import diagram, markdown
from hidden.run import Wanted, answered, pairs, run, run_folders
from hidden.score import met, rows

from scripts.published import benchmark_parser, json_lines, write_rows


def arguments() -> argparse.Namespace:
    parser = benchmark_parser(__doc__)
    parser.add_argument(
        "--cases", type=Path, help="folders of another generator with a truth.json, instead of our kinds"
    )
    parser.add_argument("--words", type=Path, help="its words in the catalogue's, TOML (hidden/folders.py has some)")
    parser.add_argument("--seeds", choices=("dev", "test"), default="dev")
    parser.add_argument("--count", type=int, default=24, help="cases; of folders: of every class")
    parser.add_argument("--skip", type=int, default=0, help="leave out the first cases of the plan")
    parser.add_argument("--classes", nargs="+", choices=tuple(SHARES), default=list(SHARES))
    parser.add_argument("--kinds", nargs="+", choices=tuple(KINDS), default=list(KINDS))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--plan", action="store_true", help="also rank next tests (slower)")
    parser.add_argument("--peers", action="store_true", help="also ask the simpler methods of hidden/peers.py")
    parser.add_argument("--after", action="store_true", help="also add what is claimed and carry out the proposed test")
    parser.add_argument("--out", type=Path, default=None, help="folder of answers and labels, to be resumed")
    parser.add_argument("--score", action="store_true", help="only score what OUT has")
    parser.add_argument("--sums", action="store_true", help="only ask sound machines how much doubt in sum they need")
    parser.add_argument("--audit", action="store_true", help="only hold log evidence against integrals by sampling")
    parser.add_argument("--samples", type=int, default=200, help="of each of these integrals")
    parser.add_argument("--nested", action="store_true", help="by nested sampling too: needs dynesty, hours")
    parser.add_argument("--sizes", action="store_true", help="measure the units of size anew and stop")
    parser.add_argument("--page", type=Path, help="the tables of docs/hidden-effects.md, as Markdown")
    return parser.parse_args()


def main() -> None:
    a = arguments()
    if a.sizes:
        return sizes.write(a.kinds)
    if a.sums:
        file = (a.out or Path("out/hidden-sums")) / "sums.jsonl"
        sums.run(a.seeds, a.skip, a.count, a.kinds, file)
        return print("\n".join(sums.markdown(json_lines(file))))
    labels = plan(a.seeds, a.skip + a.count, a.classes, a.kinds)[a.skip :]
    if a.audit:
        return print(audit.run(labels, a.out or Path("out/hidden-audit"), a.samples, a.nested))
    out = a.out or Path(f"out/hidden-{a.cases.resolve().name if a.cases else a.seeds}")
    if not a.score and a.cases:
        run_folders(a.cases, out, a.classes, a.count, a.jobs, a.words)
    elif not a.score:
        run(labels, out, Wanted(a.plan, a.peers, a.after), a.jobs)
    table = rows(pairs(out))
    for r in table:
        reached = {True: "met", False: "short", None: ""}[met(r)]
        told = f"  n {r['n']:3d}  " if "n" in r else ""
        told += f"95 % {r['ci95'][0]:.2f} to {r['ci95'][1]:.2f}  " if "ci95" in r else ""
        told += f"{r.get('target', '')} {reached}"
        told += f"{r['peer_name']} {r['peer']:.3g}" if "peer" in r else ""
        print(f"{r['case']:32s} {r['measure']:30s} {r['ours']:8.3g} {r['unit']}{told}")
    if a.page:
        a.page.write_text(
            "\n\n".join(
                [
                    markdown(table),
                    diagram(reliability(pairs(out))),
                    temper.markdown(temper.folds(pairs(out))),
                    temper.sharpness_folds(pairs(out)),
                ]
            )
            + "\n"
        )
    write_rows(a.json, "hidden effects", table, seeds=a.seeds, cases=len(answered(out)))


if __name__ == "__main__":
    main()
