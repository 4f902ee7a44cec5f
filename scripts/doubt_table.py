"""The table of doubt as docs/diagnosis.md shows it.

python -m scripts.doubt_table    prints it
"""

from measured.doubt import COSTS, PRIOR, RARE, SHAPE, TABLE, TEMPER


def doubt_table() -> str:
    """The table as docs/diagnosis.md shows it."""
    rows = [f"| {name} | {line.sd:g} {line.unit} | {line.reason} |" for name, line in TABLE.items()]
    shape = [f"| {name} | {line.sd:g} {line.unit} | {line.reason} |" for name, line in SHAPE.items()]
    odds = [f"| {name} | {100.0 * o.share:g} % | {o.reason} |" for name, o in PRIOR.items()]
    tempers = [f"| {name} | {o.share:g} | {o.reason} |" for name, o in TEMPER.items()]
    rare = [f"| {name} | x {o.share:g} | {o.reason} |" for name, o in RARE.items()]
    costs = [f"| {name} | {o.share:g} | {o.reason} |" for name, o in COSTS.items()]
    head = ["| doubt | one sigma | reason |", "|---|---|---|", *rows, ""]
    prior = ["| before the readings | share | reason |", "|---|---|---|", *odds, *rare, *tempers, ""]
    form = ["| shape | value | reason |", "|---|---|---|", *shape, ""]
    return "\n".join([*head, *form, *prior, "| statement | cost | reason |", "|---|---|---|", *costs])


if __name__ == "__main__":
    print(doubt_table())
