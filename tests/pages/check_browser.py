#!/usr/bin/env python3
"""Opens HTML pages in headless Chromium, without network, at the width of a desk and
of a phone, and checks what is seen there: formulas, pictures, widths, headings, raw
markup, messages of the console. Links are checked in all pages. Prints every offence
as PAGE: SENTENCE, and ends with status 1 if there is any.

    check_browser.py --chromium PROGRAM --chromedriver PROGRAM [--all]
                     [--screenshots FOLDER] FOLDER"""

import argparse
import base64
import json
import re
import sys
import time
from pathlib import Path

from selenium import webdriver
from selenium.common.exceptions import TimeoutException
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

from html_links import Links

SCREENS = {"desk": dict(width=1280, height=900, deviceScaleFactor=1, mobile=False),
           "phone": dict(width=390, height=844, deviceScaleFactor=2, mobile=True)}
# Pixels of the device.
HIGHEST_SCREENSHOT = 16000
# Pages that Doxygen makes of sources, and its lists.
GENERATED = re.compile(
    r"(class|struct|union|interface|namespace)[A-Z_].*|dir_.*|.*_8\w+|.*_8\w+_source|"
    r".*-members|annotated|classes|files|functions.*|globals.*|hierarchy|inherits|"
    r"namespacemembers.*|namespaces|pages|modules|graph_legend|.*-example")
# One in so many of them is looked at, besides those with formulas.
SAMPLE = 12
INSPECT = Path(__file__).with_name("inspect_page.js").read_text()


def start(options):
    arguments = Options()
    arguments.binary_location = options.chromium
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage",
                     "--disable-gpu", "--hide-scrollbars",
                     "--host-resolver-rules=MAP * ~NOTFOUND"):
        arguments.add_argument(argument)
    arguments.set_capability("goog:loggingPrefs",
                             {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(service=Service(options.chromedriver),
                               options=arguments)
    browser.set_script_timeout(120)
    browser.set_page_load_timeout(120)
    return browser


def is_written_by_hand(page):
    return not GENERATED.fullmatch(page.stem)


def has_formulas(page):
    return re.search(r"\\\(|\\\[", page.read_text(errors="replace")) is not None


def leads_elsewhere(page):
    return 'http-equiv="refresh"' in page.read_text(errors="replace")


def choose(pages, everything):
    """All pages written by hand, and of the others those with formulas and some."""
    pages = [page for page in pages if not leads_elsewhere(page)]
    by_hand = [page for page in pages if is_written_by_hand(page)]
    others = [page for page in pages if page not in by_hand]
    if not everything:
        others = [page for i, page in enumerate(others)
                  if i % SAMPLE == 0 or (not page.stem.endswith("_source")
                                         and has_formulas(page))]
    return by_hand + others


def offences_of_links(links):
    """What is wrong on many pages, like a link of their header, is said once."""
    places = {}
    for page in links.pages():
        for line, problem in links.problems(page):
            places.setdefault(problem, []).append((page.name, line))
    return [f"{name}:{line}: {problem}"
            + (f", here and in {len(found) - 1} other places" if found[1:] else "")
            for problem, found in places.items() for name, line in found[:1]]


class Visit:
    def __init__(self, browser, screenshots, patience):
        self.browser, self.screenshots, self.patience = browser, screenshots, patience
        self.offences = []

    def look(self, page, by_hand):
        """Loads a page once, and looks at it on one screen after the other. Where
        formulas are missing it is loaded again: on a busy machine MathJax gives up
        files of its own that are late."""
        is_loaded = False
        for screen_name, screen in SCREENS.items():
            self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
            for is_last in False, True:
                try:
                    if not is_loaded:
                        self.browser.get(page.as_uri())
                    is_loaded = True
                    found = self.browser.execute_async_script(
                        INSPECT, screen["width"], by_hand, self.patience)
                except TimeoutException:
                    found = ["the page is not ready after two minutes"]
                if is_last or not any("raw markup" in offence for offence in found):
                    break
                is_loaded = False
                self.messages()
            found += self.messages()
            found += self.requests()
            for offence in dict.fromkeys(found):
                self.offences.append(f"{page.name}, {screen_name}: {offence}")
            if self.screenshots and by_hand:
                self.take_screenshot(page, screen_name)

    def messages(self):
        return [f"the console says: {' '.join(message['message'].split())}"
                for message in self.browser.get_log("browser")
                if message["level"] in ("SEVERE", "WARNING")]

    def requests(self):
        found = []
        for entry in self.browser.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                address = message["params"]["request"]["url"]
                if not address.startswith(("file:", "data:", "blob:", "about:")):
                    found.append(f"asks the network for '{address}'")
        return found

    def take_screenshot(self, page, screen_name):
        screen = SCREENS[screen_name]
        height = self.browser.execute_script(
            "return document.documentElement.scrollHeight")
        height = min(height, HIGHEST_SCREENSHOT // screen["deviceScaleFactor"])
        picture = self.browser.execute_cdp_cmd("Page.captureScreenshot", dict(
            format="png", captureBeyondViewport=True,
            clip=dict(x=0, y=0, width=screen["width"], height=height, scale=1)))
        file = self.screenshots / f"{page.stem}-{screen_name}.png"
        file.write_bytes(base64.b64decode(picture["data"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--chromium", required=True)
    parser.add_argument("--chromedriver", required=True)
    parser.add_argument("--all", action="store_true",
                        help="look at every generated page, not only at some")
    parser.add_argument("--patience", type=float, default=8,
                        help="seconds for formulas on a machine that is busy")
    parser.add_argument("--screenshots", type=Path,
                        help="where to put pictures of the pages written by hand")
    parser.add_argument("folder", type=Path, help="where index.html is")
    options = parser.parse_args()
    if not (options.folder / "index.html").is_file():
        sys.exit(f"There is no {options.folder}/index.html; build the target 'doc'.")
    if options.screenshots:
        options.screenshots.mkdir(parents=True, exist_ok=True)

    begin = time.time()
    links = Links(options.folder)
    pages = links.pages()
    offences = offences_of_links(links)
    chosen = choose(pages, options.all)
    browser = start(options)
    try:
        visit = Visit(browser, options.screenshots, options.patience)
        for page in chosen:
            visit.look(page, is_written_by_hand(page))
        offences += visit.offences
    finally:
        browser.quit()
    for offence in offences:
        print(offence + ".")
    print(f"Links of {len(pages)} pages, {len(chosen)} pages in the browser, of "
          f"which {sum(map(is_written_by_hand, chosen))} are written by hand, "
          f"{time.time() - begin:.0f} seconds: {len(offences)} offences.")
    return 1 if offences else 0


if __name__ == "__main__":
    sys.exit(main())
