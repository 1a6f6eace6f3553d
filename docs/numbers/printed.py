"""Lines that a program printed, beside the same lines in a document."""
from quantities import ROUNDING, parse


def split(token):
    """The numbers in a word, 1.02±0.03 say, and what is around them."""
    return [part for part in token.replace("t^", "").split("±")]


def same(old, now, factor):
    """Whether two words are the same, numbers up to `factor`; a time that was not taken is '-'."""
    if old == now or (now == "-" and parse(old) is not None):
        return True
    a, b = split(old), split(now)
    if len(a) != len(b):
        return False
    if len(a) == 2:  # an exponent with its half range
        return abs(parse(a[0]) - parse(b[0])) <= parse(a[1]) + parse(b[1]) + 0.25
    x, y = parse(old), parse(now)
    if x is None or y is None:
        return False
    if max(abs(x), abs(y)) <= ROUNDING or min(x, y) >= 1e8:  # rounding, or a gap that has it below
        return True
    return x * y > 0 and max(x / y, y / x) <= (factor if "." in old or "e" in old else 1.0)


def compare_lines(block, said, factor):
    """(place in block, line there, line that is printed) for lines that are not printed like that."""
    printed = [line for line in said.splitlines() if line.strip()]
    at, place = 0, 0
    for line in block.splitlines(keepends=True):
        old = line.strip()
        if old:
            words = old.split()
            matches = [i for i in range(place, len(printed)) if len(printed[i].split()) == len(words)
                       and all(same(a, b, factor) for a, b in zip(words, printed[i].split()))]
            if matches:
                place = matches[0] + 1
            else:
                near = [i for i in range(place, len(printed)) if printed[i].split()[:1] == words[:1]]
                now = "no such line is printed"
                if near:
                    now, place = printed[near[0]].strip(), near[0] + 1
                yield at + line.index(old), old, now
        at += len(line)
