"""The page's table of doubt is the code's: python -m scripts.doubt_table."""

from scripts.doubt_table import doubt_table


def test_table_of_doubt_is_current(root):
    page = (root / "docs" / "diagnosis.md").read_text(encoding="utf-8")
    written = page.split("<!-- doubt:begin -->\n")[1].split("\n<!-- doubt:end -->")[0]
    assert written == doubt_table()
