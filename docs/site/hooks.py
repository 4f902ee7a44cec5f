"""What the site takes from the folders: a gallery of examples/, a machine to turn, every page under "Explained"."""

import ast
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
MACHINE = "road-test-viewer.html"
PICTURES = ROOT / "docs" / "images" / "gallery"


def on_config(config: Any) -> Any:
    """Pages beside those that mkdocs.yml lists are explanations: of data, of families, of results."""
    explained = next(entry["Explained"] for entry in config.nav if isinstance(entry, dict) and "Explained" in entry)
    top = [entry for entry in config.nav if isinstance(entry, str)]
    docs = ROOT / "docs"
    pages = [
        p.relative_to(docs).as_posix()
        for p in sorted([p for pattern in ("*.md", "families/*.md", "papers/*.md") for p in docs.glob(pattern)])
    ]
    explained += [page for page in pages if page not in top and page not in explained]
    return config


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Links to files of the checkout that are no pages become their names; what does not exist stays, and fails."""
    home = ROOT / "docs" / Path(page.file.src_uri).parent

    def named(link: re.Match[str]) -> str:
        path = (home / link[2]).resolve()
        outside = path.is_relative_to(ROOT) and not path.is_relative_to(ROOT / "docs")
        return f"{link[1]} (`{path.relative_to(ROOT)}`)" if outside and path.exists() else link[0]

    return re.sub(r"(?<!!)\[([^\]]+)\]\((\.\./[^)#]+)\)", named, markdown)


def on_files(files: Any, config: Any) -> Any:
    """Add gallery.md and the machine in the browser's own GL."""
    files.append(File.generated(config, MACHINE, content=machine()))
    files.append(File.generated(config, "gallery.md", content=gallery(sorted((ROOT / "examples").glob("*.py")))))
    return files


def machine() -> str:
    """The shipped road test, as `thermoscope show viewer road-test` writes it."""
    from thermoscope.case_folder.folder import find_case, load_case
    from thermoscope.commands.show.viewer import viewer_page

    return viewer_page(load_case(find_case("road-test")), lambda message: None)


def gallery(examples: list[Path]) -> str:
    """One section per example: its first sentence, its pictures, its code."""
    parts = [
        "# Gallery",
        f"[A motor to turn, cut and play]({MACHINE}), an hour on the road: one file, no network.",
        "Each of these runs as it stands: `python examples/NAME.py`. The tests run them too.",
        "",
    ]
    return "\n\n".join(parts + [section(path) for path in examples]) + "\n"


def section(path: Path) -> str:
    code = path.read_text(encoding="utf-8")
    said = ast.get_docstring(ast.parse(code)) or path.stem
    title, _, rest = said.partition("\n")
    drawn = sorted(PICTURES.glob(f"{path.stem}*"))
    pictures = [f"![Picture {i} of: {title}](images/gallery/{p.name})" for i, p in enumerate(drawn, 1)]
    hidden = "\n".join(f"    {line}" for line in f"```python\n{code}```".splitlines())
    return "\n\n".join(
        [f"## {title.rstrip('.')}", rest.strip("\n"), *pictures, f'??? example "{path.name}"\n\n{hidden}']
    )
