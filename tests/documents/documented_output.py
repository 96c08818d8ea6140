#!/usr/bin/env python3
"""Checks that what the documents print as the output of a command is that command's output.

    documented_output.py SLIPWAY SOURCE_FOLDER quick|slow|all [--write]

A block of output stands behind a line that names its command:

    <!-- output of: slipway rovers | head -3 -->
    ```
    ...
    ```

A picture stands behind `<!-- picture of: slipway plan ... --map routes.svg -->`, which writes a file of the same name.

"slow output of:" marks a command that takes more than a few seconds. The command is run by sh, in a folder that holds a link to
the source tree's data, and its standard output is compared with the block; --write puts it there. A block that names no language and no
command is an error, so that no output escapes: a block of text is fenced as ```text. Every curl of the README is asked of a running
service and must be answered."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

slipway, root, which = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
write = "--write" in sys.argv[4:]

BLOCK = re.compile(r"^(?:<!-- (?P<slow>slow )?output of: (?P<command>[^\n]+) -->\n)?```(?P<language>\w*)\n(?P<body>.*?)^```$",
                   re.MULTILINE | re.DOTALL)


PICTURE = re.compile(r"^<!-- picture of: (?P<command>[^\n]+) -->\n!\[[^\]]*\]\((?P<path>[^)]+)\)$", re.MULTILINE)


def documents():
    return [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").rglob("*.md"))]


def run(command, folder):
    """What the command prints, the program under test being the `slipway` that the shell finds."""
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}
    environment.pop("SLIPWAY_DATA", None)
    done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode not in (0, 3, 4, 5):  # a drive's verdict is no failure, nor is a wheel that sinks
        raise RuntimeError(f"exit status {done.returncode}\n{done.stderr}")
    return done.stdout


def check_blocks(document, folder, faults):
    """Compares the blocks of one document, and writes what differs where that is asked for; the number of commands that ran."""
    text, ran = document.read_text(), 0

    def settle(match):
        nonlocal ran
        line = text.count("\n", 0, match.start()) + 1
        place = f"{document.relative_to(root)}:{line}"
        if not match["command"]:
            if not match["language"]:
                faults.append(f"{place}: a block without a language names no command")
            return match[0]
        if which not in ("all", "slow" if match["slow"] else "quick"):
            return match[0]
        ran += 1
        try:
            printed = run(match["command"], folder)
        except RuntimeError as broken:
            faults.append(f"{place}: {match['command']}: {broken}")
            return match[0]
        if printed == match["body"]:
            return match[0]
        if not write:
            faults.append(f"{place}: {match['command']} prints otherwise:\n{printed}")
        marker = f"<!-- {match['slow'] or ''}output of: {match['command']} -->"
        return f"{marker}\n```{match['language']}\n{printed}```"

    settled = BLOCK.sub(settle, text)
    if write and settled != text:
        document.write_text(settled)
        print(f"{document.relative_to(root)}: written")
    return ran


def check_pictures(document, folder, faults):
    """Compares the pictures of one document with what their commands draw, or puts them there; the number of commands that ran."""
    ran = 0
    for match in PICTURE.finditer(document.read_text()):
        ran += 1
        picture = document.parent / match["path"]
        place = f"{document.relative_to(root)}: {match['path']}"
        try:
            run(match["command"], folder)
            drawn = (folder / picture.name).read_bytes()
        except (RuntimeError, OSError) as broken:
            faults.append(f"{place}: {match['command']}: {broken}")
            continue
        if write and (not picture.exists() or picture.read_bytes() != drawn):
            picture.write_bytes(drawn)
            print(f"{place}: written")
        elif not picture.exists() or picture.read_bytes() != drawn:
            faults.append(f"{place}: {match['command']} draws another picture")
    return ran


def check_requests(folder, faults):
    """Asks a service what the README asks one; the number of questions."""
    commands = [line for block in re.findall(r"^```sh\n(.*?)^```$", (root / "README.md").read_text(), re.MULTILINE | re.DOTALL)
                for line in re.sub(r"\\\n", " ", block).splitlines() if line.startswith("curl ")]
    service = subprocess.Popen([slipway, "serve", "--port", "0", "--jobs", ""], cwd=folder, stdout=subprocess.PIPE, text=True)
    try:
        url = re.search(r"http://127\.0\.0\.1:\d+", service.stdout.readline())[0]
        for command in commands:
            asked = command.replace("http://127.0.0.1:8080", url).replace("curl ", "curl --fail-with-body ", 1)
            try:
                run(asked, folder)
            except RuntimeError as broken:
                faults.append(f"README.md: {command}: {broken}")
    finally:
        service.send_signal(signal.SIGTERM)
        service.wait(timeout=30)
    return len(commands)


def main():
    faults, ran, asked = [], 0, 0
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        (folder / "bin").mkdir()
        (folder / "bin" / "slipway").symlink_to(slipway)
        (folder / "bin" / "papers.py").symlink_to(root / "tests/documents/papers.py")
        (folder / "data").symlink_to(root / "data")
        for document in documents():
            ran += check_blocks(document, folder, faults)
            if which != "slow":
                ran += check_pictures(document, folder, faults)
        if which != "slow":
            asked = check_requests(folder, faults)
    if ran == 0 or (which != "slow" and asked == 0):
        faults.append(f"{ran} commands and {asked} questions were found: this test looks at the wrong documents")
    print(f"{ran} commands ran, {asked} questions were asked")
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
