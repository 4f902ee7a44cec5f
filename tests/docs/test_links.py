"""Links between the project's pages lead somewhere on the code host: to a file or folder that is in the repository."""

import os
import re
import subprocess

import pytest

LINK = re.compile(r"\]\(([^)\s]+)\)")
ELSEWHERE = re.compile(r"[a-z]+:|#")


def dead(page, text, tracked):
    """Targets of relative links of a page that are no tracked file and no folder of one."""
    targets = [t.split("#")[0] for t in LINK.findall(text) if not ELSEWHERE.match(t)]
    whole = {t: os.path.normpath(os.path.join(os.path.dirname(page), t)) for t in targets}
    return [t for t, p in whole.items() if p not in tracked and not any(f.startswith(p + "/") for f in tracked)]


@pytest.fixture(scope="module")
def tracked(root):
    found = subprocess.run(["git", "ls-files"], cwd=root, capture_output=True, text=True)
    if found.returncode:
        pytest.skip("not a git checkout")
    return set(found.stdout.splitlines())


def test_no_relative_link_is_dead(root, tracked):
    pages = [f for f in sorted(tracked) if f.endswith(".md") and (root / f).is_file()]
    assert len(pages) > 30
    assert {p: d for p in pages if (d := dead(p, (root / p).read_text(), tracked))} == {}


def test_a_dead_link_is_seen():
    text = "[a](b.md) [c](d.md#e) [f](../g) [h](https://i.j) [k](#l)"
    assert dead("docs/a.md", text, {"docs/b.md", "g/x.py"}) == ["d.md"]
