"""fix_ignores.py TREE MYPY_LOG: put ``# type: ignore`` comments back on the line of their error after a reformatting."""
import collections, pathlib, re, sys
tree = pathlib.Path(sys.argv[1]); found = collections.defaultdict(lambda: ([], []))
for line in open(sys.argv[2]):
    m = re.match(r"(\S+?):(\d+): error: (.*?)  \[([\w-]+)\]$", line.rstrip())
    if m: found[m[1]][0 if m[4] == "unused-ignore" else 1].append((int(m[2]), m[4]))
n = 0
for file, (unused, errors) in found.items():
    p = tree / file; lines = p.read_text(encoding="utf-8").split("\n")
    for l, _ in unused:
        m = re.search(r"\s*# type: ignore(\[[\w, -]+\])?", lines[l - 1])
        if not m: continue
        codes = re.findall(r"[\w-]+", m[1] or "")
        near = sorted({e[0] for e in errors if abs(e[0] - l) <= 8 and (not codes or e[1] in codes)}, key=lambda x: abs(x - l))
        if near:
            lines[l - 1] = lines[l - 1].replace(m[0], "")
            for k in near[:1]: lines[k - 1] += "  " + m[0].strip()
            n += 1
    p.write_text("\n".join(lines), encoding="utf-8")
print(n, "comments moved")
