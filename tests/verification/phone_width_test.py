"""Checks in Chromium that on a screen as narrow as a phone neither the report nor a box in it scrolls horizontally."""
from browser import Browser
from made_up_sheet import write_torn_sheet
from report_test import FAILS, HOLDS, PUBLISHED, REPORTED, main, write_fracture, write_verification

WIDTH = 390  # [pixels]
# Elements that extend beyond the window, and boxes whose contents do not fit.
TOO_WIDE = """[...document.querySelectorAll('body *')].filter((element) => {
  const box = element.getBoundingClientRect(), style = getComputedStyle(element);
  if (!box.width || element.closest('thead')) return false; // heads of columns are for screen readers alone
  return box.right > innerWidth + 0.5 || box.left < -0.5 ||
    (/auto|scroll/.test(style.overflowX) && element.scrollWidth > element.clientWidth);
}).map((element) => `${element.tagName} ${element.className}`)"""
UNFOLD = "document.querySelectorAll('details').forEach((element) => { element.open = true; })"
# Without the rules for narrow windows.
SPOIL = """for (const sheet of document.styleSheets)
  for (let i = sheet.cssRules.length - 1; i >= 0; i--)
    if (/max-width/.test(sheet.cssRules[i].conditionText)) sheet.deleteRule(i);"""


def test_nothing_scrolls_sideways(tmp_path):
    with Browser() as browser:
        runs = tmp_path / "runs"
        write_verification(runs / "a-run-with-a-rather-long-name", [HOLDS, FAILS, REPORTED])
        write_fracture(runs / "fig1", [HOLDS, PUBLISHED])
        write_torn_sheet(runs / "torn")
        (runs / "torn" / "case.prm").write_text(f"subsection Sheet\n  set height = 0.1 # {'m' * WIDTH}\nend\n")
        main(["report", str(runs), "--quiet"])
        browser.resize(WIDTH, 844, phone=True)
        browser.open(runs / "report.html")
        browser.value(UNFOLD)
        assert browser.value("innerWidth") == WIDTH
        assert browser.value("document.documentElement.scrollWidth") <= WIDTH
        assert browser.value(TOO_WIDE) == []
        browser.value(SPOIL)
        assert browser.value(TOO_WIDE) != []  # elements that do not fit are detected
