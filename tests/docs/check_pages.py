"""Checks the Markdown pages against the tree: links and named paths lead to files, the README's program is the one that
tests/package compiles, and no script's option is documented that the script does not have."""

import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
pages = [*root.glob("*.md"), *root.glob("docs/**/*.md")]
problems = []


def anchors(page):
    """The anchors of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ +(.*)$", re.sub(r"```.*?```", "", page.read_text(), flags=re.S), re.M)
    words = (re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in headings)
    return {re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-") for text in words}


def check_links(page, text):
    for target, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)\s]*))?\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        file = page.parent / target if target else page
        if not file.exists():
            problems.append(f"{page}: the link to {target} leads nowhere")
        elif anchor and file.suffix == ".md" and anchor not in anchors(file):
            problems.append(f"{page}: {target} has no heading #{anchor}")


def check_scripts(page, text):
    for script, arguments in re.findall(r"(?<![\w/.])((?:scripts|\.ci)/[\w-]+)(?![\w/.-]*\.)((?: +[^\s`|#]+)*)", text):
        path = root / script
        if not path.exists():
            problems.append(f"{page}: there is no {script}")
            continue
        known = path.read_text() + (root / "scripts/common.sh").read_text()
        for option in re.findall(r"(?<=\s)--[a-z-]+", arguments):
            if option not in known:
                problems.append(f"{page}: {script} has no option {option}")


def check_program():
    program = (root / "tests/package/program/main.cpp").read_text()
    blocks = re.findall(r"```cpp\n(.*?)```", (root / "README.md").read_text(), re.S)
    if program not in blocks:
        problems.append("README.md: no C++ block equals tests/package/program/main.cpp")


for page in pages:
    text = page.read_text()
    check_links(page, text)
    check_scripts(page, text)
check_program()
for problem in problems:
    print(problem)
sys.exit(1 if problems else 0)
