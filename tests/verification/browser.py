"""A page in headless Chromium, driven by Selenium."""
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.wait import WebDriverWait

PATIENCE = 120  # longest wait for anything [s]


class Browser:
    """One page of a browser; `with Browser() as browser`."""

    def __init__(self, width=1280, height=800):
        self.size = width, height

    def __enter__(self):
        options = webdriver.ChromeOptions()
        for switch in ("headless", "no-sandbox", "disable-gpu", "hide-scrollbars"):
            options.add_argument(f"--{switch}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        self.call("Emulation.setDeviceMetricsOverride", width=self.size[0], height=self.size[1], deviceScaleFactor=1, mobile=False)
        return self

    def __exit__(self, *_):
        self.driver.quit()

    def call(self, method, **parameters):
        """Result of a command of Chromium's DevTools protocol."""
        return self.driver.execute_cdp_cmd(method, parameters)

    def said(self):
        """Messages on the console, and exceptions, since they were asked for last."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requested(self):
        """Addresses that the page has asked for."""
        return self.value("performance.getEntriesByType('resource').map((entry) => entry.name)")

    def open(self, path):
        """Opens a file, until its viewers are ready."""
        self.driver.get(Path(path).resolve().as_uri())
        self.wait("[...document.querySelectorAll('.viewer')].every((viewer) => viewer.classList.contains('ready'))")

    def value(self, expression):
        """Value of a JavaScript expression."""
        return self.driver.execute_script(f"return {expression}")

    def wait(self, expression):
        """Waits until an expression is true."""
        WebDriverWait(self.driver, PATIENCE, 0.05).until(lambda _: self.value(expression), expression)

    def mouse(self, kind, x, y, **more):
        """A mouse event at a point of the window."""
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
