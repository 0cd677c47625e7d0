#!/usr/bin/python3
"""The report in a browser, Chromium, on a screen as narrow as a phone's: the page itself does not scroll sideways."""
import html
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
from report_test import FAILS, HOLDS, PUBLISHED, REPORTED, report, write_fracture, write_verification

WIDTH = 390  # [pixels]
# The page in a frame of that width; what it measures is written into the title.
FRAME = f"""<html><body><iframe id="page" width="{WIDTH}" height="800" srcdoc="PAGE"></iframe><script>
addEventListener("load", () => {{
  const page = document.getElementById("page").contentDocument;
  const boxes = [...page.querySelectorAll("pre, table")];
  const wide = boxes.some(box => box.scrollWidth > box.closest(".scroll").clientWidth);
  document.title = `${{page.documentElement.clientWidth}} ${{page.documentElement.scrollWidth}} ${{wide}}`;
}});</script></body></html>"""


class PhoneWidth(unittest.TestCase):
    def measured(self, page):
        """@return width of the window [pixels], that of the page, whether a table or text scrolls in its own box"""
        with tempfile.TemporaryDirectory() as folder:
            frame = Path(folder) / "frame.html"
            frame.write_text(FRAME.replace("PAGE", html.escape(page)), encoding="utf-8")
            shown = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu",
                                    f"--user-data-dir={folder}/data",
                                    "--virtual-time-budget=5000", "--dump-dom", frame.as_uri()], capture_output=True,
                                   text=True, timeout=200, check=True, stdin=subprocess.DEVNULL).stdout
        window, width, scrolls = re.search(r"<title>(\d+) (\d+) (true|false)</title>", shown).groups()
        return int(window), int(width), scrolls == "true"

    def test_page_does_not_scroll_sideways(self):
        with tempfile.TemporaryDirectory() as folder:
            runs = Path(folder) / "runs"
            write_verification(runs / "a-run-with-a-rather-long-name", [HOLDS, FAILS, REPORTED])
            write_fracture(runs / "fig1", [HOLDS, PUBLISHED])
            report.main([str(runs), "--quiet"])
            page = (runs / "report.html").read_text(encoding="utf-8")
        window, width, scrolls = self.measured(page)
        self.assertLessEqual(window, WIDTH)
        self.assertLessEqual(width, window)
        self.assertTrue(scrolls)  # so there was something to be kept in its box
        unboxed = page.replace(".scroll {", ".none {")
        self.assertGreater(self.measured(unboxed)[1], window)  # and it is seen if it is not


if __name__ == "__main__":
    unittest.main()
