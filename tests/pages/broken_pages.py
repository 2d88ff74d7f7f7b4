#!/usr/bin/env python3
"""Checks that the check of pages in a browser can fail: pages that are broken in one
way each must give the offence that is expected, and a sound one none.

    broken_pages.py --chromium PROGRAM --chromedriver PROGRAM --mathjax MathJax.js"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent

PAGE = """<!DOCTYPE html>
<html><head><meta charset="utf-8"><title>{title}</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,">
<script type="text/x-mathjax-config">
MathJax.Hub.Config({{extensions: ["tex2jax.js", "TeX/AMSmath.js"],
                     jax: ["input/TeX", "output/SVG"], messageStyle: "none"}});
</script>
<script async src="{mathjax}"></script></head>
<body><h1>A page</h1><h1 style="font-size: 1em">A section</h1>
<p>A formula \\(a_1\\), and another one: \\[ \\frac{{1}}{{2}} \\]</p>
<p id="here"><a href="#here">Here</a>, <a href="index.html#here">there</a> and
<a href="https://somewhere.invalid/">far away</a>.</p>
<pre><code>$ ** ## `</code></pre>
<img src="picture.svg" alt="A picture" width="100">
{body}
</body></html>
"""
PICTURE = ('<svg xmlns="http://www.w3.org/2000/svg" width="10" height="10">'
           '<circle cx="5" cy="5" r="4"/></svg>')
# Page, what is broken in it, and words of every offence that is expected there.
CASES = {
    "index": ("", []),
    "link": ('<a href="missing.html">Nothing</a>', ["leads nowhere"]),
    "anchor": ('<a href="index.html#missing">Nothing</a>', ["there is no anchor"]),
    "picture": ('<img src="missing.png" alt="">',
                ["leads nowhere", "has not been loaded", "the console says"]),
    "macro": ("<p>\\(\\missing\\)</p>", ["has not been set"]),
    "braces": ("<p>\\(\\frac{1\\)</p>", ["has not been set"]),
    "dollar": ("<p>A formula $a$ that is none.</p>", ["raw markup '$'"]),
    "markdown": ("<p>A **word** in bold.</p>", ["raw markup '**'"]),
    "doxygen": ("<p>@f$ a @f$</p>", ["raw markup '@f'"]),
    "wide": ('<div style="width: 2000px">Wide</div>', ["pixels wide"]),
    "wide_on_a_phone": ('<div style="width: 800px">Wide</div>', ["pixels wide"]),
    "console": ("<script>console.error('broken')</script>", ["the console says"]),
    "exception": ("<script>missing();</script>", ["the console says"]),
    "network": ('<img src="http://somewhere.invalid/a.svg" alt="">',
                ["from the network", "asks the network", "the console says",
                 "has not been loaded"]),
    "headings": ("<h1>Another page</h1>", ["2 headings"]),
    "untitled": ("", ["no title"]),
}


def main():
    mathjax = sys.argv[sys.argv.index("--mathjax") + 1]
    arguments = [word for word in sys.argv[1:] if word not in ("--mathjax", mathjax)]
    with tempfile.TemporaryDirectory() as scratch:
        for name, (body, _) in CASES.items():
            Path(scratch, name + ".html").write_text(PAGE.format(
                mathjax=Path(mathjax).resolve().as_uri(), body=body,
                title="" if name == "untitled" else "A page"))
        Path(scratch, "picture.svg").write_text(PICTURE)
        run = subprocess.run(
            [sys.executable, "-B", str(HERE / "check_browser.py"), "--patience", "1"]
            + arguments + [scratch], capture_output=True, text=True)
    print(run.stdout + run.stderr)
    wrong = []
    for name, (_, expected) in CASES.items():
        found = re.findall(rf"^{name}\.html[:,] ?(.*)$", run.stdout, re.M)
        wrong += [f"{name}: '{words}' was not found" for words in expected
                  if not any(words in one for one in found)]
        wrong += [f"{name}: found, but not expected: {one}" for one in found
                  if not any(words in one for words in expected)]
    if run.returncode != 1:
        wrong.append(f"the status is {run.returncode} instead of 1")
    print("\n".join(wrong) or f"All of {len(CASES)} pages are as expected.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
