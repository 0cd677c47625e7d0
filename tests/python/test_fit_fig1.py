"""Checks that the page of the fit of Fig. 1 has the tables that its record gives, and pictures."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "fit-fig1"
PAGE = (ROOT / "docs" / "fit-fig1.md").read_text(encoding="utf-8")


def test_page_has_the_tables_of_the_record():
    sys.path.insert(0, str(EXAMPLE))
    import page
    result, others, tables = page.blocks(EXAMPLE / "record")
    assert len(result.points) >= 60 and set(others) == {str(number) for number in result.points.index}
    assert len(tables) == 7
    for lines in tables:
        assert "\n".join(lines) in PAGE
    # All three numbers are met within two standard deviations, as the page says.
    assert (result.observations["difference"].abs() < 2).all() and result.best == dict(result.near_equal.iloc[0][list(result.best)])


def test_pictures_are_small():
    pictures = re.findall(r"\(pictures/(fit-fig1-\w+\.png)\)", PAGE)
    assert len(pictures) == 3
    for name in pictures:
        assert (ROOT / "docs" / "pictures" / name).stat().st_size < 150 * 1024
