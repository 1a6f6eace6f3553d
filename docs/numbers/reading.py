"""What a reader does with a document: follows its links, types its commands."""
import re

from commands import STUDIES, TOP, verb_of, without

PLACEHOLDER = re.compile(r"\b(SCENE|NAME|FAMILY|VERB|STATE|IN|OUT|SHELL|FOLDER|FILE|COLUMNS)\b|…|mine\.|robot\.|"
                         r"\bN\b|\[[A-Z-]|\{|sudo|/DIR")
VERBS = "index|check|assemble|evaluate|run|drift|work|modes|linearise|make|convert|view|sweep"


def links_lead_somewhere(file):
    text = file.read_text(encoding="utf-8")
    return [f"{file.relative_to(TOP)}:{text.count(chr(10), 0, link.start()) + 1}: the link to {link[1]} leads nowhere"
            for link in re.finditer(r"\]\(([^)#:\s]+)(#[^)]*)?\)", text) if not (file.parent / link[1]).exists()]


def commands_of(text):
    """(line, command): indented or in backquotes; of a shell loop its body with the first of its values."""
    text = re.sub(r"\\\n *", "", re.sub(r"<!--.*?-->", lambda m: "\n" * m[0].count("\n"), text, flags=re.S))
    for name, value in re.findall(r"for (\w+) in (\S+)", text):
        text = re.sub(rf"\${name}\b", value, text)
    for found in re.finditer(rf"(?:\n {{4,}}(?:echo '[^\n']*' \| )?|`)(momenta +(?:{VERBS}) [^\n`]*)", text):
        yield found[1].split(" # ")[0].rstrip(";"), found[0].strip(" \n`").split(" # ")[0].rstrip(";")


def shortened(command):
    """The same on a short span."""
    verb = verb_of(command)
    command = re.sub(r"--n \d{3,}", "--n 50", command)
    if verb in (*STUDIES, "sweep"):
        command = without(command, "end", "samples", "rtol", "from", "to", "per-decade", "cpu-limit")
        command += " --end 0.003 --samples 3 --quiet"
        command += " --from 1e-4 --to 1e-5" if verb == "work" else " --rtol 1e-6"
        command += "" if verb == "sweep" else " --timing none"
    return command


def commands_run(file, commands):
    complaints = []
    for command, line in commands_of(file.read_text(encoding="utf-8")):
        if PLACEHOLDER.search(command) or not re.search(r"\.(toml|urdf|xml)\b|momenta make", command):
            continue
        status, text = commands.shell(shortened(line))
        if status != 0 and "was built without" not in text:
            complaints.append(f"{file.relative_to(TOP)}: `{line}` ends with status {status}: "
                              f"{text.strip().splitlines()[-1] if text.strip() else 'nothing said'}")
    return complaints
