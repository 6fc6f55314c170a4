"""Rename by tables in a whole checkout: ``rename.py TREE TABLE… [--plan]``. See README in this folder."""
import ast, builtins, collections, io, json, keyword, pathlib, re, subprocess, sys, time, tokenize, os
HERE = pathlib.Path(__file__).parent
if sys.version_info < (3, 13) or "mypy" not in sys.modules and not (HERE / "venv/bin/python").samefile(sys.executable) and os.environ.get("RN_INNER") != "1":
    os.environ["RN_INNER"] = "1"
    os.execv(str(HERE / "venv/bin/python"), [str(HERE / "venv/bin/python"), __file__, *sys.argv[1:]])
sys.path.insert(0, str(HERE)); sys.setrecursionlimit(50000)
import facts as F
from edit import Editor
BUILTINS = set(dir(builtins))

class Plan:
    def __init__(self, facts, tables):
        self.f = facts; self.skipped = []
        self.parent = {}
        self.known = set()
        for rs in facts["refs"].values():
            for r in rs: self.known.update(r[2])
        self.attr_owner = facts["class_info"]
        self.unite()
        self.index_refs()
        self.read(tables)
        self.filter()
        self.collide()

    # families
    def find(self, k):
        p = self.parent
        r = k
        while p.get(r, r) != r: r = p[r]
        while p.get(k, k) != r: p[k], k = r, p[k]
        return r
    def union(self, a, b):
        a, b = self.find(a), self.find(b)
        if a != b: self.parent[b] = a
    def unite(self):
        fp = self.f["func_params"]
        for a, b, why in self.f["unions"]:
            self.union(a, b)
            if a in fp and b in fp:
                for p in fp[a]:
                    if p in fp[b]: self.union(f"{a}({p})", f"{b}({p})")
        for rs in self.f["refs"].values():       # a union type: all its classes share the name
            for r in rs:
                for k in r[2][1:]: self.union(r[2][0], k)
        self.external = {}
        for k, base in self.f["external"].items(): self.external[self.find(k)] = base

    def index_refs(self):
        self.byfam = collections.defaultdict(list)   # root -> [(file, ref)]
        for file, rs in self.f["refs"].items():
            for r in rs:
                for root in {self.find(k) for k in r[2]}: self.byfam[root].append((file, r))
        self.names = {}
        self.members_of = collections.defaultdict(set)
        for k in list(self.known) + list(self.parent): self.members_of[self.find(k)].add(k)

    def skip(self, old, new, reason, place=""):
        self.skipped.append((old, new, reason, str(place)))

    def resolve(self, old, par):
        """Key of a line of the table."""
        f = self.f
        if par:
            for fn in (old, old + ".__init__", old + ".__new__"):
                if fn in f["func_params"] and par in f["func_params"][fn]: return f"{fn}({par})"
            if old in f["class_info"]: return self.resolve(f"{old}.{par}", None)
            return None
        if old in f["mods"]: return old
        owner, _, name = old.rpartition(".")
        if owner in f["class_info"]:
            for b in f["bases"].get(owner, [owner]):
                if f"{b}.{name}" in self.known: return f"{b}.{name}"
            return None
        return old if old in self.known else None

    def read(self, tables):
        self.new = {}     # root -> (new, old name, line of the table)
        self.lines = 0
        for t in tables:
            for line in open(t):
                line = line.split("#")[0].strip()
                m = re.fullmatch(r"([\w.]+)(?:\((\w+)\))? -> (\w+)", line)
                if not m: continue
                old, par, new = m[1], m[2], m[3]; self.lines += 1
                shown = old + (f"({par})" if par else "")
                name = par or old.rpartition(".")[2]
                if name == new: continue
                key = self.resolve(old, par)
                if key is None: self.skip(shown, new, "unknown name"); continue
                if not new.isidentifier() or keyword.iskeyword(new): self.skip(shown, new, "no identifier"); continue
                root = self.find(key)
                if root in self.new:
                    if self.new[root][0] != new: self.skip(shown, new, "conflict: family already has " + self.new[root][0], self.new[root][2])
                    else: self.same = getattr(self, "same", 0) + 1
                    continue
                self.new[root] = (new, name, shown)

    def kind(self, root):
        k = root
        if k.endswith(")"): return "param"
        if k in self.f["mods"]: return "module"
        owner = k.rpartition(".")[0]
        if owner in self.f["class_info"]: return "member"
        return "class" if k in self.f["class_info"] else "global"

    def drop(self, root, reason, place=""):
        new, old, shown = self.new.pop(root)
        self.skip(shown, new, reason, place); return True

    # the conservative filter
    def filter(self):
        f = self.f
        fp = f["func_params"]
        soft = {"fields", "vars", "__dict__", "replace(**)", "constructed from **", "__slots__", "__dataclass_fields__", "signature"}
        fileidx = {file: {k for r in rs for k in r[2]} for file, rs in f["refs"].items()}
        self.imports = {}
        for file, rs in f["refs"].items():
            self.imports[file] = {file} | {f["mods"][k if k in f["mods"] else k.rpartition(".")[0]] for r in rs if r[3] in ("import", "importas", "modpart") for k in r[2] if k in f["mods"] or k.rpartition(".")[0] in f["mods"]}
        two = {}
        def imported(file):
            """Files that a file imports, directly or through one other."""
            if file not in two:
                one = self.imports.get(file, set()); two[file] = set(one).union(*(self.imports.get(x, ()) for x in one))
            return two[file]
        def relevant(places, root, owners=(), wide=False):
            """A place whose file has to do with the family."""
            files = {file for file, _ in self.byfam[root]}
            for p in places:
                if p[0] in files: return p
                if (wide or p[0].startswith("tests/")) and imported(p[0]) & {x for x in files if not x.startswith("tests/")}: return p
                ks = fileidx.get(p[0], ())
                if any(o in ks for o in owners): return p
            return None
        reach = {}
        softly = {}
        for cls, whys in f["reflected"].items():
            hard = [w for w in whys if w[0] not in soft and not (w[0] == "fields" and w[1] == "tests/control/test_commands.py")]
            if not hard:
                if all(w[:2] == ("fields", "tests/control/test_commands.py") for w in whys): continue
                for x in {cls, *f["bases"].get(cls, ()), *f["subclasses"].get(cls, ())}: softly.setdefault(x, whys[0])
                continue
            why = hard[0]
            reach[cls] = why
            for b in f["bases"].get(cls, ()): reach.setdefault(b, why)
            for s in f["subclasses"].get(cls, ()): reach.setdefault(s, why)
        dyn = dict(softly)
        for cls, why in f["dynamic"].items():
            dyn[cls] = why
            for b in f["bases"].get(cls, ()): dyn.setdefault(b, why)
            for s in f["subclasses"].get(cls, ()): dyn.setdefault(s, why)
        enums = set()
        for cls in f["enum_named"]:
            enums.add(cls); enums.update(f["subclasses"].get(cls, ()))
        strings = f["strings"]
        pieces_end = [s for s in strings if re.fullmatch(r"_\w{2,}", s)]
        pieces_start = [s for s in strings if re.fullmatch(r"\w{2,}_", s)]
        lastpart = {}
        for s, places in strings.items():
            if re.fullmatch(r"[\w./]*(:[\w.]+|\.\w+)", s):
                for part in re.split(r"[:.]", s)[1:]: lastpart.setdefault(part, (s, places[0]))
        callnames = {p for fn, ps in fp.items() if fn.endswith(".__call__") and "protocol" in f["class_info"].get(fn[:-9], ()) for p in ps} - {"self"}
        for root in list(self.new):
            new, old, shown = self.new[root]
            kind = self.kind(root)
            if kind == "class" and new.startswith("Test") or kind == "global" and new.startswith("test_"): self.drop(root, "pytest would collect the new name"); continue
            if kind == "param" and old in callnames: self.drop(root, "parameter named by a Protocol with __call__"); continue
            fam = self.members_of.get(root) or {root}
            if old.startswith("__") and old.endswith("__"): self.drop(root, "dunder"); continue
            bad = [k for k in fam if not k.endswith(")") and k.rpartition(".")[2] != old or k.endswith(")") and not k.endswith(f"({old})")]
            if bad and kind != "module": self.drop(root, "family with different names", bad[0]); continue
            if kind in ("member", "param") and root in self.external: self.drop(root, "family with foreign member", self.external[root]); continue
            if kind == "member":
                owners = {k.rpartition(".")[0] for k in fam}
                is_data = not any(k in fp for k in fam)
                r = next((o for o in owners if o in reach), None)
                if r and is_data: self.drop(root, f"class read by field name ({reach[r][0]})", reach[r]); continue
                e = next((o for o in owners if o in enums), None)
                if e and old.isupper(): self.drop(root, "enum whose names are read", f["enum_named"].get(e, "")); continue
                d = next((o for o in owners if o in dyn), None)
                if d and (old in strings or any(old.endswith(s) for s in pieces_end) or any(old.startswith(s) for s in pieces_start) or old in lastpart):
                    self.drop(root, "getattr with computed name on the class, and name occurs as string", dyn[d]); continue
                u = relevant(f["unresolved"].get(old, ()), root, owners)
                if u: self.drop(root, f"used on an untyped expression ({u[2]})", u); continue
                u = relevant(f["standin"].get(old, ()), root, owners, wide=True)
                if u: self.drop(root, f"name in a stand-in ({u[2]})", u); continue
            elif kind == "param":
                u = relevant(f["unres_kw"].get(old, ()), root, {k.partition("(")[0] for k in fam} | {k.partition("(")[0].removesuffix(".__init__") for k in fam})
                if u: self.drop(root, "keyword of a call of unknown function", u); continue
                bad = next((f["patched"][k] for k in fam if k in f["patched"]), None)
                if bad: self.drop(root, "overrides a foreign method", bad); continue
                star = next((f["starred"][k.partition("(")[0]] for k in fam if k.partition("(")[0] in f.get("starred", {})), None)
                if star and old in strings: self.drop(root, "function called with **", star); continue
                pf = next((f["patched"][k.partition("(")[0]] for k in fam if k.partition("(")[0] in f["patched"]), None)
                if pf and any(r[3] == "kw" for _, r in self.byfam[root]): self.drop(root, "function replaced in tests and called by keyword", pf); continue
                if any(k.startswith("tests.") for k in fam): 
                    fx = [k for k in fam if re.match(r"tests\.", k) and k.partition("(")[0].rpartition(".")[2].startswith("test_")]
                    if fx: self.drop(root, "parameter of a test (fixture)", fx[0]); continue
                c = self.shadow_global_ctor(root, old)
                if c: self.drop(root, c); continue
            elif kind in ("global", "class"):
                if old in f["unresolved"] and any(p[2] != "position name" for p in f["unresolved"][old]) and self.in_dynamic_module(root, f):
                    self.drop(root, "module read by computed name", f["unresolved"][old][0]); continue
                if old in lastpart and not self.resolvable(lastpart[old][0]) and re.split(r"[.:]", lastpart[old][0])[-2] == root.split(".")[-2]: self.drop(root, "name in a dotted string", lastpart[old]); continue
                if any(p[0] not in ("resources/translations/collect.py", "tests/benchmarks/reliability_page.py", "tests/alarms/test_catalogue.py") for p in f["scanned"].get(old, ())) and not self.all_same(old): self.drop(root, "name in a file that reads source by names", f["scanned"][old][0]); continue
            elif kind == "module":
                if old in strings:
                    s = next((p for p in strings[old] if not p[0].startswith("tests/") or True), None)
                    if root.startswith(("app.cli.", "app.extras.")) : self.drop(root, "module found by name", s); continue

    def all_same(self, old):
        if not hasattr(self, "by_old"):
            self.by_old = collections.defaultdict(set)
            for rs in self.f["refs"].values():
                for r in rs: self.by_old[r[1]].update(self.find(k) for k in r[2])
        news = {self.new[r][0] if r in self.new else None for r in self.by_old[old]}
        return len(news) == 1

    def shadow_global_ctor(self, root, old): return None

    def in_dynamic_module(self, root, f):
        return any(p[2] == "Any" for p in f["unresolved"].get(root.rpartition(".")[2], ())) and root.rpartition(".")[2] in {"EXTRA", "BACKEND", "run", "add_parser", "PAGE"}

    def resolvable(self, s):
        m = re.fullmatch(r"([\w.]+):([\w.]+)", s)
        if m and "core.interpreter.omniturn." + m[1] in self.f["mods"]: return True
        return s.split(".")[0] in F.TOPS and any(s.startswith(m + ".") for m in (s.rpartition(".")[0], s.rpartition(".")[0].rpartition(".")[0])) and (s.rpartition(".")[0] in self.f["mods"] or s.rpartition(".")[0].rpartition(".")[0] in self.f["mods"])

    def near(self, root, old):
        """A string constant that equals the name, in a file that refers to it."""
        places = self.f["strings"].get(old)
        if not places: return None
        files = {file for file, _ in self.byfam[root]}
        return next((p for p in places if p[0] in files), None)

    # collisions
    def collide(self):
        f = self.f
        scopes, uses = f["scopes"], f["uses"]
        sub = f["subclasses"]
        # per file tables of children
        self.anc = {}
        for file, ss in scopes.items():
            self.anc[file] = [s[1] for s in ss]
        changed = True; rounds = 0
        why = {}
        def renamed(key):
            r = self.find(key); return r in self.new
        def inside(file, s, outer):
            a = self.anc[file]
            while s != -1:
                if s == outer: return True
                s = a[s]
            return False
        def scope_binding(file, s, name):
            a = self.anc[file]; ss = scopes[file]; first = True
            while s != -1:
                kind, parent, bound, key = ss[s]
                if (kind != "class" or first) and name in bound: return s
                if kind != "comp": first = False
                s = parent
            return -1
        key_of_binding = {}
        for file, rs in f["refs"].items():
            for r in rs:
                if r[3] in ("name", "def", "import", "arg", "importas", "modpart") and len(r[2]) == 1:
                    b = scope_binding(file, r[4], r[1])
                    if r[3] not in ("importas", "modpart"): key_of_binding.setdefault((file, b, r[1]), r[2][0])
        def name_collision(root, new, old):
            for file, r in self.byfam[root]:
                o, name, keys, kind, s, line = r
                if name != old or kind not in ("name", "def", "import", "arg"): continue
                b = scope_binding(file, s, name)
                if b == -1: b = 0
                bkind, _, bound, bkey = scopes[file][b]
                if new in bound:
                    k = key_of_binding.get((file, b, new))
                    if not (k and renamed(k) and self.new[self.find(k)][1] == new): return f"new name is bound in the scope", (file, line)
                x = s
                while x != b and x != -1:
                    kx, px, bx, _ = scopes[file][x]
                    if new in bx and kx != "class": return "new name is bound in an inner scope", (file, line)
                    if new in bx and kx == "class" and x == s: return "new name is bound in an inner scope", (file, line)
                    x = px
                for us, rs in uses[file].get(new, ()):
                    if rs != b and (rs == -1 or inside(file, b, rs)) and inside(file, us, b) and (bkind != "class" or us == b):
                        k = key_of_binding.get((file, rs, new))
                        if k and renamed(k) and self.new[self.find(k)][1] == new: continue
                        return "new name would hide another that is used", (file, line)
            return None
        def member_collision(root, new, old):
            for k in self.members_of.get(root) or {root}:
                cls = k.rpartition(".")[0]
                for c in {cls} | sub.get(cls, set()):
                    if new in f["members"].get(c, ()):
                        # taken, unless that name itself goes away
                        ks = [f"{b}.{new}" for b in f["bases"].get(c, [c]) if f"{b}.{new}" in self.known or f"{b}.{new}" in self.parent]
                        if ks and all(renamed(x) and self.new[self.find(x)][1] == new for x in ks): continue
                        return "new name exists in the class", c
                    if new in f.get("ctor_params", {}).get(c, ()): pass
            return None
        def param_collision(root, new, old):
            for k in self.members_of.get(root) or {root}:
                fn = k.partition("(")[0]
                for p in f["func_params"].get(fn, ()):
                    if p == new:
                        kk = self.find(f"{fn}({p})")
                        if not (kk in self.new and self.new[kk][1] == new): return "parameter exists", fn
            return None
        while True:
            rounds += 1
            out = []
            taken = {}
            for root, (new, old, shown) in self.new.items():
                kind = self.kind(root)
                bad = None
                if kind == "member": bad = member_collision(root, new, old)
                if kind == "param": bad = param_collision(root, new, old)
                if kind == "module":
                    target = root.rpartition(".")[0] + "." + new
                    if (target in f["mods"] or target in f["packages"]) : bad = ("module exists", target)
                bad = bad or name_collision(root, new, old)
                if bad: out.append((root, bad)); continue
                # two renames to one name
                for k in self.members_of.get(root) or {root}:
                    owner = k.rpartition(".")[0] if not k.endswith(")") else k.partition("(")[0] + "()"
                    if (owner, new) in taken and taken[owner, new] != root: out.append((root, ("two names become one", taken[owner, new]))); break
                    taken[owner, new] = root
                else:
                    if kind == "member":
                        clash = False
                        for k in self.members_of.get(root) or {root}:
                            cls = k.rpartition(".")[0]
                            for c in set(f["bases"].get(cls, ())) | sub.get(cls, set()):
                                if (c, new) in taken and taken[c, new] != root: clash = c
                        if clash: out.append((root, ("two names become one in a hierarchy", clash)))
                    # in files: two bare names become one
                    if kind in ("global", "class", "module", "param"):
                        for file, r in self.byfam[root]:
                            if r[3] in ("name", "def", "import", "arg") and r[1] == old:
                                b = scope_binding(file, r[4], old)
                                t = taken.setdefault((file, b, new), root)
                                if t != root: out.append((root, ("two names become one in a file", file))); break
                                # a new name bound in an enclosing or inner scope by another rename
                                x, hit = self.anc[file][b] if b > 0 else -1, False
                                while x != -1:
                                    t = taken.get((file, x, new))
                                    if t and t != root and scopes[file][x][0] != "class": hit = True
                                    x = self.anc[file][x]
                                if hit: out.append((root, ("new name hides another new name", file))); break
            seen = set()
            for root, (reason, place) in out:
                if root in self.new: self.drop(root, "collision: " + reason, place)
            if not out: break
        self.rounds = rounds

def main():
    args = [a for a in sys.argv[1:] if not a.startswith("--")]
    plan_only = "--plan" in sys.argv
    tree, tables = pathlib.Path(args[0]).resolve(), args[1:]
    t = time.time()
    f = F.collect(str(tree)); print(f"facts {time.time()-t:.0f} s", flush=True)
    t = time.time(); plan = Plan(f, tables)
    with open(HERE / "skipped.tsv", "w") as out:
        for row in plan.skipped: out.write("\t".join(row) + "\n")
    print(f"plan {time.time()-t:.0f} s: {plan.lines} lines, {len(plan.new)} families renamed, {getattr(plan, 'same', 0)} lines repeat a family, {len(plan.skipped)} skipped; {plan.rounds} rounds")
    for reason, n in collections.Counter(re.sub(r": family already has.*", "", r[2]) for r in plan.skipped).most_common(): print(f"{n:6} {reason}")
    print(collections.Counter(plan.kind(r) for r in plan.new))
    if plan_only: return
    t = time.time(); Editor(tree, f, plan).run(); print(f"edits {time.time()-t:.0f} s", flush=True)

if __name__ == "__main__": main()
