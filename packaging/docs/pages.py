"""Makes web pages of the documentation: pages.py ROOT OUT.

In: the Markdown files README.md, CHANGELOG.md, SECURITY.md and CONTRIBUTING.md in the folder ROOT, those of docs/, and
the README.md of npm/. Out: OUT/index.html for README.md, and for each other file a page at its path. Files
that pages show or name are copied: pictures as they are, sources as pages; a folder without a page becomes a list of its files. Links to public headers become links to the
API reference in OUT/api, which Doxygen makes. cmark-gfm translates Markdown to HTML.
SPDX-License-Identifier: MIT
"""
import glob
import html
import os
import posixpath
import re
import shutil
import subprocess
import sys
from typing import Dict, List, Tuple

ROOT, OUT = sys.argv[1:]
HERE = os.path.dirname(os.path.abspath(__file__))
GROUPS: List[Tuple[str, str]] = [("", "*.md"), ("Use", "docs/*.md"), ("Use", "npm/README.md"),
                                 ("Engines", "docs/engines/*.md"),
                                 ("Theory", "docs/theory/*.md")]


def page_of(path: str) -> str:
    """The page of a Markdown file."""
    folder, name = posixpath.split(path)
    return posixpath.join(folder, "index.html" if name == "README.md" else name[:-len(".md")] + ".html")


def read(path: str) -> str:
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def title_of(text: str) -> str:
    return re.search(r"^# (.*)$", text, re.M).group(1).replace("`", "")


def slug(heading: str, used: Dict[str, int]) -> str:
    """The anchor of a heading, as GitHub makes it."""
    text = html.unescape(re.sub(r"<[^>]*>", "", heading)).lower()
    text = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
    used[text] = used.get(text, -1) + 1
    return text + ("-%d" % used[text] if used[text] else "")


def target(page: str, source: str, link: str, others: Dict[str, None]) -> str:
    """A link of the page made of `source`; files that are no pages are added to `others`."""
    if re.match(r"[a-z]+:|#", link):
        return link
    path, _, anchor = link.partition("#")
    path = posixpath.normpath(posixpath.join(posixpath.dirname(source), path))
    if path in PAGES:
        to = PAGES[path]
    elif posixpath.dirname(path) == "include/kiln":
        to = "api/%s_8h.html" % posixpath.basename(path)[:-len(".h")]
    elif os.path.isdir(os.path.join(ROOT, path)):
        to = posixpath.join(path, "index.html")
        if posixpath.join(path, "README.md") not in PAGES:
            others[path] = None
    else:
        others[path] = None
        to = path if path.endswith((".png", ".svg", ".jpg")) else path + ".html"
    return posixpath.relpath(to, posixpath.dirname(page) or ".") + ("#" + anchor if anchor else "")


def navigation(page: str) -> str:
    """The list of all pages, beside each page."""
    up = posixpath.dirname(page) or "."
    lines, group = [], None
    for path, name in NAMES.items():
        if GROUP_OF[path] != group:
            lines.append("</ul>" * (group is not None) + "<h2>%s</h2>" % GROUP_OF[path] * bool(GROUP_OF[path]) + "<ul>")
            group = GROUP_OF[path]
        here = ' aria-current="page"' if PAGES[path] == page else ""
        lines.append('<li><a href="%s"%s>%s</a></li>' % (posixpath.relpath(PAGES[path], up), here, html.escape(name)))
        if path == "README.md":
            lines.append('<li><a href="%s">C API reference</a></li>' % posixpath.relpath("api/files.html", up))
    return "\n".join(lines + ["</ul>"])


def write(page: str, title: str, body: str) -> None:
    up = posixpath.relpath(".", posixpath.dirname(page) or ".")
    values = {"title": html.escape(title), "style": posixpath.join(up, "style.css"), "body": body,
              "home": posixpath.join(up, "index.html"), "navigation": navigation(page)}
    text = re.sub(r"\{(\w+)\}", lambda match: values[match.group(1)], TEMPLATE)
    os.makedirs(os.path.dirname(os.path.join(OUT, page)), exist_ok=True)
    with open(os.path.join(OUT, page), "w", encoding="utf-8") as file:
        file.write(text)


def translate(source: str, others: Dict[str, None]) -> str:
    body = subprocess.check_output(["cmark-gfm", "-e", "table", os.path.join(ROOT, source)], encoding="utf-8")
    used: Dict[str, int] = {}
    body = re.sub(r"<h([1-6])>(.*?)</h\1>",
                  lambda m: '<h%s id="%s">%s</h%s>' % (m.group(1), slug(m.group(2), used), m.group(2), m.group(1)), body,
                  flags=re.S)
    page = PAGES[source]
    body = re.sub(r'(href|src)="([^"]*)"', lambda m: '%s="%s"' % (m.group(1), html.escape(
        target(page, source, html.unescape(m.group(2)), others))), body)
    # Wide tables scroll by themselves.
    return body.replace("<table>", '<div class="table"><table>').replace("</table>", "</table></div>")


with open(os.path.join(HERE, "template.html"), encoding="utf-8") as file:
    TEMPLATE = file.read()
GROUP_OF: Dict[str, str] = {}
for group, pattern in GROUPS:
    for path in sorted(glob.glob(os.path.join(ROOT, pattern)), key=lambda p: (not p.endswith("README.md"), p)):
        GROUP_OF[os.path.relpath(path, ROOT).replace(os.sep, "/")] = group
PAGES = {path: page_of(path) for path in GROUP_OF}
NAMES = {path: title_of(read(path)) for path in GROUP_OF}


def main() -> None:
    others: Dict[str, None] = {}
    for source, page in PAGES.items():
        write(page, NAMES[source], translate(source, others))
    for path in others:
        if path.endswith((".png", ".svg", ".jpg")):
            os.makedirs(os.path.dirname(os.path.join(OUT, path)), exist_ok=True)
            shutil.copyfile(os.path.join(ROOT, path), os.path.join(OUT, path))
        elif os.path.isdir(os.path.join(ROOT, path)):
            names = sorted(name for name in os.listdir(os.path.join(ROOT, path)) if name != "node_modules")
            write(posixpath.join(path, "index.html"), path + "/", "<h1>%s/</h1>\n<p>This folder of the sources holds:</p>"
                  "\n<ul>%s</ul>\n" % (path, "".join("<li><code>%s</code></li>" % html.escape(n) for n in names)))
        else:
            write(path + ".html", path, "<h1>%s</h1>\n<pre><code>%s</code></pre>\n"
                  % (html.escape(path), html.escape(read(path))))
    shutil.copyfile(os.path.join(HERE, "style.css"), os.path.join(OUT, "style.css"))
    print("%d pages, %d other files" % (len(PAGES), len(others)))


main()
