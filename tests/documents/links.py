#!/usr/bin/env python3
"""Checks that every relative link of every document leads to a file, and its anchor to a heading.

    links.py SOURCE_FOLDER"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
SKIPPED = {".git", "build", "var", "node_modules"}


def without_code(text):
    """Fenced blocks and spans of code hold no links."""
    return re.sub(r"`[^`\n]*`", "", re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL))


def anchors(document):
    """The names under which the headings of a document are reached."""
    found, seen = set(), {}
    for heading in re.findall(r"^#+ +(.*?) *$", re.sub(r"^```.*?^```$", "", document.read_text(), flags=re.M | re.S), re.MULTILINE):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        name = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        count = seen.get(name, 0)
        seen[name] = count + 1
        found.add(f"{name}-{count}" if count else name)
    return found


def main():
    faults, links = [], 0
    for document in sorted(root.rglob("*.md")):
        place = document.relative_to(root)
        if SKIPPED & set(place.parts):
            continue
        for link in re.findall(r"\]\(([^)\s]+)\)", without_code(document.read_text())):
            if re.match(r"[a-z]+:", link):
                continue
            links += 1
            path, _, anchor = link.partition("#")
            target = (document.parent / path).resolve() if path else document
            if not target.exists() or not target.is_relative_to(root):
                faults.append(f"{place}: {link} leads nowhere")
            elif anchor and target.suffix == ".md" and anchor not in anchors(target):
                faults.append(f"{place}: {link}: that document has no such heading")
    if links < 50:
        faults.append(f"only {links} links were found: this test looks at the wrong tree")
    print(f"{links} relative links checked")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
