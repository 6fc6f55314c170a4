"""Check a table of renames against the listings."""
import re, sys, glob, keyword
names, params, mods = set(), {}, set()
for f in glob.glob("names/*.lst"):
    mod = ""
    for line in open(f):
        if line.startswith("== "):
            mod = line[3:].split("  #")[0].strip(); mods.add(mod); continue
        m = re.match(r"(\w+) ~\.([\w.]+)(?:\(([^)]*)\))?", line)
        if m:
            full = mod + "." + m[2]; names.add(full)
            if m[1] in ("def", "property"): params[full] = {p.strip().lstrip("*") for p in (m[3] or "").split(",") if p.strip()}
BAD = re.compile(r"(^|_)(told|tells?|anew|nought|nobody|somebody|whoever|behind|beside|stands?|lies|leaf|reckon|mend|heard|meanwhile|glass|way|trouble|figures?|look|looks|takes?|taken|of|goes|go|kept|along|out)(_|$)")
ok = 0; seen = {}; new_in = {}
for n, line in enumerate(open(sys.argv[1]), 1):
    line = line.split("#")[0].strip()
    if not line: continue
    m = re.fullmatch(r"([\w.]+)(?:\((\w+)\))? -> (\w+)", line)
    if not m: print(n, "syntax:", line); continue
    old, par, new = m[1], m[2], m[3]
    if old in seen and (par, new) != seen[old] and par is None and seen[old][0] is None: print(n, "twice:", line)
    seen[old] = (par, new) if par is None else seen.get(old, ("x", ""))
    if keyword.iskeyword(new): print(n, "keyword:", line)
    if BAD.search(new.lower()): print(n, "avoided word in new name:", line)
    if par:
        if old not in params and old + ".__init__" not in params: print(n, "no such function:", line)
        elif par not in params.get(old, params.get(old + ".__init__", set())): print(n, "no such parameter:", line)
        elif new in params.get(old, set()): print(n, "parameter exists:", line)
    elif old in mods:
        if old.rsplit(".", 1)[0] + "." + new in mods: print(n, "module exists:", line)
    elif old not in names: print(n, "no such name:", line); continue
    else:
        owner = old.rsplit(".", 1)[0]
        if owner + "." + new in names: print(n, "name exists:", line)
        if (owner, new) in new_in and new_in[owner, new] != old: print(n, "two names become one:", line)
        new_in[owner, new] = old
    ok += 1
print(ok, "renames")
