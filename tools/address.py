#!/usr/bin/env python3
"""The project's address, and everything that is made from it. The repository's publisher sets it once:

    python3 tools/address.py https://github.com/OWNER/hasard

That writes tools/address.txt, `repository` in Cargo.toml, `[project.urls]` in pyproject.toml, `repository-code` in CITATION.cff and the badges of
the README. Until then there is no address, and nothing claims one. With it set,

    python3 tools/address.py --package-page     # README.md for PyPI: links and pictures by the address
    python3 tools/address.py --book             # pages of docs: links that leave the book by the address

rewrite files in place, for a build that is thrown away. Without an address both leave everything as it is.
"""

import os
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
BADGES = re.compile(r"<!-- badges -->.*?<!-- end of badges -->\n\n", re.S)


def address(root):
    """The address, or an empty text."""
    return (root / "tools/address.txt").read_text().strip()


def replace(path, pattern, text):
    """Replaces a pattern that must be in the file."""
    old = path.read_text()
    new, count = re.subn(pattern, lambda _: text, old, count=1, flags=re.S | re.M)
    if count != 1:
        sys.exit(f"{path}: the place for the address is missing")
    path.write_text(new)


def set_address(root, url):
    """Writes the address wherever it belongs."""
    if not re.fullmatch(r"https://[^\s/]+/\S*[^\s/]", url):
        sys.exit(f"{url}: give an address such as https://github.com/OWNER/hasard, without a slash at its end")
    (root / "tools/address.txt").write_text(url + "\n")
    replace(root / "Cargo.toml", r'^(?:# )?repository = [^\n]*$', f'repository = "{url}"')
    for manifest in sorted(root.glob("crates/*/Cargo.toml")):
        text = manifest.read_text()
        if "repository.workspace" not in text:
            manifest.write_text(text.replace("license.workspace = true\n", "license.workspace = true\nrepository.workspace = true\n", 1))
    urls = f'[project.urls]\nRepository = "{url}"\nIssues = "{url}/issues"\nChangelog = "{url}/blob/main/CHANGELOG.md"\n'
    replace(root / "pyproject.toml", r"^(# \[project\.urls\].*?|\[project\.urls\]\n.*?)(?=\n\n|\n\[)", urls.rstrip("\n"))
    replace(root / "CITATION.cff", r'^(?:# )?repository-code:[^\n]*$', f'repository-code: "{url}"')
    badges = f"[![check]({url}/actions/workflows/check.yml/badge.svg)]({url}/actions/workflows/check.yml)"
    readme = root / "README.md"
    text = BADGES.sub("", readme.read_text())
    head, rest = text.split("\n\n", 1)
    readme.write_text(f"{head}\n\n<!-- badges -->\n{badges}\n<!-- end of badges -->\n\n{rest}")


def absolute(text, folder, root, url, leaves):
    """A page whose relative links are the address's, where `leaves` says so of their target."""

    def link(match):
        before, target, after = match.groups()
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        path, _, mark = target.partition("#")
        whole = Path(os.path.normpath(folder / path))
        if not leaves(whole):
            return match[0]
        kind = "raw" if before.startswith("!") else "tree" if whole.is_dir() else "blob"
        return f"{before}{url}/{kind}/main/{whole.relative_to(root).as_posix()}{'#' + mark if mark else ''}{after}"

    return LINK.sub(link, text)


def main(words, root=ROOT):
    """Runs the command."""
    if len(words) != 1:
        sys.exit(__doc__)
    url = address(root)
    if words[0] == "--package-page":
        readme = root / "README.md"
        if url:
            readme.write_text(absolute(readme.read_text(), root, root, url, lambda _: True))
    elif words[0] == "--book":
        docs = root / "docs"
        for page in docs.glob("**/*.md") if url else []:
            page.write_text(absolute(page.read_text(), page.parent, root, url, lambda whole: docs not in whole.parents))
    else:
        set_address(root, words[0])


if __name__ == "__main__":
    main(sys.argv[1:])
