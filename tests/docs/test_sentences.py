"""Pages are read by people in a hurry, and in a second language: sentences of at most 22 words."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    ROOT / "SECURITY.md",
    *sorted(ROOT.glob("cases/*/README.md")),
    *sorted(ROOT.glob("docs/**/*.md")),
]
LONGEST = 22  # words, what is in brackets, in code or in a formula counted as none or one


def sentences(text):
    """Of running text: no code, tables or headings; a colon or semicolon ends one as a full stop does."""
    text = re.sub(r"```.*?```|<!--.*?-->", "", text, flags=re.DOTALL)
    for paragraph in re.split(r"\n\s*\n", text):
        lines = [x for x in paragraph.splitlines() if not x.lstrip().startswith(("|", "#")) and x[:4] != " " * 4]
        for item in re.split(r"(?:^|\s)(?:[-*]|\d+\.)\s+", " ".join(lines)):
            plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", re.sub(r"`[^`]*`", "code", item))
            yield from re.split(r"(?<=[.!?:;])\s+", re.sub(r"\([^()]*\)", "", plain))


def words(sentence):
    return [w for w in sentence.split() if re.search(r"\w", w)]


def test_a_long_sentence_is_seen():
    assert [len(words(s)) for s in sentences("One two (three four). " + "word " * 23 + ".")] == [2, 23]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_page_is_in_short_sentences(page):
    text = page.read_text(encoding="utf-8")
    assert [s for s in sentences(text) if len(words(s)) > LONGEST] == []
