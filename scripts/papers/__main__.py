"""Write docs/papers: python -m scripts.papers"""

from pathlib import Path

from scripts.papers import series_dc, thermal_test

HERE = Path(__file__).resolve().parents[2] / "docs" / "papers"
PAGES = {"series-dc-cooling.md": series_dc, "thermal-test-procedure.md": thermal_test}


def main() -> None:
    (HERE / "images").mkdir(parents=True, exist_ok=True)
    for name, module in PAGES.items():
        (HERE / name).write_text(module.text(), encoding="utf-8")
        for file, figure in module.pictures().items():
            figure.savefig(HERE / "images" / file, dpi=90)


if __name__ == "__main__":
    main()
