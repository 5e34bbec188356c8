#!/usr/bin/env python3
"""How readable the pages and the program's help are: mean and longest sentence in words, and prose lines over 130 letters.

    python3 tools/readability.py                      # README, docs (without raw results), changelog
    python3 tools/readability.py --help-of hasard     # the help of each command of a program
    python3 tools/readability.py --at COMMIT          # the same pages at a commit

A sentence ends with . ! ? or : before a space, at the end of a list item, a heading or a paragraph. Code, tables, pictures and link
targets are left out. Words are what spaces divide.
"""

import argparse
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDEST = 130
RAW = ("docs/results/", "docs/tried/")
BLOCK = re.compile(r"^\s*([-*+]|\d+[.)]|#+|>)\s+")
END = re.compile(r"(?<=[.!?:;])[)\"”`*_]*\s+(?=[A-Z`*\"(\[0-9])")


def prose(text):
    """Paragraphs of a page, and its widest lines: no code, table or picture."""
    paragraphs, lines, code = [[]], [], False
    for line in text.splitlines():
        if line.lstrip().startswith(("```", "~~~")):
            code = not code
            paragraphs.append([])
            continue
        if code or line.lstrip().startswith(("|", "![", "<")):
            paragraphs.append([])
            continue
        lines.append(line)
        if not line.strip() or BLOCK.match(line):
            paragraphs.append([])
        paragraphs[-1].append(BLOCK.sub("", line).strip())
    joined = (" ".join(part).strip() for part in paragraphs)
    return [plain(part) for part in joined if part], lines


def plain(text):
    """A paragraph without the targets of its links."""
    return re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)


def measure(text):
    """Words of each sentence, and the number of prose lines that are too wide."""
    paragraphs, lines = prose(text)
    sentences = [part for paragraph in paragraphs for part in END.split(paragraph)]
    words = [len(sentence.split()) for sentence in sentences]
    # Headings and single words are no sentences.
    return [count for count in words if count > 3], sum(len(line) > WIDEST for line in lines)


def row(name, text, wide=None):
    """A line of the table; `wide` where the lines are others than the text's."""
    words, found = measure(text)
    wide = found if wide is None else wide
    mean = sum(words) / len(words) if words else 0.0
    over = sum(count > 25 for count in words)
    print(f"| {name} | {len(words)} | {mean:.1f} | {max(words, default=0)} | {over} | {wide} |")


def pages(commit):
    """Names and texts of the pages."""
    if commit:
        names = subprocess.run(["git", "ls-tree", "-r", "--name-only", commit], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        show = lambda name: subprocess.run(["git", "show", f"{commit}:{name}"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
        names = names.splitlines()
    else:
        names = sorted(str(path.relative_to(ROOT)) for path in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
        show = lambda name: (ROOT / name).read_text()
    for name in names:
        if name.endswith(".md") and ("/" not in name or name.startswith("docs/")):
            yield name, show(name)


def help_of(program):
    """The help of a program and of each of its commands, one line a flag."""
    top = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
    yield "hasard --help", top
    for command in re.findall(r"^  ([a-z][a-z-]+)\s{2,}", top, flags=re.M):
        done = subprocess.run([program, command, "--help"], capture_output=True, text=True)
        if done.returncode == 0:
            yield f"hasard {command} --help", done.stdout


def descriptions(text):
    """A help as paragraphs of a page: what each flag, argument or command does, its wrapped lines joined; no usage, defaults or examples."""
    parts = [[]]
    for line in text.split("\nExamples:")[0].splitlines():
        begins = re.match(r"\s{0,8}(-{1,2}[A-Za-z][^\s]*|\[?<[^\s]*|[a-z][a-z-]+(?=\s{2,}))((,? |=| \[?)[-<\[][^\s]*)*(\s{2,}|$)", line)
        item = re.match(r"\s*- ", line)
        if not line.strip() or line.startswith("Usage:") or begins or item:
            parts.append([])
        rest = "" if line.startswith("Usage:") else line[begins.end() :] if begins else line[item.end() :] if item else line
        parts[-1].append(rest.strip())
    whole = (re.sub(r"\[(default|aliases|alias|possible values): [^\]]*\]", "", " ".join(part)).strip() for part in parts)
    return "\n\n".join(part for part in whole if part)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--at", metavar="COMMIT")
    parser.add_argument("--help-of", metavar="PROGRAM")
    parser.add_argument("--each", action="store_true", help="a row for each page, not only sums")
    args = parser.parse_args()
    print("| what | sentences | mean words | longest | over 25 words | lines over 130 |\n|---|--:|--:|--:|--:|--:|")
    if args.help_of:
        texts = list(help_of(args.help_of))
        for name, text in texts if args.each else []:
            row(name, descriptions(text), sum(len(line) > WIDEST for line in text.splitlines()))
        lines = [line for _, text in texts for line in text.splitlines()]
        row("help of all commands", "\n\n".join(descriptions(text) for _, text in texts), sum(len(line) > WIDEST for line in lines))
        return
    groups = {}
    for name, text in pages(args.at):
        group = "raw results and what was tried" if name.startswith(RAW) else name if "/" not in name else "docs"
        groups.setdefault(group, []).append(text)
        if args.each:
            row(name, text)
    for group, texts in groups.items():
        row(group, "\n\n".join(texts))


if __name__ == "__main__":
    main()
