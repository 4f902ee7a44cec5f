"""Temperatures that a Motor-CAD file stores, against the network of the machine imported from it.

    python benchmarks/peers/stored_temperatures.py FILE.mot [--json FILE] [--page]

The file stores a steady state and not the losses that made it. What `thermoscope model import --case` says of it is
shown as a table. With --page it goes into docs/how-to/import.md.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geom import import_draft
from scripts.published import ROOT, benchmark_parser, publish, table, write_json
from thermoscope.commands.model.stored_losses import loss_words, nearest_losses, steady_rises

PAGE = ROOT / "docs" / "how-to" / "import.md"


def page(result: Mapping[str, Any]) -> str:
    """Markdown: a row per stored temperature, and the losses and films in words."""
    rows = [(f"`{r['place']}`", f"{r['stored_K']:.1f}", f"{r['ratio']:.2f}") for r in result["rows"]]
    return "\n".join(
        [table(["stored in the file", "rise over the inlet (K)", "ours over it"], rows), "", *loss_words(result)]
    )


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    draft = import_draft(given.file)
    result = nearest_losses(steady_rises(draft, draft.surroundings | {"ambient": draft.readings["Ambient"]}))
    print(page(result))
    write_json(given.json, {"file": given.file.name, **result})
    if given.page:
        publish(PAGE, "stored", page(result))


if __name__ == "__main__":
    main()
