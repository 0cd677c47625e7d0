"""Checks that the page on patterns has the tables that its record gives."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "patterns.md").read_text(encoding="utf-8")


def test_page_has_the_tables_of_the_record():
    sys.path.insert(0, str(ROOT / "examples" / "patterns"))
    sys.modules.pop("page", None)  # that of another example
    import page
    tables = page.tables()
    assert len(tables) == 2
    for name, text in tables.items():
        assert f"\n[{name}]({name})\n" in PAGE and (ROOT / "docs" / name).read_text(encoding="utf-8") == text
    sys.path.pop(0)
    del sys.modules["page"]
