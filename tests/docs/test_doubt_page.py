"""The page's table of doubt is the code's."""

from measured.doubt import markdown


def test_table_of_doubt_is_current(root):
    page = (root / "docs" / "diagnosis.md").read_text(encoding="utf-8")
    written = page.split("<!-- doubt:begin -->\n")[1].split("\n<!-- doubt:end -->")[0]
    assert written == markdown()
