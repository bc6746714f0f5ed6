"""Every link of static web pages leads somewhere: links.py FOLDER [FEWEST].

Each relative href and src of each page in FOLDER names a file in FOLDER, each #anchor an id or name of its page, and no
page has one id twice. There are at least FEWEST links. Prints the number of pages and links.
"""
import html.parser
import os
import sys
import urllib.parse
from typing import Dict, List, Set, Tuple


class Page(html.parser.HTMLParser):
    def __init__(self, path: str) -> None:
        super().__init__()
        self.ids: Set[str] = set()
        self.twice: Set[str] = set()
        self.links: List[str] = []
        with open(path, encoding="utf-8") as file:
            self.feed(file.read())

    def handle_starttag(self, tag: str, attributes: List[Tuple[str, str]]) -> None:
        for name, value in attributes:
            if name == "id":
                self.twice |= self.ids & {value}
            if name == "id" or (name == "name" and tag == "a"):
                self.ids.add(value)
            if name in ("href", "src") and value:
                self.links.append(value)


def broken(folder: str) -> Tuple[List[str], int, int]:
    """The sentences about what is wrong, and the numbers of pages and of links within the folder."""
    paths = [os.path.join(place, name) for place, _, names in os.walk(folder) for name in names]
    pages: Dict[str, Page] = {path: Page(path) for path in paths if path.endswith(".html")}
    wrong, count = [], 0
    for path, page in sorted(pages.items()):
        if not os.sep + "api" + os.sep in path: # Doxygen repeats ids in its menus
            wrong += ["%s has the id %s twice" % (path, name) for name in sorted(page.twice)]
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            count += 1
            to = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(parts.path))) \
                if parts.path else path
            if os.path.relpath(to, folder).startswith("..") or not os.path.isfile(to):
                wrong.append("%s names %s, which is not there" % (path, link))
            elif parts.fragment and to in pages and urllib.parse.unquote(parts.fragment) not in pages[to].ids:
                wrong.append("%s names %s, but %s has no such anchor" % (path, link, to))
    return wrong, len(pages), count


def main() -> None:
    wrong, pages, links = broken(sys.argv[1])
    print("\n".join(wrong + ["%d pages, %d links" % (pages, links)]))
    sys.exit(bool(wrong) or links < int(sys.argv[2] if len(sys.argv) > 2 else 1))


main()
